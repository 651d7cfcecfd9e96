// Rigid punches on a half-space (I. N. Sneddon, 1965), with E* = 1.
//
//   flat-ended cylinder of radius a:   W = 2 a δ
//   cone, half-angle α between axis and flank:   W = (2/π) δ² tan α,   contact radius a = (2/π) δ tan α
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "support/convergence.h"
#include "support/workbench.h"

namespace brinell::physics {
namespace {

using contact::Drive;
using support::Convergence;
using support::press;
using support::Pressed;
using support::Workbench;

constexpr double kPi = std::numbers::pi;

// The pressure is infinite at the edge, as 1/√distance; cells that begin half a cell further out or in make an error
// of h/a: first order, observed 1.0 to 1.2. The cells in contact make the punch: its radius is that of their area.
TEST(Sneddon, flat_punch_converges_with_first_order) {
  const Workbench bench;
  const double radius = 0.3001, approach = 0.01;
  Convergence force;
  for (const std::int64_t n : {32, 64, 128, 256}) {
    const double spacing = 1.0 / static_cast<double>(n);
    const Grid grid{n, n, spacing, spacing};
    // The edge's arc is so narrow that the next cell is far from contact.
    const std::vector<double> gap = support::gap_of(surface::FlatPunch{radius, 1e-9}, grid);
    const Pressed pressed = press(bench, grid, Boundary::free, gap, {Drive::approach, approach, 1e-9});
    EXPECT_TRUE(pressed.solution.converged);
    for (std::size_t n_at = 0; n_at < gap.size(); ++n_at) {
      EXPECT_EQ(pressed.pressure[n_at] > 0, gap[n_at] == 0);  // all of the flat, nothing else
    }
    const double area = static_cast<double>(pressed.nodes_in_contact()) * grid.cell_area();
    force.add(spacing, pressed.solution.total * grid.cell_area(), 2 * std::sqrt(area / kPi) * approach);
    EXPECT_NEAR(pressed.solution.total * grid.cell_area() / (2 * radius * approach), 1, spacing / radius);
  }
  EXPECT_GT(force.order(), 0.9);
  EXPECT_LT(force.last(), 0.5 / (256 * radius));
}

TEST(Sneddon, flat_punch_is_linear_in_the_approach) {
  const Workbench bench;
  const Grid grid{90, 80, 1, 1};
  const std::vector<double> gap = support::gap_of(surface::FlatPunch{20, 1e-6}, grid);
  const Pressed once = press(bench, grid, Boundary::free, gap, {Drive::approach, 0.1, 1e-12});
  const Pressed thrice = press(bench, grid, Boundary::free, gap, {Drive::approach, 0.3, 1e-12});
  for (std::size_t n = 0; n < gap.size(); ++n) {
    // The certificate, times the condition of K of some hundred.
    EXPECT_NEAR(thrice.pressure[n], 3 * once.pressure[n], 1e-10 * thrice.largest());
  }
}

// The pressure is infinite at the apex, logarithmically, and meets the edge with a finite slope; observed order of
// force and approach: 2.2 and 2.2.
TEST(Sneddon, cone_converges_with_second_order) {
  const Workbench bench;
  const double half_angle = 80 * kPi / 180, radius = 0.35;
  const double approach = kPi / 2 * radius / std::tan(half_angle);
  const double force = 2 / kPi * approach * approach * std::tan(half_angle);
  Convergence approaches, forces;
  for (const std::int64_t n : {33, 65, 129, 257}) {
    const double spacing = 1.0 / static_cast<double>(n);
    const Grid grid{n, n, spacing, spacing};
    const std::vector<double> gap = support::gap_of(surface::Cone{half_angle, 0}, grid);
    const Pressed by_approach = press(bench, grid, Boundary::free, gap, {Drive::approach, approach, 1e-10});
    const Pressed by_force = press(bench, grid, Boundary::free, gap, {Drive::force, force / grid.cell_area(), 1e-10});
    forces.add(spacing, by_approach.solution.total * grid.cell_area(), force);
    approaches.add(spacing, by_force.solution.approach, approach);
    const double area = static_cast<double>(by_force.nodes_in_contact()) * grid.cell_area();
    EXPECT_NEAR(std::sqrt(area / kPi), radius, 0.5 * spacing);
  }
  EXPECT_GT(forces.order(), 1.8);
  EXPECT_GT(approaches.order(), 1.8);
  EXPECT_LT(forces.last(), 1.2e-4);  // (h/a)²
  EXPECT_LT(approaches.last(), 1.2e-4);
}

// Half-angle between axis and flank: a blunt cone is a large angle. Self-similar: W = (2/π) δ² tan α.
TEST(Sneddon, cone_stiffens_with_the_square_of_the_approach_and_the_tangent_of_the_angle) {
  const Workbench bench;
  const Grid grid{129, 129, 1, 1};
  for (const double degrees : {60.0, 75.0, 85.0}) {
    const double half_angle = degrees * kPi / 180;
    const std::vector<double> gap = support::gap_of(surface::Cone{half_angle, 0}, grid);
    for (const double radius : {25.0, 50.0}) {
      const double approach = kPi / 2 * radius / std::tan(half_angle);
      const Pressed pressed = press(bench, grid, Boundary::free, gap, {Drive::approach, approach, 1e-9});
      EXPECT_NEAR(pressed.solution.total / (2 / kPi * approach * approach * std::tan(half_angle)), 1,
                  1 / (radius * radius));
    }
  }
}

}  // namespace
}  // namespace brinell::physics
