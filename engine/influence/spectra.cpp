#include "influence/spectra.h"

#include <cmath>
#include <numbers>

#include "base/buffer.h"
#include "influence/displacement.h"

namespace brinell::influence {

namespace {

double wave_number(const Grid& grid, std::int64_t kx, std::int64_t ky) {
  const double qx = static_cast<double>(kx) / (static_cast<double>(grid.nx) * grid.dx);
  const double qy = static_cast<double>(ky) / (static_cast<double>(grid.ny) * grid.dy);
  return 2 * std::numbers::pi * std::hypot(qx, qy);
}

SpectrumKey key_of(Response response, Boundary boundary, fft::Method method, const Grid& grid, double parameter) {
  return {response, boundary, method, grid.nx, grid.ny, grid.dx, grid.dy, parameter, false};
}

}  // namespace

double displacement_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky) {
  return kx == 0 && ky == 0 ? 0.0 : 2 / wave_number(grid, kx, ky);
}

double inverse_displacement_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky, double at_zero) {
  return kx == 0 && ky == 0 ? at_zero : 0.5 * wave_number(grid, kx, ky);
}

template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> displacement_spectrum(SpectrumCache& cache, const fft::Backend& backend,
                                                                 const fft::Convolution<Real>& convolution,
                                                                 const Grid& grid, Boundary boundary) {
  return cache.get<Real>(key_of(Response::displacement, boundary, convolution.method(), grid, 0), [&] {
    if (boundary == Boundary::periodic) {
      return convolution.spectrum_of_symbol(
          [&](std::int64_t kx, std::int64_t ky) { return displacement_symbol(grid, kx, ky); });
    }
    auto coefficients = Buffer<double>::uninitialised(grid.nodes());
    Displacement(grid.dx, grid.dy).fill(backend.arena, backend.kernels, grid.nx, grid.ny, coefficients.data());
    return convolution.spectrum(coefficients.data(), fft::Parity::even, fft::Parity::even);
  });
}

template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> inverse_displacement_spectrum(SpectrumCache& cache,
                                                                         const fft::Convolution<Real>& convolution,
                                                                         const Grid& grid, double at_zero) {
  const auto key = key_of(Response::inverse_displacement, Boundary::periodic, convolution.method(), grid, at_zero);
  return cache.get<Real>(key, [&] {
    return convolution.spectrum_of_symbol(
        [&](std::int64_t kx, std::int64_t ky) { return inverse_displacement_symbol(grid, kx, ky, at_zero); });
  });
}

template std::shared_ptr<const fft::Spectrum<double>> displacement_spectrum(SpectrumCache&, const fft::Backend&,
                                                                            const fft::Convolution<double>&,
                                                                            const Grid&, Boundary);
template std::shared_ptr<const fft::Spectrum<float>> displacement_spectrum(SpectrumCache&, const fft::Backend&,
                                                                           const fft::Convolution<float>&,
                                                                           const Grid&, Boundary);
template std::shared_ptr<const fft::Spectrum<double>> inverse_displacement_spectrum(SpectrumCache&,
                                                                                    const fft::Convolution<double>&,
                                                                                    const Grid&, double);
template std::shared_ptr<const fft::Spectrum<float>> inverse_displacement_spectrum(SpectrumCache&,
                                                                                   const fft::Convolution<float>&,
                                                                                   const Grid&, double);

}  // namespace brinell::influence
