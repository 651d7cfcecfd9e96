#include "plastic/eigenstrain_displacement.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "base/error.h"
#include "influence/eigenstrain.h"
#include "influence/stress.h"
#include "plastic/strain_case.h"

namespace brinell::plastic {
namespace {

struct Place {
  std::int64_t x, y;
};

std::vector<double> displacement_of(const Engine& engine, const Grid& grid, const Box& box, Place first,
                                    const TensorField& strain, double nu = 0.3) {
  std::vector<double> result(grid.nodes(), std::numeric_limits<double>::quiet_NaN());
  EigenstrainDisplacement response(engine.backend, grid, box.nz, box.dz, nu);
  response.displacement(strain.pointers(), box, first.x, first.y, result.data());
  return result;
}

std::vector<double> direct_sum(const Grid& grid, const Box& box, Place first, const TensorField& strain, double nu) {
  const influence::Eigenstrain cuboid(box.dx, box.dy, box.dz, nu);
  std::vector<double> sum(grid.nodes());
  for (std::int64_t k = 0; k < box.nz; ++k) {
    for (std::int64_t y = 1 - grid.ny; y < grid.ny; ++y) {
      for (std::int64_t x = 1 - grid.nx; x < grid.nx; ++x) {
        const auto u = cuboid.displacement(static_cast<double>(x) * box.dx, static_cast<double>(y) * box.dy,
                                           (static_cast<double>(k) + 0.5) * box.dz);
        for (std::int64_t j = 0; j < box.ny; ++j) {
          for (std::int64_t i = 0; i < box.nx; ++i) {
            const std::int64_t to_x = first.x + i + x, to_y = first.y + j + y;
            if (to_x < 0 || to_y < 0 || to_x >= grid.nx || to_y >= grid.ny) continue;
            for (std::size_t c = 0; c < 6; ++c) {
              sum[static_cast<std::size_t>(to_y * grid.nx + to_x)] +=
                  u[c] * strain.at(c, static_cast<std::size_t>((k * box.ny + j) * box.nx + i));
            }
          }
        }
      }
    }
  }
  return sum;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

struct Case {
  Grid grid;
  Box box;
  Place first;
};
constexpr Case kCases[] = {
    {{1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {0, 0}},         {{13, 11, 1, 1}, {5, 7, 3, 1, 1, 1}, {4, 2}},
    {{9, 16, 1, 1.5}, {9, 3, 4, 1, 1.5, 0.5}, {0, 13}}, {{35, 5, 1e-6, 1e-6}, {3, 5, 2, 1e-6, 1e-6, 2e-6}, {32, 0}},
    {{2, 17, 1, 1}, {1, 1, 40, 1, 1, 1}, {1, 16}},
};

TEST(EigenstrainDisplacement, is_the_direct_sum) {
  for (const Case& one : kCases) {
    for (const double nu : {0.3, 0.0}) {
      const TensorField strain = random_strain(one.box);
      const std::vector<double> expected = direct_sum(one.grid, one.box, one.first, strain, nu);
      for (const simd::Isa isa : simd::supported()) {
        const std::vector<double> found = displacement_of(Engine(1, isa), one.grid, one.box, one.first, strain, nu);
        for (std::size_t n = 0; n < found.size(); ++n) {
          // Rounding of a few hundred terms; single ones are as large as a cuboid's side.
          EXPECT_NEAR(found[n], expected[n], 1e-14 * largest(expected) + 1e-15 * one.box.dx) << simd::name(isa);
        }
      }
    }
  }
}

TEST(EigenstrainDisplacement, is_reciprocal_to_the_stress_below_a_pressure) {
  // The mean of u over a loaded cell is the work of the strain in that load's stress. Both at centres only: cells of
  // a quarter of the depth and finer leave the second difference of the stress.
  const double nu = 0.3;
  const Grid grid{25, 25, 0.25, 0.25};
  const Box box{3, 2, 2, 0.25, 0.25, 0.25};
  const std::int64_t deep = 7;  // layers without strain above
  Box whole = box;
  whole.nz += deep;
  TensorField strain(whole, 0);
  const TensorField given = random_strain(box);
  const std::size_t above = static_cast<std::size_t>(deep * box.nx * box.ny);
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t n = 0; n < box.cuboids(); ++n) strain.at(c, above + n) = given.at(c, n);
  }
  const Place first{11, 10};
  const std::vector<double> u = displacement_of(Engine(), grid, whole, first, strain, nu);
  double worst = 0, most = 0;
  for (std::int64_t j = 0; j < grid.ny; j += 3) {
    for (std::int64_t i = 0; i < grid.nx; i += 3) {
      double work = 0;
      for (std::int64_t k = 0; k < box.nz; ++k) {
        const influence::Stress stress(0.25, 0.25, (static_cast<double>(deep + k) + 0.5) * 0.25, nu);
        for (std::int64_t y = 0; y < box.ny; ++y) {
          for (std::int64_t x = 0; x < box.nx; ++x) {
            const auto one = stress(influence::Traction::pressure, first.x + x - i, first.y + y - j);
            for (std::size_t c = 0; c < 6; ++c) {
              work += (c < 3 ? 1 : 2) * one[c] * 0.25 *
                      given.at(c, static_cast<std::size_t>((k * box.ny + y) * box.nx + x));
            }
          }
        }
      }
      worst = std::max(worst, std::abs(work - u[static_cast<std::size_t>(j * grid.nx + i)]));
      most = std::max(most, std::abs(work));
    }
  }
  // Second differences: cells are 1/8 of the depth, (1/8)²/24 times a curvature of order 10, in both.
  EXPECT_LE(worst, 0.02 * most);
}

TEST(EigenstrainDisplacement, of_squeezed_material_is_positive_and_symmetric) {
  // Material pressed flatter along z flows sideways (xx = yy = 1/2, zz = −1): the surface above sinks,
  // which is positive.
  const Grid grid{15, 15, 1, 1};
  const Box box{3, 3, 2, 1, 1, 1};
  TensorField strain(box, 0);
  for (std::size_t n = 0; n < box.cuboids(); ++n) {
    strain.at(kXx, n) = strain.at(kYy, n) = 0.5;
    strain.at(kZz, n) = -1;
  }
  const std::vector<double> u = displacement_of(Engine(), grid, box, {6, 6}, strain);
  EXPECT_GT(u[7 * 15 + 7], 0.5);
  for (std::int64_t j = 0; j < 15; ++j) {
    for (std::int64_t i = 0; i < 15; ++i) {
      EXPECT_NEAR(u[static_cast<std::size_t>(j * 15 + i)], u[static_cast<std::size_t>((14 - j) * 15 + i)], 1e-14);
      EXPECT_NEAR(u[static_cast<std::size_t>(j * 15 + i)], u[static_cast<std::size_t>(i * 15 + j)], 1e-14);
    }
  }
}

TEST(EigenstrainDisplacement, serves_boxes_of_every_size_and_place) {
  const Engine engine;
  const Grid grid{20, 18, 1, 1};
  EigenstrainDisplacement response(engine.backend, grid, 6, 1, 0.3);
  for (const auto& [box, first] :
       {std::pair{Box{1, 1, 1, 1, 1, 1}, Place{19, 17}}, std::pair{Box{20, 18, 6, 1, 1, 1}, Place{0, 0}},
        std::pair{Box{4, 5, 3, 1, 1, 1}, Place{7, 2}}}) {
    const TensorField strain = random_strain(box);
    std::vector<double> found(grid.nodes());
    response.displacement(strain.pointers(), box, first.x, first.y, found.data());
    const std::vector<double> expected = direct_sum(grid, box, first, strain, 0.3);
    for (std::size_t n = 0; n < found.size(); ++n) EXPECT_NEAR(found[n], expected[n], 2e-14 * largest(expected));
  }
  std::vector<double> nothing(grid.nodes(), 1);
  const Box box{4, 5, 3, 1, 1, 1};
  const TensorField none(box, 0);
  response.displacement(none.pointers(), box, 1, 1, nothing.data());
  for (const double value : nothing) EXPECT_EQ(value, 0.0);
}

TEST(EigenstrainDisplacement, deepened_gives_the_bits_of_a_new_one) {
  const Engine engine(2);
  const Grid grid{14, 9, 1, 1};
  EigenstrainDisplacement response(engine.backend, grid, 1, 0.5, 0.3);
  for (const std::int64_t layers : {3, 2, 7}) {
    response.deepen(layers);
    EXPECT_EQ(response.layers(), std::max<std::int64_t>(layers, 3));
    const Box box{6, 5, layers, 1, 1, 0.5};
    const TensorField strain = random_strain(box);
    std::vector<double> result(grid.nodes());
    response.displacement(strain.pointers(), box, 4, 2, result.data());
    EXPECT_EQ(result, displacement_of(engine, grid, box, {4, 2}, strain));
  }
  EXPECT_THROW(response.deepen(0), Error);
}

TEST(EigenstrainDisplacement, does_not_depend_on_the_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const Grid grid{70, 50, 1, 1};
  const Box box{33, 21, 9, 1, 1, 0.5};
  const TensorField strain = random_strain(box);
  for (const simd::Isa isa : simd::supported()) {
    const auto one = displacement_of(Engine(1, isa), grid, box, {20, 10}, strain);
    for (const int threads : {2, 3, 8}) {
      const auto many = displacement_of(Engine(threads, isa), grid, box, {20, 10}, strain);
      EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)), 0)
          << simd::name(isa) << ", " << threads << " threads";
    }
  }
}

