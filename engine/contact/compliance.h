// The elastic response of the two half-spaces to pressure on one grid: displacement = K · pressure.
#pragma once

#include <cstddef>
#include <memory>

#include "contact/problem.h"

namespace brinell::contact {

template <class Real>
class Compliance {
 public:
  Compliance(const Resources& resources, const Grid& grid, Boundary boundary);

  /// result = K · pressure; may be the same array.
  void apply(const Real* pressure, Real* result) const {
    convolution_.apply(*spectrum_, pressure, result, *workspace_);
  }

  /// The scratch of its convolution, for others that take turns with it.
  fft::Workspace<Real>& workspace() const { return *workspace_; }

  /// Bytes of one on such a grid: its spectrum and its workspace.
  static std::size_t bytes(const fft::Backend& backend, const Grid& grid, Boundary boundary);

 private:
  fft::Convolution<Real> convolution_;
  std::shared_ptr<const fft::Spectrum<Real>> spectrum_;
  std::unique_ptr<fft::Workspace<Real>> workspace_;
};

}  // namespace brinell::contact
