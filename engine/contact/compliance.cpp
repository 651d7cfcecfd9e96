#include "contact/compliance.h"

#include "influence/spectra.h"

namespace brinell::contact {

template <class Real>
Compliance<Real>::Compliance(const Resources& resources, const Grid& grid, Boundary boundary)
    : convolution_(resources.backend, grid.nx, grid.ny, boundary),
      spectrum_(influence::displacement_spectrum(resources.spectra, resources.backend, convolution_, grid, boundary)),
      workspace_(convolution_.workspace()) {}

template <class Real>
std::size_t Compliance<Real>::bytes(const fft::Backend& backend, const Grid& grid, Boundary boundary) {
  const fft::Convolution<Real> convolution(backend, grid.nx, grid.ny, boundary);
  return convolution.spectrum_bytes() + convolution.workspace_bytes();
}

template class Compliance<double>;
template class Compliance<float>;

}  // namespace brinell::contact
