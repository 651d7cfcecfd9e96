// Known values below Hertzian contacts. The pressure of a cell is its average, so that errors are of second order in
// the spacing h: the tests see it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "subsurface/depths.h"
#include "subsurface/stress_case.h"
#include "support/stress_quadrature.h"

namespace brinell::subsurface {
namespace {

struct Peak {
  double nu, value, depth;
};

/// K. L. Johnson, Contact Mechanics, 1985, eq. 3.45, on the axis: von Mises is |σ_zz − σ_xx|.
double on_the_axis(double z, double nu) {
  const double zz = -1 / (1 + z * z), xx = -(1 + nu) * (1 - z * std::atan(1 / z)) - 0.5 * zz;
  return std::abs(zz - xx);
}

TEST(Hertz, largest_von_mises_stress_below_a_sphere_is_the_known_one) {
  for (const Peak& peak : {Peak{0.3, 0.620041, 0.48086}, Peak{0.25, 0.643357, 0.46431}}) {
    EXPECT_NEAR(on_the_axis(peak.depth, peak.nu), peak.value, 1e-6);
    double error[3];
    for (int k = 0; k < 3; ++k) {
      const std::int64_t cells = 8 << k;  // per radius a = 1
      const double h = 1.0 / static_cast<double>(cells);
      StressRequest request;
      request.grid = {2 * cells + 3, 2 * cells + 3, h, h};
      request.poissons_ratio = peak.nu;
      request.depths = layer_depths(2 * cells, 0.5 * h);
      request.maxima = {Invariant::von_mises};
      const std::vector<double> pressure = hertz_pressure(request.grid, 1);
      const Maximum found = computed(Engine(), request, {pressure.data(), nullptr, nullptr}).maxima[0];
      error[k] = std::abs(found.value - peak.value);
      EXPECT_NEAR(found.position[0], 0, 1e-9);
      EXPECT_NEAR(found.position[1], 0, 1e-9);
      EXPECT_NEAR(found.position[2], peak.depth, 0.5 * h * h + 1e-5);
      EXPECT_LT(error[k], 0.2 * h * h);
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.3);
    EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.3);
  }
}

TEST(Hertz, largest_shear_stress_below_a_line_contact_is_the_known_one) {
  double at_depth[3];
  for (int k = 0; k < 3; ++k) {
    const std::int64_t cells = 8 << k;
    const double h = 1.0 / static_cast<double>(cells);
    StressRequest request;
    request.grid = {2 * cells + 3, 1, h, 2e5};  // its ends take away a share of about a/length
    request.poissons_ratio = 0.3;
    request.depths = layer_depths(3 * cells, 0.5 * h);
    request.maxima = {Invariant::tresca};
    std::vector<double> pressure(request.grid.nodes());
    const auto primitive = [](double x) {
      const double c = std::min(1.0, std::max(-1.0, x));
      return 0.5 * (c * std::sqrt(1 - c * c) + std::asin(c));
    };
    for (std::int64_t i = 0; i < request.grid.nx; ++i) {
      const double x = request.grid.x(i);
      pressure[static_cast<std::size_t>(i)] = (primitive(x + h / 2) - primitive(x - h / 2)) / h;
    }
    const Maximum found = computed(Engine(), request, {pressure.data(), nullptr, nullptr}).maxima[1];
    const double error = std::abs(0.5 * found.value - 0.300283);
    EXPECT_NEAR(found.position[0], 0, 1e-6);
    EXPECT_NEAR(found.position[2], 0.78615, 0.5 * h * h + 1e-5);
    EXPECT_LT(error, 0.1 * h * h + 2e-6);
    const double z = 0.7861514;  // √((√5 − 1)/2)
    request.depths = {z};
    const double tau = computed(Engine(), request, {pressure.data(), nullptr, nullptr}).maxima[1].node_value / 2;
    at_depth[k] = std::abs(tau - (z - z * z / std::sqrt(1 + z * z)));  // Johnson, eq. 4.47
  }
  // The fit between nodes has an error of its own; at the known depth the stress alone is of second order.
  EXPECT_NEAR(std::log2(at_depth[0] / at_depth[1]), 2, 0.3);
  EXPECT_NEAR(std::log2(at_depth[1] / at_depth[2]), 2, 0.3);
}

TEST(Stress, of_a_few_loaded_cells_is_far_away_that_of_a_point_force) {
  StressRequest request;
  request.grid = {121, 101, 1.0, 1.2};
  request.poissons_ratio = 0.28;
  request.depths = {3.0, 40.0};
  request.sources = kAllSources;
  request.components = kAllComponents;
  std::vector<double> tractions(3 * request.grid.nodes());
  const double force[3] = {2.0, 0.7, -1.3};
  const std::size_t centre = request.grid.nodes() / 2;
  for (std::size_t t = 0; t < 3; ++t)
    tractions[t * request.grid.nodes() + centre] = force[t] / request.grid.cell_area();
  const double* p = tractions.data();
  const Fields fields = computed(Engine(), request, {p, p + request.grid.nodes(), p + 2 * request.grid.nodes()});
  for (std::size_t layer = 0; layer < 2; ++layer) {
    for (const auto& [i, j] : {std::pair<std::int64_t, std::int64_t>{110, 80}, {5, 50}, {60, 2}, {20, 95}}) {
      const double x = request.grid.x(i), y = request.grid.y(j), z = request.depths[layer];
      const auto normal = reference::normal_force(x, y, z, request.poissons_ratio);
      const auto along_x = reference::tangential_force(x, y, z, request.poissons_ratio);
      const auto turned = reference::tangential_force(y, x, z, request.poissons_ratio);
      const reference::Six along_y{turned[1], turned[0], turned[2], turned[4], turned[3], turned[5]};
      const auto found = fields.at(layer * request.grid.nodes() + static_cast<std::size_t>(j * request.grid.nx + i));
      double largest = 0, error = 0;
      for (std::size_t c = 0; c < 6; ++c) {
        const auto expected =
            static_cast<double>((force[0] * normal[c] + force[1] * along_x[c] + force[2] * along_y[c]) /
                                (2 * std::numbers::pi_v<long double>));
        largest = std::max(largest, std::abs(expected));
        error = std::max(error, std::abs(found[c] - expected));
      }
      const double distance = std::hypot(x, y, z);
      EXPECT_LT(error, 3 * largest / (distance * distance));  // the cell's second moment against r²
    }
  }
}

}  // namespace
}  // namespace brinell::subsurface
