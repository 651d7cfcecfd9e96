// Periodic self-affine roughness: a sum of waves with a prescribed spectrum and random phases. The same parameters
// and seed give the same bits on every machine, instruction set and number of threads.
//
//   h(x, y) = sum over (kx, ky) of A(f) · cos(2·pi·(kx·x/Lx + ky·y/Ly + u(seed, kx, ky)))
//
// with Lx = nx·dx, Ly = ny·dy, x and y from the grid's centre, f² = (kx/Lx)² + (ky/Ly)² and one of each pair of waves
// ±(kx, ky). A² is the power spectral density of the heights, up to a factor:
//   constant                         for  1/long_cutoff <= f <= 1/rolloff
//   (f·rolloff)^(−2(1+hurst))        for  1/rolloff     <= f <= 1/short_cutoff
//   0                                elsewhere, and at the Nyquist wave number, where a sampled wave has no phase.
// The factor makes the root mean square of the heights, or of the slopes, exactly the one asked for:
//   rms_height² = sum A²/2,   rms_slope² = sum (2·pi·f·A)²/2.
// Amplitudes are not random, so these hold for every seed, not only on average; heights are Gaussian in the limit of
// many waves. u in [0, 1) depends on the seed and on (kx, ky) alone: a finer grid over the same lengths, with the
// same cutoffs, samples the same surface. Spectrum: Jacobs, Junge, Pastewka 2017.
//
// u = top 53 bits of mix(mix(mix(seed) ^ kx) ^ ky), where mix is one step of SplitMix64 (Steele, Lea, Flood 2014) and
// kx, ky are 64-bit two's complement.
#pragma once

#include <cstdint>
#include <span>

#include "base/buffer.h"
#include "base/grid.h"
#include "parallel/arena.h"
#include "surface/shapes.h"

namespace brinell::surface {

/// Zero stands for the default where one is named. long_cutoff >= rolloff >= short_cutoff >= twice the larger
/// spacing; waves within a relative 1e-9 of a cutoff are in. Slope is the magnitude of the gradient.
struct Roughness {
  double hurst = 0;         // 0 < hurst <= 1
  double rms_slope = 0;     // exactly one of rms_slope and
  double rms_height = 0;    // rms_height [m] is positive, the other zero
  double long_cutoff = 0;   // [m] wavelength; default: the longest of the grid's sides and rolloff
  double rolloff = 0;       // [m] wavelength; default: long_cutoff
  double short_cutoff = 0;  // [m] wavelength; default: twice the larger spacing
  std::uint64_t seed = 0;
};

/// The same with every default filled in. Throws Status::invalid_argument for what is not allowed on this grid, and
/// if no wave of the grid lies between the cutoffs.
Roughness checked(const Roughness& roughness, const Grid& grid);

/// Heights at the nodes, row-major.
Buffer<double> rough_heights(const Roughness& roughness, Centre centre, const Grid& grid,
                             const parallel::Arena& arena);

/// gap −= heights. The surface continues periodically where its centre is moved.
void add_to_gap(const Roughness& roughness, Centre centre, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena);

}  // namespace brinell::surface
