#include "influence/spectra.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fft/plan_cache.h"
#include "influence/displacement.h"
#include "influence/stress.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::influence {
namespace {

constexpr std::size_t kLimit = 64 << 20;

class Spectra : public testing::Test {
 protected:
  template <class Real>
  std::vector<Real> apply(const fft::Convolution<Real>& convolution, const fft::Spectrum<Real>& spectrum,
                          const std::vector<Real>& source) {
    std::vector<Real> result(source.size());
    const auto workspace = convolution.workspace();
    convolution.apply(spectrum, source.data(), result.data(), *workspace);
    return result;
  }

  parallel::Arena arena{1};
  fft::PlanCache plans;
  fft::Backend backend{arena, simd::best_kernels(), plans};
  SpectrumCache cache{kLimit};
};

// A pressure that favours no symmetry.
template <class Real>
std::vector<Real> some_pressure(const Grid& grid) {
  std::vector<Real> pressure;
  for (std::size_t k = 0; k < grid.nodes(); ++k) pressure.push_back(static_cast<Real>((k * k * 7 + 3 * k) % 11));
  return pressure;
}

TEST_F(Spectra, free_displacement_is_the_sum_over_the_influence_coefficients) {
  for (const Grid grid : {Grid{1, 1, 1e-6, 2e-6}, Grid{7, 5, 1e-6, 2e-6}, Grid{16, 3, 3, 1}}) {
    const fft::Convolution<double> convolution(backend, grid.nx, grid.ny, Boundary::free);
    const auto spectrum = displacement_spectrum(cache, backend, convolution, grid, Boundary::free);
    const auto pressure = some_pressure<double>(grid);
    const auto displacement = apply(convolution, *spectrum, pressure);
    const Displacement coefficient(grid.dx, grid.dy);
    double total = 0;
    for (const double p : pressure) total += p;
    for (std::int64_t n = 0; n < static_cast<std::int64_t>(grid.nodes()); ++n) {
      double sum = 0;
      for (std::int64_t m = 0; m < static_cast<std::int64_t>(grid.nodes()); ++m) {
        sum += coefficient(n % grid.nx - m % grid.nx, n / grid.nx - m / grid.nx) * pressure[m];
      }
      EXPECT_NEAR(displacement[n], sum,
                  1e-14 * total * coefficient(0, 0));  // eps times a few levels of the transform
    }
  }
}

TEST_F(Spectra, come_from_the_cache_the_second_time) {
  const Grid grid{12, 10, 1, 1};
  const fft::Convolution<double> first(backend, 12, 10, Boundary::free), second(backend, 12, 10, Boundary::free);
  const fft::Convolution<double> periodic(backend, 12, 10, Boundary::periodic);
  const fft::Convolution<float> single(backend, 12, 10, Boundary::free);
  const auto spectrum = displacement_spectrum(cache, backend, first, grid, Boundary::free);
  EXPECT_EQ(displacement_spectrum(cache, backend, second, grid, Boundary::free), spectrum);
  const auto other = displacement_spectrum(cache, backend, periodic, grid, Boundary::periodic);
  EXPECT_NE(other, spectrum);
  const auto conductance = conductance_spectrum(cache, periodic, grid);
  EXPECT_NE(conductance, other);
  EXPECT_EQ(conductance_spectrum(cache, periodic, grid), conductance);
  EXPECT_NE(displacement_spectrum(cache, backend, single, grid, Boundary::free), nullptr);
}

TEST_F(Spectra, periodic_displacement_of_a_wave_is_two_over_its_wave_number) {
  const Grid grid{12, 9, 0.5e-6, 0.7e-6};
  const fft::Convolution<double> convolution(backend, grid.nx, grid.ny, Boundary::periodic);
  const auto spectrum = displacement_spectrum(cache, backend, convolution, grid, Boundary::periodic);
  for (const std::int64_t kx : {0, 1, 5, 6}) {  // 6: the Nyquist wave number of 12 nodes
    for (const std::int64_t ky : {0, 2, 4}) {
      const double qx = 2 * std::numbers::pi * static_cast<double>(kx) / (12 * grid.dx);
      const double qy = 2 * std::numbers::pi * static_cast<double>(ky) / (9 * grid.dy);
      const double expected = kx == 0 && ky == 0 ? 0.0 : 2 / std::hypot(qx, qy);
      EXPECT_NEAR(displacement_symbol(grid, kx, ky), expected, 1e-15 * expected);
      std::vector<double> pressure;
      for (std::int64_t j = 0; j < grid.ny; ++j) {
        for (std::int64_t i = 0; i < grid.nx; ++i) {
          pressure.push_back(std::cos(qx * static_cast<double>(i) * grid.dx + qy * static_cast<double>(j) * grid.dy));
        }
      }
      const auto displacement = apply(convolution, *spectrum, pressure);
      for (std::size_t n = 0; n < pressure.size(); ++n) {
        EXPECT_NEAR(displacement[n], expected * pressure[n], 1e-14 * 2 / std::hypot(1 / grid.dx, 1 / grid.dy));
      }
    }
  }
}

TEST_F(Spectra, mean_of_a_periodic_displacement_is_zero) {
  for (const Grid grid : {Grid{12, 9, 1, 1}, Grid{7, 16, 2e-6, 1e-6}}) {
    const fft::Convolution<double> convolution(backend, grid.nx, grid.ny, Boundary::periodic);
    const auto displacement =
        apply(convolution, *displacement_spectrum(cache, backend, convolution, grid, Boundary::periodic),
              some_pressure<double>(grid));
    double mean = 0;
    for (const double u : displacement) mean += u;
    EXPECT_NEAR(mean, 0.0, 1e-12 * grid.dx);
  }
}

TEST_F(Spectra, conductance_is_the_positive_definite_graph_of_an_m_matrix) {
  for (const Grid grid :
       {Grid{12, 9, 1, 1}, Grid{7, 16, 2e-6, 1e-6}, Grid{1, 5, 1, 3}, Grid{8, 1, 1, 1}, Grid{1, 1, 1, 1}}) {
    const fft::Convolution<double> convolution(backend, grid.nx, grid.ny, Boundary::periodic);
    std::vector<double> unit(grid.nodes());
    unit[0] = 1;
    const auto row = apply(convolution, *conductance_spectrum(cache, convolution, grid), unit);
    double sum = 0;
    for (std::size_t n = 0; n < row.size(); ++n) {
      sum += row[n];
      const double share_of_zero = row[0] / static_cast<double>(row.size());
      if (n != 0) {
        EXPECT_LE(row[n], share_of_zero);
      }
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_NEAR(sum, conductance_symbol(grid, 0, 0), 1e-13 * row[0]);
  }
}

TEST_F(Spectra, conductance_of_a_long_wave_is_half_its_wave_number) {
  const Grid grid{512, 256, 1e-6, 2e-6};
  for (const std::int64_t k : {1, 2, 4}) {
    // sin(x) = x (1 - x²/6 + ...) with x = pi k/n
    const double qx = 2 * std::numbers::pi * static_cast<double>(k) / (512 * grid.dx);
    EXPECT_NEAR(conductance_symbol(grid, k, 0), qx / 2, std::pow(qx * grid.dx / 2, 2) / 6 * qx / 2 * 1.01);
  }
}

TEST_F(Spectra, in_single_precision_agree_with_double) {
  const Grid grid{20, 15, 1e-6, 1e-6};
  const fft::Convolution<double> in_double(backend, grid.nx, grid.ny, Boundary::free);
  const fft::Convolution<float> in_single(backend, grid.nx, grid.ny, Boundary::free);
  const auto fine = apply(in_double, *displacement_spectrum(cache, backend, in_double, grid, Boundary::free),
                          some_pressure<double>(grid));
  const auto coarse = apply(in_single, *displacement_spectrum(cache, backend, in_single, grid, Boundary::free),
                            some_pressure<float>(grid));
  for (std::size_t n = 0; n < fine.size(); ++n) EXPECT_NEAR(coarse[n], fine[n], 2e-6 * fine[n]);  // 2^-23, ten levels
}

TEST_F(Spectra, of_stress_follow_the_parities_of_each_component) {
  const Grid grid{6, 5, 1, 0.8};
  const fft::Convolution<double> convolution(backend, grid.nx, grid.ny, Boundary::free);
  const auto source = some_pressure<double>(grid);
  const Stress stress(grid.dx, grid.dy, 0.6, 0.3);
  for (const Traction traction : {Traction::pressure, Traction::shear_x, Traction::shear_y}) {
    std::vector<std::vector<double>> coefficients(6, std::vector<double>(grid.nodes()));
    std::array<double*, 6> targets{};
    for (int c = 0; c < 6; ++c) targets[c] = coefficients[c].data();
    stress.fill(arena, simd::best_kernels(), traction, grid.nx, grid.ny, targets);
    for (int c = 0; c < 6; ++c) {
      const Parities parities = stress_parities(traction, static_cast<StressComponent>(c));
      const auto result = apply(convolution, convolution.spectrum(targets[c], parities.x, parities.y), source);
      for (std::int64_t n = 0; n < static_cast<std::int64_t>(grid.nodes()); ++n) {
        double sum = 0;
        for (std::int64_t m = 0; m < static_cast<std::int64_t>(grid.nodes()); ++m) {
          sum += stress(traction, n % grid.nx - m % grid.nx, n / grid.nx - m / grid.nx)[c] * source[m];
        }
        EXPECT_NEAR(result[n], sum, 1e-13) << static_cast<int>(traction) << ", " << c;  // sums of about 150
      }
    }
  }
}

}  // namespace
}  // namespace brinell::influence
