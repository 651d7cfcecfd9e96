#include "subsurface/stress_spectra.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "influence/stress.h"

namespace brinell::subsurface {

namespace {

struct Response {
  int traction, component;
};

Response same_as(Response response) {
  const auto is = [&](Traction traction, StressComponent component) {
    return response.traction == static_cast<int>(traction) && response.component == static_cast<int>(component);
  };
  const auto other = [](Traction traction, StressComponent component) {
    return Response{static_cast<int>(traction), static_cast<int>(component)};
  };
  if (is(Traction::shear_x, StressComponent::zz)) return other(Traction::pressure, StressComponent::xz);
  if (is(Traction::shear_y, StressComponent::zz)) return other(Traction::pressure, StressComponent::yz);
  if (is(Traction::shear_y, StressComponent::xz)) return other(Traction::shear_x, StressComponent::yz);
  return response;
}

/// Stress of a wave of unit amplitude without its e^{ikx}: the real or the imaginary part, whichever is not zero.
double wave_stress(Traction traction, StressComponent component, double kx, double ky, double z, double nu) {
  const double q = std::hypot(kx, ky), decay = std::exp(-q * z), c = kx / q, s = ky / q;
  double nn = 0, tt = 0, nt = 0, zz = 0, nz = 0, tz = 0;
  if (traction == Traction::pressure) {
    nn = -(1 - q * z), tt = -2 * nu, zz = -(1 + q * z), nz = q * z;
  } else {
    const double along = traction == Traction::shear_x ? c : s;    // of the shear, in n
    const double across = traction == Traction::shear_x ? -s : c;  // and in t
    nn = along * (2 - q * z), tt = along * 2 * nu, nt = across, zz = along * q * z;
    nz = -along * (1 - q * z), tz = -across;
  }
  switch (component) {
    case StressComponent::xx: return decay * (c * c * nn + s * s * tt - 2 * c * s * nt);
    case StressComponent::yy: return decay * (s * s * nn + c * c * tt + 2 * c * s * nt);
    case StressComponent::zz: return decay * zz;
    case StressComponent::yz: return decay * (s * nz + c * tz);
    case StressComponent::xz: return decay * (c * nz - s * tz);
    case StressComponent::xy: return decay * (c * s * (nn - tt) + (c * c - s * s) * nt);
  }
  return 0;
}

/// Under uniform tractions that have no end, without mean strain in x and y.
double uniform_stress(Traction traction, StressComponent component, double nu) {
  switch (component) {
    case StressComponent::xx:
    case StressComponent::yy: return traction == Traction::pressure ? -nu / (1 - nu) : 0;
    case StressComponent::zz: return traction == Traction::pressure ? -1 : 0;
    case StressComponent::yz: return traction == Traction::shear_y ? -1 : 0;
    case StressComponent::xz: return traction == Traction::shear_x ? -1 : 0;
    case StressComponent::xy: return 0;
  }
  return 0;
}

fft::Spectrum<double> periodic_spectrum(const fft::Convolution<double>& convolution, const StressRequest& request,
                                        double depth, Traction traction, StressComponent component) {
  const Grid& grid = request.grid;
  const double step_x = 2 * std::numbers::pi / (static_cast<double>(grid.nx) * grid.dx);
  const double step_y = 2 * std::numbers::pi / (static_cast<double>(grid.ny) * grid.dy);
  const influence::Parities parities = influence::stress_parities(traction, component);
  // The convolution supplies −i for each odd axis: i s = (−i)(−s), and s = (−i)² (−s).
  const bool odd = parities.x == fft::Parity::odd || parities.y == fft::Parity::odd;
  return convolution.spectrum_of_symbol(
      [&](std::int64_t kx, std::int64_t ky) {
        if (kx == 0 && ky == 0) return uniform_stress(traction, component, request.poissons_ratio);
        const double stress = wave_stress(traction, component, static_cast<double>(kx) * step_x,
                                          static_cast<double>(ky) * step_y, depth, request.poissons_ratio);
        return odd ? -stress : stress;
      },
      parities.x, parities.y);
}

}  // namespace

SpectrumIndex::SpectrumIndex(Sources sources, Components needed) {
  number_.fill(-1);
  generated_.fill(-1);
  for (int traction = 0; traction < kTractions; ++traction) {
    if (!sources.has(traction)) continue;
    for (int component = 0; component < kComponents; ++component) {
      if (!needed.has(component)) continue;
      const Response shared = same_as({traction, component});
      int& generated = generated_[at(shared.traction, shared.component)];
      if (generated < 0) generated = count_++;
      number_[at(traction, component)] = generated;
    }
  }
}

bool SpectrumIndex::generates(int traction) const {
  for (int component = 0; component < kComponents; ++component) {
    if (generated(traction, component) >= 0) return true;
  }
  return false;
}

void generate_spectra(const fft::Backend& backend, const fft::Convolution<double>& convolution,
                      const StressRequest& request, double depth, Traction traction, const SpectrumIndex& index,
                      Buffer<double>& coefficients, fft::Workspace<double>& workspace, LayerSpectra& spectra) {
  const Grid& grid = request.grid;
  const int source = static_cast<int>(traction);
  if (request.boundary == Boundary::periodic) {
    for (int c = 0; c < kComponents; ++c) {
      if (index.generated(source, c) < 0) continue;
      spectra[static_cast<std::size_t>(index.generated(source, c))] =
          periodic_spectrum(convolution, request, depth, traction, static_cast<StressComponent>(c));
    }
    return;
  }
  std::array<double*, kComponents> targets{};
  for (int c = 0; c < kComponents; ++c) {
    if (index.generated(source, c) >= 0) {
      targets[static_cast<std::size_t>(c)] = coefficients.data() + static_cast<std::size_t>(c) * grid.nodes();
    }
  }
  const influence::Stress stress(grid.dx, grid.dy, depth, request.poissons_ratio);
  stress.fill(backend.arena, backend.kernels, traction, grid.nx, grid.ny, targets);
  for (int c = 0; c < kComponents; ++c) {
    if (index.generated(source, c) < 0) continue;
    const influence::Parities parities = influence::stress_parities(traction, static_cast<StressComponent>(c));
    spectra[static_cast<std::size_t>(index.generated(source, c))] =
        convolution.spectrum(targets[static_cast<std::size_t>(c)], parities.x, parities.y, &workspace);
  }
}

}  // namespace brinell::subsurface
