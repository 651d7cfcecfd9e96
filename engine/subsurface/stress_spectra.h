// Spectra of the stress at one depth: closed-form coefficients of cells transformed (free boundary), or the response
// of the continuous half-space to waves (periodic).
//
// A wave of wave vector k = q (c, s) in the surface, times e^{−qz}, E the elastic half-space's stress under
//
//   pressure       σ_nn = −(1 − qz)    σ_tt = −2ν    σ_zz = −(1 + qz)   σ_nz = i qz
//   shear along n  σ_nn = i (2 − qz)   σ_tt = 2iν    σ_zz = i qz        σ_nz = −(1 − qz)
//   shear along t  σ_nt = i            σ_tz = −1
//
// in the axes n along k and t across (H. M. Westergaard, 1939, and the anti-plane wave), turned into x and y.
//
// Three pairs of responses are equal, and one spectrum serves both: σ_zz of shear along x (y) and σ_xz (σ_yz) of
// pressure; σ_xz of shear along y and σ_yz of shear along x.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/buffer.h"
#include "fft/convolution.h"
#include "subsurface/stress_request.h"

namespace brinell::subsurface {

/// The spectra of one layer, numbered.
class SpectrumIndex {
 public:
  SpectrumIndex(Sources sources, Components needed);

  int count() const { return count_; }
  int of(int traction, int component) const { return number_[at(traction, component)]; }

  /// Number of the spectrum to generate for this response; −1: none.
  int generated(int traction, int component) const { return generated_[at(traction, component)]; }
  bool generates(int traction) const;

 private:
  static std::size_t at(int traction, int component) {
    return static_cast<std::size_t>(traction) * kComponents + static_cast<std::size_t>(component);
  }
  std::array<int, kTractions * kComponents> number_{}, generated_{};
  int count_ = 0;
};

using LayerSpectra = std::vector<fft::Spectrum<double>>;  // by number

/// Fills the spectra of one traction into the layer. coefficients: scratch of 6·nx·ny values (free boundary only).
void generate_spectra(const fft::Backend& backend, const fft::Convolution<double>& convolution,
                      const StressRequest& request, double depth, Traction traction, const SpectrumIndex& index,
                      Buffer<double>& coefficients, fft::Workspace<double>& workspace, LayerSpectra& spectra);

}  // namespace brinell::subsurface
