// A sphere that slides, against the exact field (support/sliding_sphere.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "subsurface/depths.h"
#include "subsurface/stress_case.h"
#include "support/sliding_sphere.h"
#include "support/stress_quadrature.h"

namespace brinell::subsurface {
namespace {

TEST(SlidingSphere, reference_is_made_of_the_point_forces) {
  reference::SlidingSphere sphere;
  sphere.friction = 0.7;
  sphere.nu = 0.28;
  for (const auto& [x, y, z] : {std::array{0.3, -0.4, 0.2}, {-1.5, 0.1, 0.9}, {0.0, 0.0, 1.0}, {2.0, 3.0, 0.01}}) {
    const auto normal = reference::normal_force(x, y, z, sphere.nu);
    const auto along = reference::tangential_force(x, y, z, sphere.nu);
    const auto found = sphere.point(x, y, z, 0);
    for (std::size_t c = 0; c < 6; ++c) {
      const auto expected = static_cast<double>(normal[c] + 0.7L * along[c]);
      EXPECT_NEAR(found[c], expected, 1e-12 * (1 + std::abs(expected))) << c;
    }
  }
}

TEST(SlidingSphere, reference_is_the_integral_of_the_point_forces_over_the_contact) {
  reference::SlidingSphere sphere;
  sphere.friction = 0.4;
  // Polar midpoint rule, smooth in r' = sin u: its error is below 1e-6 at these depths.
  for (const auto& [x, y, z] : {std::array{0.3, -0.4, 0.5}, {-1.1, 0.2, 0.7}}) {
    std::array<long double, 6> sum{};
    constexpr int n = 600;
    for (int k = 0; k < n; ++k) {
      const double u = std::numbers::pi / 2 * (k + 0.5) / n, r = std::sin(u);
      const double share = std::cos(u) * r * std::cos(u) * (std::numbers::pi / 2 / n) * (2 * std::numbers::pi / n);
      for (int l = 0; l < n; ++l) {
        const double angle = 2 * std::numbers::pi * l / n;
        const auto normal = reference::normal_force(x - r * std::cos(angle), y - r * std::sin(angle), z, sphere.nu);
        const auto along =
            reference::tangential_force(x - r * std::cos(angle), y - r * std::sin(angle), z, sphere.nu);
        for (std::size_t c = 0; c < 6; ++c) sum[c] += share * (normal[c] + 0.4L * along[c]);
      }
    }
    const auto found = sphere(x, y, z);
    for (std::size_t c = 0; c < 6; ++c) {
      EXPECT_NEAR(found[c], static_cast<double>(sum[c] / (2 * std::numbers::pi_v<long double>)), 3e-6) << c;
    }
  }
}

StressRequest below_contact(std::int64_t cells, std::vector<double> depths) {
  const double h = 1.0 / static_cast<double>(cells);
  StressRequest request;
  request.grid = {4 * cells + 1, 3 * cells + 1, h, h};
  request.poissons_ratio = 0.3;
  request.depths = std::move(depths);
  request.sources = {Traction::pressure, Traction::shear_x};
  return request;
}

std::vector<double> times(const std::vector<double>& values, double factor) {
  std::vector<double> result(values);
  for (double& value : result) value *= factor;
  return result;
}

TEST(SlidingSphere, stress_agrees_with_the_exact_field_to_second_order) {
  for (const double friction : {0.1, 0.3, 0.5}) {
    reference::SlidingSphere sphere;
    sphere.friction = friction;
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const std::int64_t cells = 8 << k;
      StressRequest request = below_contact(cells, {0.25, 0.5, 1.0});
      request.components = kAllComponents;
      const std::vector<double> pressure = hertz_pressure(request.grid, 1), shear = times(pressure, friction);
      const Fields fields = computed(Engine(), request, {pressure.data(), shear.data(), nullptr});
      error[k] = 0;
      const Grid& grid = request.grid;
      for (std::size_t layer = 0; layer < 3; ++layer) {
        for (std::int64_t j = cells / 4; j < grid.ny; j += cells / 2) {
          for (std::int64_t i = 0; i < grid.nx; i += cells / 4) {
            const auto expected = sphere(grid.x(i), grid.y(j), request.depths[layer]);
            const auto found = fields.at(layer * grid.nodes() + static_cast<std::size_t>(j * grid.nx + i));
            for (std::size_t c = 0; c < 6; ++c) error[k] = std::max(error[k], std::abs(found[c] - expected[c]));
          }
        }
      }
      const double h = 1.0 / static_cast<double>(cells);
      EXPECT_LT(error[k], 0.7 * h * h) << friction;
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.4) << friction;
    EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.4) << friction;
  }
}

