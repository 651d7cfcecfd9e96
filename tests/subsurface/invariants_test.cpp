#include "subsurface/invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "simd/kernel_table.h"

namespace brinell::subsurface {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A rotation rounds each component a few times, and fifteen of them follow each other.
constexpr double kRoundings = 60 * kEpsilon;

double largest(const Tensor& stress) {
  double most = 0;
  for (const double component : stress) most = std::max(most, std::abs(component));
  return most;
}

/// σ v = λ v, directions orthonormal, values falling.
void expect_principal(const Tensor& s, const Principal& found) {
  const double tolerance = kRoundings * largest(s);
  const double matrix[3][3] = {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
  EXPECT_GE(found.value[0], found.value[1]);
  EXPECT_GE(found.value[1], found.value[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t row = 0; row < 3; ++row) {
      double image = 0;
      for (std::size_t column = 0; column < 3; ++column) image += matrix[row][column] * found.direction[k][column];
      EXPECT_NEAR(image, found.value[k] * found.direction[k][row], tolerance);
    }
    for (std::size_t l = 0; l < 3; ++l) {
      double product = 0;
      for (std::size_t row = 0; row < 3; ++row) product += found.direction[k][row] * found.direction[l][row];
      EXPECT_NEAR(product, k == l ? 1.0 : 0.0, kRoundings);
    }
  }
}

std::vector<Tensor> tensors() {
  std::vector<Tensor> all{{0, 0, 0, 0, 0, 0},
                          {1, 1, 1, 0, 0, 0},
                          {-2, -2, -2, 0, 0, 0},
                          {1, 0, 0, 0, 0, 0},
                          {0, 1, 1, 0, 0, 0},
                          {1, 2, 3, 0, 0, 0},
                          {0, 0, 0, 1, 0, 0},
                          {0, 0, 0, 0, 1, 0},
                          {0, 0, 0, 0, 0, -1},
                          {0, 0, 0, 1, 1, 1},
                          {2, 2, 2, 1, 1, 1},
                          {1, 1, 1, 1e-9, 0, 0},
                          {1, 1, 1 + 1e-13, 0, 0, 1e-12},
                          {1e-30, 0, 0, 0, 1e-30, 0},
                          {1, -1, 0, 1e-200, 0, 0},
                          {1e120, -1e120, 0, 3e119, 0, 1e100}};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2000; ++k) {
    Tensor one{};
    for (double& component : one) component = normal(random) * std::pow(10.0, 3 * normal(random));
    all.push_back(one);
  }
  for (int k = 0; k < 500; ++k) {  // two values equal or almost so: λ 1 + μ n n
    double n[3];
    for (double& part : n) part = normal(random);
    const double shift = normal(random);
    all.push_back({shift + n[0] * n[0], shift + n[1] * n[1], shift + n[2] * n[2], n[1] * n[2], n[0] * n[2],
                   n[0] * n[1] + (k % 2 == 0 ? 0 : 1e-12)});
  }
  return all;
}

TEST(Principal, values_and_directions_hold_for_any_tensor) {
  for (const Tensor& stress : tensors()) expect_principal(stress, principal(stress));
}

TEST(Principal, values_are_the_known_ones) {
  const Principal found = principal({2, 2, 2, 1, 1, 1});  // 4, 1, 1
  EXPECT_NEAR(found.value[0], 4, 4 * kRoundings);
  EXPECT_NEAR(found.value[1], 1, 4 * kRoundings);
  EXPECT_NEAR(found.value[2], 1, 4 * kRoundings);
  EXPECT_NEAR(std::abs(found.direction[0][0]), 1 / std::numbers::sqrt3, kRoundings);
}

TEST(Invariants, of_known_states) {
  const double scale = 3e8;
  EXPECT_NEAR(von_mises({scale, 0, 0, 0, 0, 0}), scale, 4 * kEpsilon * scale);
  EXPECT_NEAR(von_mises({0, 0, 0, 0, scale, 0}), std::numbers::sqrt3 * scale, 8 * kEpsilon * scale);
  EXPECT_NEAR(tresca({0, 0, 0, 0, scale, 0}), 2 * scale, 2 * kRoundings * scale);
  EXPECT_NEAR(hydrostatic({3, -1, 4, 9, 9, 9}), 2, 4 * kEpsilon);
  EXPECT_EQ(von_mises({5, 5, 5, 0, 0, 0}), 0);
  EXPECT_EQ(tresca({5, 5, 5, 0, 0, 0}), 0);
}

TEST(Invariants, agree_with_principal_values) {
  for (const Tensor& stress : tensors()) {
    const auto [a, b, c] = principal(stress).value;
    const double tolerance = kRoundings * largest(stress);
    EXPECT_NEAR(tresca(stress), a - c, tolerance);
    EXPECT_NEAR(hydrostatic(stress), (a + b + c) / 3, tolerance);
    // von Mises is a norm: its error is that of the values, but not where their difference cancels.
    const double expected = std::sqrt(0.5) * std::hypot(a - b, b - c, c - a);
    EXPECT_NEAR(von_mises(stress), expected, 4 * tolerance);
  }
}

TEST(Invariants, of_arrays_are_those_of_single_tensors_at_every_instruction_set) {
  const std::vector<Tensor> all = tensors();
  for (const simd::Isa isa : simd::supported()) {
    for (std::size_t n = 0; n <= 33; ++n) {
      constexpr double canary = -77.5;
      std::vector<double> components(6 * n + 7, canary), results(15 * (n + 2), canary);
      simd::StressArrays stress;
      InvariantArrays targets;
      for (std::size_t c = 0; c < 6; ++c) {
        stress.component[c] = components.data() + 1 + c * n;  // not aligned
        for (std::size_t k = 0; k < n; ++k) components[1 + c * n + k] = all[(50 * n + k) % all.size()][c];
      }
      for (std::size_t k = 0; k < 15; ++k) {
        double* place = results.data() + k * (n + 2) + 1;
        (k < 6 ? targets.invariant[k] : targets.direction[k - 6]) = place;
      }
      fill_invariants(simd::kernels(isa), n, stress, targets);
      for (std::size_t k = 0; k < 15; ++k) {
        EXPECT_EQ(results[k * (n + 2)], canary);
        EXPECT_EQ(results[k * (n + 2) + n + 1], canary);
      }
      for (std::size_t k = 0; k < n; ++k) {
        const Tensor& one = all[(50 * n + k) % all.size()];
        const double tolerance = kRoundings * largest(one);
        EXPECT_NEAR(targets.invariant[0][k], von_mises(one), tolerance);
        EXPECT_NEAR(targets.invariant[1][k], tresca(one), tolerance);
        EXPECT_NEAR(targets.invariant[2][k], hydrostatic(one), tolerance);
        Principal found{};
        for (std::size_t l = 0; l < 3; ++l) {
          found.value[l] = targets.invariant[3 + l][k];
          for (std::size_t axis = 0; axis < 3; ++axis) found.direction[l][axis] = targets.direction[3 * l + axis][k];
        }
        expect_principal(one, found);
      }
    }
  }
}

TEST(Invariants, largest_leaves_out_what_is_not_a_number) {
  for (const simd::Isa isa : simd::supported()) {
    const auto largest_of = simd::kernels(isa).subsurface.largest;
    std::vector<double> values(37, -3.0);
    values[0] = values[36] = std::nan("");
    values[20] = 8.0;
    for (std::size_t n = 1; n <= 37; ++n) {
      const double expected = n == 1 ? -std::numeric_limits<double>::infinity() : n <= 20 ? -3.0 : 8.0;
      EXPECT_EQ(largest_of(n, values.data()), expected) << n;
    }
  }
}

}  // namespace
}  // namespace brinell::subsurface