TEST(EigenstrainDisplacement, refuses_a_box_that_is_not_below_the_grid) {
  const Engine engine;
  EigenstrainDisplacement response(engine.backend, {8, 8, 1, 1}, 3, 1, 0.3);
  std::vector<double> result(64);
  const auto attempt = [&](const Box& box, Place first) {
    const TensorField strain(box, 0);
    response.displacement(strain.pointers(), box, first.x, first.y, result.data());
  };
  EXPECT_NO_THROW(attempt({4, 4, 3, 1, 1, 1}, {4, 4}));
  EXPECT_THROW(attempt({4, 4, 3, 1, 1, 1}, {5, 4}), Error);
  EXPECT_THROW(attempt({4, 4, 3, 1, 1, 1}, {0, -1}), Error);
  EXPECT_THROW(attempt({9, 4, 3, 1, 1, 1}, {0, 0}), Error);
  EXPECT_THROW(attempt({4, 4, 4, 1, 1, 1}, {0, 0}), Error);
  EXPECT_THROW(attempt({4, 4, 3, 1, 1, 0.5}, {0, 0}), Error);
  EXPECT_THROW(attempt({4, 4, 3, 2, 1, 1}, {0, 0}), Error);
  EXPECT_THROW(EigenstrainDisplacement(engine.backend, {8, 8, 1, 1}, 0, 1, 0.3), Error);
}

}  // namespace
}  // namespace brinell::plastic
