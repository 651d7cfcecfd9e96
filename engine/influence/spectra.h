// Spectra of the surface's response to pressure, ready for a convolution, from the engine's cache.
//
// Free boundary: the influence coefficients of displacement.h. Periodic boundary: the response of the continuous
// half-space (H. M. Westergaard, 1939), u^(q) = 2/(E* |q|) p^(q), sampled at the wave numbers of the grid,
// q = 2π (kx/(nx·dx), ky/(ny·dy)), |kx| <= nx/2, |ky| <= ny/2. |q| is even in kx and ky, so that on grids of even
// size the Nyquist wave number, which stands for both signs, has one value. At q = 0 a half-space has no finite
// response: the value is set to zero, and with it the mean displacement.
#pragma once

#include <cstdint>
#include <memory>

#include "base/grid.h"
#include "fft/convolution.h"
#include "influence/spectrum_cache.h"

namespace brinell::influence {

/// 2/|q| [m] at the wave numbers kx, ky (cycles per period); 0 at q = 0.
double displacement_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky);

/// The pressure that makes a unit displacement, approximately [1/m]: half the square root of the discrete Laplacian,
///   √( sin²(π kx/nx)/dx² + sin²(π ky/ny)/dy² )  ~  |q|/2.
/// Its coefficients between different nodes are non-positive (a fractional power of an M-matrix is one), which |q|/2
/// sampled at the wave numbers does not give. At q = 0, half the least of the other values keeps it definite.
double conductance_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky);

/// Displacement [m] = (1/E*) · convolution with pressure [Pa]. The convolution was made for the grid's nodes, this
/// boundary and this backend.
template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> displacement_spectrum(SpectrumCache& cache, const fft::Backend& backend,
                                                                 const fft::Convolution<Real>& convolution,
                                                                 const Grid& grid, Boundary boundary);

/// The conductance for a periodic convolution of the grid's nodes.
template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> conductance_spectrum(SpectrumCache& cache,
                                                                const fft::Convolution<Real>& convolution,
                                                                const Grid& grid);

}  // namespace brinell::influence
