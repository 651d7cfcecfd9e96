// Periodic boundary: waves against their closed form, and long periods against the free boundary.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "subsurface/stress_case.h"

namespace brinell::subsurface {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

StressRequest periodic_request(const Grid& grid, std::vector<double> depths) {
  StressRequest request;
  request.grid = grid;
  request.boundary = Boundary::periodic;
  request.poissons_ratio = 0.3;
  request.depths = std::move(depths);
  request.sources = kAllSources;
  request.components = kAllComponents;
  return request;
}

std::vector<double> three_fields(const Grid& grid, auto pressure, auto shear_x, auto shear_y) {
  std::vector<double> values;
  for (const auto& field :
       {std::function<double(double, double)>(pressure), std::function<double(double, double)>(shear_x),
        std::function<double(double, double)>(shear_y)}) {
    for (std::int64_t j = 0; j < grid.ny; ++j) {
      for (std::int64_t i = 0; i < grid.nx; ++i) values.push_back(field(grid.x(i), grid.y(j)));
    }
  }
  return values;
}

Fields computed_from(const Engine& engine, const StressRequest& request, const std::vector<double>& values) {
  const std::size_t nodes = request.grid.nodes();
  return computed(engine, request, {values.data(), values.data() + nodes, values.data() + 2 * nodes});
}

double zero(double, double) {
  return 0;
}

// K. L. Johnson, Contact Mechanics, 1985, §13.2: plane strain under p cos kx, tension positive.
TEST(Periodic, pressure_waves_have_the_known_stress) {
  for (const Grid& grid : {Grid{32, 8, 0.5, 1.0}, Grid{15, 7, 1.0, 1.0}}) {  // both kinds of transform
    const double k = kTwoPi * 2 / (static_cast<double>(grid.nx) * grid.dx), z = 0.7, decay = std::exp(-k * z);
    const auto values = three_fields(
        grid, [&](double x, double) { return std::cos(k * x); }, zero, zero);
    for (const simd::Isa isa : simd::supported()) {
      const Fields fields = computed_from(Engine(1, isa), periodic_request(grid, {z}), values);
      for (std::int64_t j = 0; j < grid.ny; ++j) {
        for (std::int64_t i = 0; i < grid.nx; ++i) {
          const double x = grid.x(i), c = std::cos(k * x) * decay, s = std::sin(k * x) * decay;
          const auto found = fields.at(static_cast<std::size_t>(j * grid.nx + i));
          const double expected[6] = {-(1 - k * z) * c, -0.6 * c, -(1 + k * z) * c, 0, -k * z * s, 0};
          for (std::size_t q = 0; q < 6; ++q) EXPECT_NEAR(found[q], expected[q], 1e-14) << q;
        }
      }
    }
  }
}

TEST(Periodic, mean_tractions_make_uniform_stress_without_lateral_strain) {
  const Grid grid{8, 16, 1, 1};
  const auto values = three_fields(
      grid, [](double, double) { return 2.0; }, [](double, double) { return 0.5; },
      [](double, double) { return -0.25; });
  const Fields fields = computed_from(Engine(), periodic_request(grid, {0.0, 9.0}), values);
  const double expected[6] = {-2 * 0.3 / 0.7, -2 * 0.3 / 0.7, -2, 0.25, -0.5, 0};
  for (std::size_t n = 0; n < 2 * grid.nodes(); ++n) {
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(fields.component[c][n], expected[c], 1e-14);
  }
}

TEST(Periodic, surface_carries_the_tractions) {
  for (const Grid& grid : {Grid{16, 12, 1, 1}, Grid{9, 11, 1, 2}, Grid{48, 20, 1, 1}, Grid{1, 6, 1, 1}}) {
    // Without the Nyquist wave numbers a real field is what its samples say.
    const double kx = kTwoPi / (static_cast<double>(grid.nx) * grid.dx);
    const double ky = kTwoPi / (static_cast<double>(grid.ny) * grid.dy);
    const auto values = three_fields(
        grid, [&](double x, double y) { return std::sin(3 * kx * x + 2 * ky * y) + 0.3 * std::cos(ky * y); },
        [&](double x, double y) { return std::cos(kx * x - ky * y) + 0.1; },
        [&](double x, double y) { return std::sin(2 * kx * x) * std::cos(ky * y); });
    const Fields fields = computed_from(Engine(), periodic_request(grid, {0.0}), values);
    for (std::size_t n = 0; n < grid.nodes(); ++n) {
      EXPECT_NEAR(fields.component[kZz][n], -values[n], 1e-13);
      EXPECT_NEAR(fields.component[kXz][n], -values[grid.nodes() + n], 1e-13);
      EXPECT_NEAR(fields.component[kYz][n], -values[2 * grid.nodes() + n], 1e-13);
    }
  }
}

// Balanced loads in the middle of a long period: images are many widths away, and the samples are smooth, so that the
// cells' averages and the trigonometric polynomial differ by the second order of the spacing.
TEST(Periodic, long_periods_approach_the_free_boundary) {
  const auto bump = [](double x, double y) { return std::exp(-0.5 * (x * x + y * y)); };
  const auto pressure = [&](double x, double y) { return (1 - 0.5 * (x * x + y * y)) * bump(x, y); };  // no resultant
  const auto shear_x = [&](double x, double y) { return 0.5 * x * y * bump(x, y); };
  const auto shear_y = [&](double x, double y) { return 0.4 * (x * x - 1) * bump(x, y); };
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const std::int64_t n = 64 << k;
    const double h = 32.0 / static_cast<double>(n);
    const Grid grid{n, n, h, h};
    StressRequest request = periodic_request(grid, {0.6, 1.5});
    const auto values = three_fields(grid, pressure, shear_x, shear_y);
    const Engine engine;
    const Fields periodic = computed_from(engine, request, values);
    request.boundary = Boundary::free;
    const Fields free = computed_from(engine, request, values);
    error[k] = 0;
    for (std::size_t c = 0; c < 6; ++c) {
      for (std::size_t layer = 0; layer < 2; ++layer) {
        for (std::int64_t j = n / 4; j < 3 * n / 4; ++j) {
          for (std::int64_t i = n / 4; i < 3 * n / 4; ++i) {
            const std::size_t at = layer * grid.nodes() + static_cast<std::size_t>(j * n + i);
            error[k] = std::max(error[k], std::abs(periodic.component[c][at] - free.component[c][at]));
          }
        }
      }
    }
    EXPECT_LT(error[k], 0.15 * h * h);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.4);
}

TEST(Periodic, shift_of_the_tractions_shifts_the_stress) {
  const Grid grid{24, 10, 1, 1};
  const RandomTractions tractions(grid);
  RandomTractions shifted(grid);
  for (std::size_t t = 0; t < 3; ++t) {
    for (std::size_t j = 0; j < 10; ++j) {
      for (std::size_t i = 0; i < 24; ++i) {
        shifted.values[t * 240 + (j + 3) % 10 * 24 + (i + 7) % 24] = tractions.values[t * 240 + j * 24 + i];
      }
    }
  }
  const Engine engine(2);
  const StressRequest request = periodic_request(grid, {0.5, 2.0});
  const Fields a = computed(engine, request, tractions.pointers()), b = computed(engine, request, shifted.pointers());
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t layer = 0; layer < 2; ++layer) {
      for (std::size_t j = 0; j < 10; ++j) {
        for (std::size_t i = 0; i < 24; ++i) {
          EXPECT_NEAR(a.component[c][layer * 240 + j * 24 + i],
                      b.component[c][layer * 240 + (j + 3) % 10 * 24 + (i + 7) % 24], 1e-14);
        }
      }
    }
  }
}

}  // namespace
}  // namespace brinell::subsurface