/// On the surface within the contact, y = 0 (K. L. Johnson, Contact Mechanics, 1985, eq. 3.43; Hamilton, 1983).
Tensor on_the_surface(double x, double friction, double nu) {
  const double m = 1 - 2 * nu, p = std::sqrt(1 - x * x);
  const double part = x == 0 ? m / 2 : m / (3 * x * x) * (1 - p * p * p);
  const double pi = std::numbers::pi;
  return {part - p - friction * pi / 2 * (1 + nu / 4) * x,
          -part - 2 * nu * p - friction * 3 * pi / 8 * nu * x,
          -p,
          0,
          -friction * p,
          0};
}

TEST(SlidingSphere, surface_stress_agrees_with_the_closed_form_inside_the_contact) {
  for (const double friction : {0.0, 0.4}) {
    double error[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
      const std::int64_t cells = 16 << k;
      StressRequest request = below_contact(cells, {0.0});
      request.components = kAllComponents;
      const std::vector<double> pressure = hertz_pressure(request.grid, 1), shear = times(pressure, friction);
      const Fields fields = computed(Engine(), request, {pressure.data(), shear.data(), nullptr});
      const Grid& grid = request.grid;
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        if (std::abs(grid.x(i)) > 0.7) continue;  // the edge's square root reaches further than its cells
        const Tensor expected = on_the_surface(grid.x(i), friction, 0.3);
        const auto found = fields.at(static_cast<std::size_t>(grid.ny / 2 * grid.nx + i));
        for (std::size_t c = 0; c < 6; ++c) error[k] = std::max(error[k], std::abs(found[c] - expected[c]));
      }
    }
    // At z = 0 the steps of the shear between cells act on σ_xx as ln|distance|, of which sums at half-integer
    // distances have an error ln 2 · h times the shear's slope: first order. Without shear nothing is worse than the
    // edge.
    EXPECT_LT(error[0], friction > 0 ? 0.012 : 0.004) << friction;
    EXPECT_GT(error[0] / error[1], 1.9) << friction;
  }
}

// The exact field has its largest von Mises stress below the surface up to a friction of 0.31, and beyond at the
// trailing edge (−a, 0, 0), on a peak as sharp as √distance: there cells of side h lose a share of √h.
TEST(SlidingSphere, largest_von_mises_stress_moves_to_the_surface_as_friction_grows) {
  const auto largest = [](std::int64_t cells, double friction) {
    std::vector<double> depths{0.0};
    for (const double z : layer_depths(40, 0.025)) depths.push_back(z);
    StressRequest request = below_contact(cells, depths);
    request.maxima = {Invariant::von_mises};
    const std::vector<double> pressure = hertz_pressure(request.grid, 1), shear = times(pressure, friction);
    return computed(Engine(), request, {pressure.data(), shear.data(), nullptr}).maxima[0];
  };
  constexpr std::int64_t cells = 24;
  const double h = 1.0 / cells;
  for (const double friction : {0.0, 0.1, 0.2, 0.25, 0.3}) {
    const Maximum found = largest(cells, friction);
    reference::SlidingSphere sphere;
    sphere.friction = friction;
    const double exact = von_mises(sphere(found.position[0], 0, found.position[2]));
    EXPECT_GT(found.position[2], 0.35) << friction;
    EXPECT_NEAR(found.position[0], 1.1 * friction, 0.03) << friction;
    EXPECT_NEAR(found.position[1], 0, 1e-9) << friction;
    EXPECT_NEAR(found.value, exact, 0.3 * h * h) << friction;
    EXPECT_GT(exact, von_mises(on_the_surface(-1, friction, 0.3))) << friction;
    for (const double step : {-0.02, 0.02}) {  // nothing larger beside it
      EXPECT_LT(von_mises(sphere(found.position[0] + step, 0, found.position[2])), exact + 1e-5);
      EXPECT_LT(von_mises(sphere(found.position[0], 0, found.position[2] + step)), exact + 1e-5);
    }
  }
  for (const double friction : {0.4, 0.5}) {
    const double exact = von_mises(on_the_surface(-1, friction, 0.3));
    double loss[2];
    for (int k = 0; k < 2; ++k) {
      const Maximum found = largest(cells << k, friction);
      EXPECT_EQ(found.position[2], 0) << friction;
      EXPECT_LT(found.position[0], -0.4) << friction;
      loss[k] = exact - found.value;
      EXPECT_GT(loss[k], 0) << friction;
      EXPECT_LT(loss[k], 0.4 * std::sqrt(h)) << friction;
    }
    EXPECT_GT(loss[0], loss[1]) << friction;
  }
}

}  // namespace
}  // namespace brinell::subsurface
