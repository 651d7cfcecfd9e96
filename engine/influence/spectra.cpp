#include "influence/spectra.h"

#include <algorithm>
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

SpectrumKey key_of(Response response, Boundary boundary, fft::Method method, const Grid& grid) {
  return {response, boundary, method, grid.nx, grid.ny, grid.dx, grid.dy, false};
}

}  // namespace

double displacement_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky) {
  return kx == 0 && ky == 0 ? 0.0 : 2 / wave_number(grid, kx, ky);
}

double conductance_symbol(const Grid& grid, std::int64_t kx, std::int64_t ky) {
  const auto root = [&](double cx, double cy) {
    return std::hypot(std::sin(std::numbers::pi * cx / static_cast<double>(grid.nx)) / grid.dx,
                      std::sin(std::numbers::pi * cy / static_cast<double>(grid.ny)) / grid.dy);
  };
  if (kx != 0 || ky != 0) return root(static_cast<double>(kx), static_cast<double>(ky));
  if (grid.nx == 1 && grid.ny == 1) return 1 / std::max(grid.dx, grid.dy);
  if (grid.nx == 1) return 0.5 * root(0, 1);
  if (grid.ny == 1) return 0.5 * root(1, 0);
  return 0.5 * std::min(root(1, 0), root(0, 1));
}

template <class Real>
std::shared_ptr<const fft::Spectrum<Real>> displacement_spectrum(SpectrumCache& cache, const fft::Backend& backend,
                                                                 const fft::Convolution<Real>& convolution,
                                                                 const Grid& grid, Boundary boundary) {
  return cache.get<Real>(key_of(Response::displacement, boundary, convolution.method(), grid), [&] {
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
std::shared_ptr<const fft::Spectrum<Real>> conductance_spectrum(SpectrumCache& cache,
                                                                const fft::Convolution<Real>& convolution,
                                                                const Grid& grid) {
  return cache.get<Real>(key_of(Response::conductance, Boundary::periodic, convolution.method(), grid), [&] {
    return convolution.spectrum_of_symbol(
        [&](std::int64_t kx, std::int64_t ky) { return conductance_symbol(grid, kx, ky); });
  });
}

template std::shared_ptr<const fft::Spectrum<double>> displacement_spectrum(SpectrumCache&, const fft::Backend&,
                                                                            const fft::Convolution<double>&,
                                                                            const Grid&, Boundary);
template std::shared_ptr<const fft::Spectrum<float>> displacement_spectrum(SpectrumCache&, const fft::Backend&,
                                                                           const fft::Convolution<float>&,
                                                                           const Grid&, Boundary);
template std::shared_ptr<const fft::Spectrum<double>> conductance_spectrum(SpectrumCache&,
                                                                           const fft::Convolution<double>&,
                                                                           const Grid&);
template std::shared_ptr<const fft::Spectrum<float>> conductance_spectrum(SpectrumCache&,
                                                                          const fft::Convolution<float>&, const Grid&);

}  // namespace brinell::influence
