// What linear elasticity and the symmetry of half-spaces demand of any contact, with E* = 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "influence/displacement.h"
#include "support/workbench.h"

namespace brinell::physics {
namespace {

using contact::Drive;
using support::largest_difference;
using support::press;
using support::Pressed;
using support::Request;
using support::Workbench;

constexpr double kTight = 1e-12;
// Certificates of 1e-12 leave pressures that differ by some hundred times as much of their largest.
constexpr double kAgreement = 1e-9;

constexpr Boundary kBoundaries[] = {Boundary::free, Boundary::periodic};

double least(const std::vector<double>& gap) {
  return *std::ranges::min_element(gap);
}

/// ½ Σ p u.
double energy_of(const Pressed& pressed, const std::vector<double>& gap) {
  double sum = 0;
  for (std::size_t n = 0; n < gap.size(); ++n) {
    sum += 0.5 * pressed.pressure[n] * (pressed.deformed_gap[n] - gap[n]);
  }
  return sum;
}

// Gap, approach and pressure in proportion: the same contact.
TEST(Elasticity, scales_pressure_with_the_gap) {
  const Workbench bench;
  const Grid grid{80, 66, 1, 1.3};
  const std::vector<double> gap = support::gap_of(support::self_affine(grid, 1), grid);
  for (const Boundary boundary : kBoundaries) {
    const Pressed reference = press(bench, grid, boundary, gap, {Drive::force, 40, kTight});
    for (const double factor : {1e-3, 3.7, 1e4}) {
      std::vector<double> scaled = gap, expected = reference.pressure;
      for (double& h : scaled) h *= factor;
      for (double& p : expected) p *= factor;
      const Pressed pressed = press(bench, grid, boundary, scaled, {Drive::force, 40 * factor, kTight});
      EXPECT_LE(largest_difference(pressed.pressure, expected), kAgreement * factor * reference.largest());
      EXPECT_NEAR(pressed.solution.approach / factor, reference.solution.approach, kAgreement);
    }
  }
}

// Σ p₁ u₂ = Σ p₂ u₁, by displacements of the solver's own.
TEST(Elasticity, is_reciprocal) {
  const Workbench bench;
  const Grid grid{75, 68, 1, 1};
  const std::vector<double> rough = support::gap_of(support::self_affine(grid, 2), grid);
  const std::vector<double> sphere = support::gap_of(surface::Sphere{300}, grid, {7, -3});
  for (const Boundary boundary : kBoundaries) {
    const Pressed first = press(bench, grid, boundary, rough, {Drive::force, 60, 1e-9});
    const Pressed second = press(bench, grid, boundary, sphere, {Drive::force, 25, 1e-9});
    double first_second = 0, second_first = 0;
    for (std::size_t n = 0; n < rough.size(); ++n) {
      first_second += first.pressure[n] * (second.deformed_gap[n] - sphere[n]);
      second_first += second.pressure[n] * (first.deformed_gap[n] - rough[n]);
    }
    // Round-off of gap − (gap + u), with gaps of some displacements.
    EXPECT_NEAR(first_second / second_first, 1, 1e-13);
  }
}

// Between two changes of the nodes in contact, energy is a quadratic of the approach: the central difference of it is
// its derivative, the force.
TEST(Elasticity, energy_has_the_force_as_its_derivative) {
  const Workbench bench;
  const Grid grid{48, 60, 1, 1};
  const std::vector<double> gap = support::gap_of(support::self_affine(grid, 3), grid);
  for (const Boundary boundary : kBoundaries) {
    const double approach = 0.5 * least(gap), step = 1e-6;
    const auto at = [&](double delta) { return press(bench, grid, boundary, gap, {Drive::approach, delta, 1e-13}); };
    const Pressed below = at(approach - step), middle = at(approach), above = at(approach + step);
    ASSERT_EQ(below.nodes_in_contact(), above.nodes_in_contact());
    const double derivative = (energy_of(above, gap) - energy_of(below, gap)) / (2 * step);
    // Errors of energy, second order in those of the pressure, are round-off: 1e-15 · energy / step = 1e-9 W.
    EXPECT_NEAR(derivative / middle.solution.total, 1, 1e-8);
  }
}

// The work of the force becomes elastic energy: ∫ W dδ = ½ Σ p u. Midpoint sums in √(δ − first touch), since W begins
// with one node, then grows in kinks as nodes enter: second order.
TEST(Elasticity, stores_the_work_of_the_force) {
  const Workbench bench;
  const Grid grid{40, 36, 1, 1};
  const std::vector<double> gap = support::gap_of(surface::Sphere{200}, grid, {0.3, 0.2});
  const double touch = least(gap), approach = touch + 1;
  const Pressed end = press(bench, grid, Boundary::free, gap, {Drive::approach, approach, 1e-10});
  constexpr int kParts = 100;
  double work = 0;
  for (int part = 0; part < kParts; ++part) {
    const double t = (part + 0.5) / kParts;
    const Pressed pressed = press(bench, grid, Boundary::free, gap, {Drive::approach, touch + t * t, 1e-10});
    work += pressed.solution.total * 2 * t / kParts;
  }
  EXPECT_NEAR(work / energy_of(end, gap), 1, 1e-3);  // 10/kParts², as W ~ t³
}

TEST(Elasticity, two_distant_contacts_interact_as_point_forces) {
  const Workbench bench;
  const Grid grid{121, 21, 1, 1};
  std::vector<double> gap(grid.nodes(), 10.0);
  const std::size_t left = 10 * 121 + 10, right = 10 * 121 + 110;
  gap[left] = gap[right] = 0;
  const Pressed pressed = press(bench, grid, Boundary::free, gap, {Drive::force, 2, kTight});
  const influence::Displacement displacement(1, 1);
  EXPECT_NEAR(pressed.pressure[left], 1, 1e-11);
  EXPECT_NEAR(pressed.solution.approach, displacement(0, 0) + displacement(100, 0), 1e-11);
}

TEST(Symmetry, of_a_centred_sphere_is_kept) {
  const Workbench bench;
  for (const std::int64_t n : {60, 61, 128}) {
    const Grid grid{n, n, 1, 1};
    const std::vector<double> gap = support::gap_of(surface::Sphere{500}, grid);
    for (const Boundary boundary : kBoundaries) {
      const Pressed pressed = press(bench, grid, boundary, gap, {Drive::force, 100, 1e-13});
      const double round_off = 1e-11 * pressed.largest();
      const auto at = [&](std::int64_t i, std::int64_t j) {
        return pressed.pressure[static_cast<std::size_t>(j * n + i)];
      };
      for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = 0; i < n; ++i) {
          ASSERT_NEAR(at(i, j), at(n - 1 - i, j), round_off);
          ASSERT_NEAR(at(i, j), at(i, n - 1 - j), round_off);
          ASSERT_NEAR(at(i, j), at(j, i), round_off);
        }
      }
    }
  }
}

