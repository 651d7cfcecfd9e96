#include "subsurface/maximum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace brinell::subsurface {
namespace {

using Function = std::function<double(double x, double y, double z)>;

Maximum found(const Grid& grid, Boundary boundary, const std::vector<double>& depths, const Function& f) {
  MaximumSearch search(grid, boundary, depths);
  std::vector<double> before, values(grid.nodes());
  for (std::size_t layer = 0; layer < depths.size(); ++layer) {
    for (std::int64_t j = 0; j < grid.ny; ++j) {
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        values[static_cast<std::size_t>(j * grid.nx + i)] = f(grid.x(i), grid.y(j), depths[layer]);
      }
    }
    search.take(values.data(), *std::max_element(values.begin(), values.end()),
                before.empty() ? nullptr : before.data());
    before = values;
  }
  return search.result();
}

void expect_at(const Maximum& maximum, double value, double x, double y, double z, double tolerance) {
  EXPECT_NEAR(maximum.value, value, tolerance);
  EXPECT_NEAR(maximum.position[0], x, tolerance);
  EXPECT_NEAR(maximum.position[1], y, tolerance);
  EXPECT_NEAR(maximum.position[2], z, tolerance);
}

const std::vector<double> kDepths{0.0, 0.1, 0.35, 0.9, 1.3, 2.4, 2.5};

TEST(Maximum, of_a_tilted_quadratic_is_exact_at_unequal_depths) {
  const Grid grid{15, 12, 0.2, 0.3};
  const Function f = [](double x, double y, double z) {
    const double u = x - 0.23, v = y + 0.31, w = z - 1.02;
    return 5 - 2 * u * u - v * v - 1.5 * w * w + 0.8 * u * v + 0.7 * v * w - 0.9 * u * w;
  };
  expect_at(found(grid, Boundary::free, kDepths, f), 5, 0.23, -0.31, 1.02, 1e-12);
}

TEST(Maximum, between_nodes_is_of_second_order_in_place_and_of_third_or_better_in_value) {
  const Function f = [](double x, double y, double z) {
    return std::exp(-0.7 * (x - 0.05) * (x - 0.05) - 0.5 * y * y) * z * std::exp(-z);  // largest at z = 1
  };
  double place[2], value[2];
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 0.2 : 0.1;
    std::vector<double> depths;
    for (double z = 0.3 * h; z < 2; z += h) depths.push_back(z);
    const Maximum maximum = found({21, 20, h, h}, Boundary::free, depths, f);
    place[k] = std::hypot(maximum.position[0] - 0.05, maximum.position[1], maximum.position[2] - 1);
    value[k] = std::abs(maximum.value - std::exp(-1.0));
  }
  EXPECT_GT(place[0] / place[1], 3.0);
  EXPECT_GT(value[0] / value[1], 6.0);
}

TEST(Maximum, at_borders_is_refined_along_the_other_directions) {
  const Grid grid{9, 1, 1.0, 1.0};
  const Function f = [](double x, double, double z) { return -(x - 0.25) * (x - 0.25) - z; };
  expect_at(found(grid, Boundary::free, kDepths, f), 0, 0.25, 0, 0, 1e-12);
  const Function corner = [](double x, double, double z) { return x + z; };
  expect_at(found(grid, Boundary::free, kDepths, corner), 6.5, 4, 0, 2.5, 1e-12);
  expect_at(found({1, 1, 1.0, 1.0}, Boundary::periodic, {0.5}, corner), 0.5, 0, 0, 0.5, 1e-12);
}

TEST(Maximum, at_a_border_of_a_periodic_grid_has_neighbours_across_it) {
  const Grid grid{16, 8, 1.0, 1.0};
  const double k = 2 * 3.14159265358979323846 / 16;
  const Function f = [k](double x, double, double) { return std::cos(k * (x - 7.7)); };  // nodes to 7.5
  const Maximum maximum = found(grid, Boundary::periodic, {0.5}, f);
  EXPECT_NEAR(maximum.position[0], 7.7, 0.2 * k * k);  // the third derivative's share
  EXPECT_NEAR(maximum.value, 1, 0.01 * k * k);
}

TEST(Maximum, of_a_constant_or_of_nothing_is_safe) {
  const Maximum flat = found({5, 5, 1.0, 1.0}, Boundary::free, kDepths, [](double, double, double) { return 3.0; });
  EXPECT_EQ(flat.value, 3);
  EXPECT_EQ(flat.i, 0);
  EXPECT_EQ(flat.layer, 0);
  const Maximum none =
      found({5, 5, 1.0, 1.0}, Boundary::free, kDepths, [](double, double, double) { return -HUGE_VAL; });
  EXPECT_EQ(none.value, 0);
}

TEST(Maximum, of_a_ridge_stays_near_its_node) {
  const Function ridge = [](double x, double y, double) { return -(x - y) * (x - y); };
  const Maximum maximum = found({7, 7, 1.0, 1.0}, Boundary::free, {1.0}, ridge);
  EXPECT_LE(std::hypot(maximum.position[0] + 3, maximum.position[1] + 3), 1.5);
  EXPECT_NEAR(maximum.value, 0, 1e-12);
}

}  // namespace
}  // namespace brinell::subsurface