TEST(Symmetry, exchange_of_x_and_y_transposes_the_result) {
  const Workbench bench;
  const Grid grid{90, 67, 0.5, 0.8}, turned{67, 90, 0.8, 0.5};
  const std::vector<double> gap = support::gap_of(support::self_affine(grid, 5), grid);
  std::vector<double> turned_gap(gap.size());
  const auto transposed = [&](std::size_t n) { return n % 90 * 67 + n / 90; };
  for (std::size_t n = 0; n < gap.size(); ++n) turned_gap[transposed(n)] = gap[n];
  for (const Boundary boundary : kBoundaries) {
    for (const bool mixed : {false, true}) {
      const Request request{Drive::force, 50, kTight};
      const Pressed straight = press(bench, grid, boundary, gap, request, mixed);
      const Pressed across = press(bench, turned, boundary, turned_gap, request, mixed);
      std::vector<double> expected(gap.size());
      for (std::size_t n = 0; n < gap.size(); ++n) expected[transposed(n)] = straight.pressure[n];
      EXPECT_LE(largest_difference(across.pressure, expected), kAgreement * straight.largest());
      EXPECT_NEAR(across.solution.approach, straight.solution.approach, kAgreement * grid.dx);
    }
  }
}

// On a periodic grid no place is special.
TEST(Symmetry, a_shifted_periodic_gap_shifts_the_pressure) {
  const Workbench bench;
  const Grid grid{96, 72, 1, 1};
  const std::vector<double> gap = support::gap_of(support::self_affine(grid, 6), grid);
  std::vector<double> shifted(gap.size());
  const auto moved = [&](std::size_t n) { return (n / 96 + 29) % 72 * 96 + (n + 31) % 96; };
  for (std::size_t n = 0; n < gap.size(); ++n) shifted[moved(n)] = gap[n];
  const Request request{Drive::force, 60, kTight};
  const Pressed here = press(bench, grid, Boundary::periodic, gap, request);
  const Pressed there = press(bench, grid, Boundary::periodic, shifted, request);
  std::vector<double> expected(gap.size());
  for (std::size_t n = 0; n < gap.size(); ++n) expected[moved(n)] = here.pressure[n];
  EXPECT_LE(largest_difference(there.pressure, expected), kAgreement * here.largest());
}

}  // namespace
}  // namespace brinell::physics
