// Bodies that may tilt: a force with its place, prescribed slopes, and where there is no equilibrium.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "contact/rest.h"
#include "support/direct_contact.h"
#include "support/workbench.h"

namespace brinell::contact {
namespace {

using support::gap_of;
using support::press;
using support::Pressed;
using support::Request;
using support::self_affine;
using support::state_of;
using support::Workbench;

Load force_at(double total, double x, double y) {
  Load load{Drive::force, total};
  load.moments = true;
  load.force_x = x;
  load.force_y = y;
  return load;
}

Load approach_at(double approach, double x, double y) {
  Load load = force_at(approach, x, y);
  load.drive = Drive::approach;
  return load;
}

Load with_slopes(Drive drive, double target, double slope_x, double slope_y) {
  Load load{drive, target};
  load.slope_x = slope_x;
  load.slope_y = slope_y;
  return load;
}

std::vector<double> with_plane(std::vector<double> gap, const Grid& grid, double slope_x, double slope_y) {
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      gap[static_cast<std::size_t>(j * grid.nx + i)] += slope_x * grid.x(i) + slope_y * grid.y(j);
    }
  }
  return gap;
}

struct Centre {
  double x = 0, y = 0;
};

Centre centre_of(const Grid& grid, const std::vector<double>& p) {
  double total = 0, x = 0, y = 0;
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      const double pressure = p[static_cast<std::size_t>(j * grid.nx + i)];
      total += pressure;
      x += pressure * grid.x(i);
      y += pressure * grid.y(j);
    }
  }
  return {x / total, y / total};
}

/// Rounded flat of the given radius.
std::vector<double> punch(const Grid& grid, double radius) {
  return gap_of(surface::FlatPunch{radius, 200 * radius, surface::Profile::parabolic}, grid);
}

// A certificate of 1e-11 bounds errors of the pressure to about 30 pi times that of the largest pressure, see
// direct_test.cpp.
constexpr double kTight = 1e-11;
constexpr double kAgreement = 1e-9;

TEST(Tilt, of_prescribed_slopes_is_a_plane_in_the_gap) {
  const Workbench bench;
  for (const Grid& grid : {Grid{24, 17, 1e-6, 1.7e-6}, Grid{130, 75, 1, 1}, Grid{9, 1, 1, 1}}) {
    const std::vector<double> gap = gap_of(self_affine(grid, 2), grid);
    const double slope_x = 0.01, slope_y = -0.02;
    const std::vector<double> tilted = with_plane(gap, grid, slope_x, slope_y);
    const double total = 0.01 * static_cast<double>(grid.nodes());
    for (const bool mixed : {false, true}) {
      const Pressed plane = press(bench, grid, Boundary::free, tilted, {Drive::force, total, kTight}, mixed);
      const Pressed slopes = press(bench, grid, Boundary::free, gap,
                                   {with_slopes(Drive::force, total, slope_x, slope_y), kTight}, mixed);
      ASSERT_TRUE(plane.solution.converged && slopes.solution.converged);
      EXPECT_LE(support::largest_difference(plane.pressure, slopes.pressure), kAgreement * plane.largest());
      EXPECT_NEAR(slopes.solution.approach, plane.solution.approach, kAgreement * plane.largest() * grid.dx);
      const Pressed back =
          press(bench, grid, Boundary::free, gap,
                {with_slopes(Drive::approach, slopes.solution.approach, slope_x, slope_y), kTight}, mixed);
      EXPECT_LE(support::largest_difference(back.pressure, slopes.pressure), kAgreement * plane.largest());
    }
  }
}

TEST(Tilt, agrees_with_the_direct_solution_under_the_slopes_that_it_finds) {
  const Workbench bench;
  for (const Grid& grid : {Grid{32, 32, 1, 1}, Grid{21, 31, 1e-6, 0.6e-6}, Grid{64, 6, 1, 2}}) {
    for (const std::vector<double>& gap :
         {gap_of(self_affine(grid, 1), grid), punch(grid, 0.3 * static_cast<double>(grid.nx) * grid.dx)}) {
      const double total = 0.01 * static_cast<double>(grid.nodes());
      const double x = 0.15 * grid.x(grid.nx - 1), y = -0.1 * grid.y(grid.ny - 1);
      const Pressed pressed = press(bench, grid, Boundary::free, gap, {force_at(total, x, y), kTight});
      ASSERT_TRUE(pressed.solution.converged) << pressed.solution.certificate.worst();
      const Centre centre = centre_of(grid, pressed.pressure);
      EXPECT_NEAR(centre.x, x, kTight * grid.x(grid.nx - 1));
      EXPECT_NEAR(centre.y, y, kTight * grid.y(grid.ny - 1));
      const support::DirectContact direct = support::direct_contact(
          grid, Boundary::free, with_plane(gap, grid, pressed.solution.slope_x, pressed.solution.slope_y),
          Drive::force, total);
      ASSERT_TRUE(direct.solved);
      EXPECT_LE(support::largest_difference(pressed.pressure, direct.pressure), kAgreement * pressed.largest());
      EXPECT_NEAR(pressed.solution.approach, direct.approach,
                  kAgreement * (std::fabs(direct.approach) + pressed.largest() * grid.dx));
    }
  }
}

TEST(Tilt, is_none_under_a_centred_force_on_a_symmetric_body) {
  const Workbench bench;
  const Grid grid{80, 60, 1, 1};
  const std::vector<double> gap = punch(grid, 20);
  const Pressed parallel = press(bench, grid, Boundary::free, gap, {Drive::force, 50.0, kTight});
  const Pressed free = press(bench, grid, Boundary::free, gap, {force_at(50.0, 0, 0), kTight});
  EXPECT_NEAR(free.solution.slope_x, 0, kAgreement * free.largest());
  EXPECT_NEAR(free.solution.slope_y, 0, kAgreement * free.largest());
  EXPECT_LE(support::largest_difference(parallel.pressure, free.pressure), kAgreement * parallel.largest());
}

TEST(Tilt, of_slopes_and_of_eccentricity_give_the_same_state) {
  const Workbench bench;
  const Grid grid{150, 110, 1, 1.3};
  for (const std::vector<double>& gap : {gap_of(self_affine(grid, 4), grid), punch(grid, 40)}) {
    const Pressed free = press(bench, grid, Boundary::free, gap, {force_at(300, 9, -14), kTight});
    ASSERT_TRUE(free.solution.converged);
    for (const Load& load :
         {with_slopes(Drive::force, 300, free.solution.slope_x, free.solution.slope_y),
          with_slopes(Drive::approach, free.solution.approach, free.solution.slope_x, free.solution.slope_y),
          approach_at(free.solution.approach, 9, -14)}) {
      const Pressed same = press(bench, grid, Boundary::free, gap, {load, kTight});
      ASSERT_TRUE(same.solution.converged) << same.solution.certificate.worst();
      // The approach has to be met to 1e-11 of the depth, the pressure follows within a factor of ten.
      EXPECT_LE(support::largest_difference(free.pressure, same.pressure), kAgreement * free.largest());
      EXPECT_NEAR(same.solution.total, 300, kAgreement * 300);
    }
  }
}

TEST(Tilt, exchanged_axes_give_the_transposed_state) {
  const Workbench bench;
  const Grid grid{96, 70, 1, 1.5}, turned{70, 96, 1.5, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 5), grid);
  const auto transposed = [&](const std::vector<double>& field) {
    std::vector<double> result(field.size());
    for (std::int64_t j = 0; j < grid.ny; ++j) {
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        result[static_cast<std::size_t>(i * grid.ny + j)] = field[static_cast<std::size_t>(j * grid.nx + i)];
      }
    }
    return result;
  };
  const Pressed one = press(bench, grid, Boundary::free, gap, {force_at(90, 6, -11), kTight});
  const Pressed other = press(bench, turned, Boundary::free, transposed(gap), {force_at(90, -11, 6), kTight});
  ASSERT_TRUE(one.solution.converged && other.solution.converged);
  EXPECT_LE(support::largest_difference(transposed(one.pressure), other.pressure), kAgreement * one.largest());
  EXPECT_NEAR(one.solution.slope_x, other.solution.slope_y, kAgreement);
  EXPECT_NEAR(one.solution.slope_y, other.solution.slope_x, kAgreement);
}

TEST(Tilt, moves_a_sphere_to_where_the_force_acts) {
  // x²/2R plus a slope is the same sphere about another apex: the contact is Hertz's there, the slope −x/R.
  const Workbench bench;
  const Grid grid{128, 128, 1, 1};
  const double radius = 400;
  const std::vector<double> gap = gap_of(surface::Sphere{radius}, grid);
  const double total = 4 * std::pow(15.0, 3) / (3 * radius);  // contact radius 15
  const Pressed centred = press(bench, grid, Boundary::free, gap, {Drive::force, total, kTight});
  const Pressed moved = press(bench, grid, Boundary::free, gap, {force_at(total, 23, -17), kTight});
  ASSERT_TRUE(moved.solution.converged);
  EXPECT_NEAR(moved.solution.slope_x, -23 / radius, 1e-8);  // whole nodes: the same discrete problem
  EXPECT_NEAR(moved.solution.slope_y, 17 / radius, 1e-8);
  EXPECT_NEAR(moved.largest(), centred.largest(), 1e-8 * centred.largest());
}

// Lurie: a sharp flat punch of radius a under a force P at x0 < a/3: slope −3 P x0 / (4 E* a³). Edges of radius r are
// approached from above: the contact reaches beyond the flat by a part that falls with a/r.
TEST(Tilt, of_a_rounded_punch_approaches_lurie_s_for_the_sharp_one) {
  const Workbench bench;
  const double a = 40, force = 1, x0 = 8;
  const double sharp = -3 * force * x0 / (4 * a * a * a);
  double last = 1;
  for (const double edge : {1e5, 1e3, 1e1}) {
    const Grid grid{160, 160, 1, 1};
    const std::vector<double> gap = gap_of(surface::FlatPunch{a, edge, surface::Profile::parabolic}, grid);
    const Pressed pressed = press(bench, grid, Boundary::free, gap, {force_at(force, x0, 0), 1e-10});
    ASSERT_TRUE(pressed.solution.converged);
    const double error = std::fabs(pressed.solution.slope_x / sharp - 1);
    EXPECT_LT(error, last) << edge;
    last = error;
  }
  // Sharp to the grid: the effective radius is known to half a node, the slope to 3/2 of a node over a.
  EXPECT_LT(last, 1.5 / a);
}

TEST(Tilt, grows_in_proportion_to_the_eccentricity_of_a_closed_contact) {
  const Workbench bench;
  const Grid grid{100, 100, 1, 1};
  const std::vector<double> gap = gap_of(surface::FlatPunch{30, 1e-3, surface::Profile::parabolic}, grid);
  std::vector<double> slopes;
  for (const double x0 : {1.0, 2.0, 4.0}) {
    const Pressed pressed = press(bench, grid, Boundary::free, gap, {force_at(0.02, x0, 0), 1e-10});
    ASSERT_TRUE(pressed.solution.converged);
    slopes.push_back(pressed.solution.slope_x);
  }
  // The set of nodes in contact stays that of the flat: linear to the tolerance.
  EXPECT_NEAR(slopes[1] / slopes[0], 2, 1e-6);
  EXPECT_NEAR(slopes[2] / slopes[0], 4, 4e-6);
}

TEST(Tilt, costs_few_iterations_more_than_none) {
  const Workbench bench;
  const Grid grid{256, 256, 1, 1};
  const std::vector<double> gap = gap_of(surface::FlatPunch{91, 200 * 91, surface::Profile::parabolic}, grid);
  const double force = 4.5;  // a contact a twentieth wider than the flat
  const Pressed centred = press(bench, grid, Boundary::free, gap, {Drive::force, force, 1e-8});
  for (const double part : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    const Pressed pressed = press(bench, grid, Boundary::free, gap, {force_at(force, part * 91, 0), 1e-8});
    ASSERT_TRUE(pressed.solution.converged);
    EXPECT_LE(pressed.solution.iterations, 1.3 * centred.solution.iterations) << part;
  }
}

TEST(Tilt, is_found_for_loads_that_three_nodes_carry) {
  const Workbench bench;
  const Grid grid{128, 128, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 3), grid);
  for (const double total : {1.0, 1e-3, 1e-6, 1e-9}) {
    // Three nodes are displaced by about half of what each carries; the gaps there are below 1 and known to
    // round-off.
    const double round_off = std::numeric_limits<double>::epsilon() / (0.5 * total / 3);
    const Pressed pressed =
        press(bench, grid, Boundary::free, gap, {force_at(total, 11, -7), std::max(1e-8, round_off)});
    EXPECT_TRUE(pressed.solution.converged) << total << ": " << pressed.solution.certificate.worst();
  }
}

TEST(Tilt, is_found_for_forces_near_the_edge_of_the_grid) {
  const Workbench bench;
  const Grid grid{64, 48, 1, 1};
  const double last_x = grid.x(63), last_y = grid.y(47);
  for (const std::vector<double>& gap :
       {gap_of(surface::Plane{}, grid), punch(grid, 15), gap_of(self_affine(grid, 6), grid)}) {
    for (const auto& [x, y] : {std::pair{0.9, 0.0}, {0.99, 0.5}, {-0.999, 0.999}}) {
      const Pressed pressed = press(bench, grid, Boundary::free, gap, {force_at(1, x * last_x, y * last_y), 1e-8});
      EXPECT_TRUE(pressed.solution.converged) << x << ", " << y << ": " << pressed.solution.certificate.worst();
    }
  }
}

TEST(Tilt, has_no_equilibrium_under_a_force_beyond_the_nodes) {
  const Workbench bench;
  const Grid grid{32, 32, 1, 1};
  const std::vector<double> gap = gap_of(surface::Plane{}, grid);
  Solver solver(bench.resources, grid, Boundary::free, gap.data(), false);
  for (const Load& load : {force_at(1, 15.6, 0), force_at(1, 0, -16), approach_at(0.1, 20, 0)}) {
    try {
      support::solve(solver, {load});
      FAIL() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::no_equilibrium);
      EXPECT_NE(std::string(error.what()).find("eccentricity"), std::string::npos);
    }
  }
}

TEST(Tilt, under_an_approach_short_of_rest_is_no_contact) {
  const Workbench bench;
  const Grid grid{40, 40, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 7), grid);
  Solver solver(bench.resources, grid, Boundary::free, gap.data(), false);
  const Solution apart = support::solve(solver, {approach_at(solver.first_touch() - 1, 3, 4)});
  EXPECT_TRUE(apart.converged);
  EXPECT_EQ(apart.total, 0);
  // Slopes can bring a corner into touch before the centre is there.
  const Solution corner = support::solve(solver, {with_slopes(Drive::approach, solver.first_touch() - 1, 0.5, 0)});
  EXPECT_GT(corner.total, 0);
}

TEST(Tilt, gives_the_same_bits_for_any_number_of_threads) {
  const Grid grid{200, 140, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 8), grid);
  for (const bool mixed : {false, true}) {
    const Pressed alone = press(Workbench(1), grid, Boundary::free, gap, {force_at(200, 12, 9)}, mixed);
    for (const int threads : {2, 3, 8}) {
      const Pressed shared = press(Workbench(threads), grid, Boundary::free, gap, {force_at(200, 12, 9)}, mixed);
      EXPECT_EQ(shared.pressure, alone.pressure);
      EXPECT_EQ(shared.solution.slope_x, alone.solution.slope_x);
    }
  }
}

TEST(Tilt, restores_the_bits_of_an_uninterrupted_history) {
  const Workbench bench;
  const Grid grid{96, 80, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  Solver whole(bench.resources, grid, Boundary::free, gap.data(), false);
  for (const Load& load : {force_at(50, 3, 4), force_at(50.1, 3.1, 4), with_slopes(Drive::force, 50, 0.01, 0),
                           with_slopes(Drive::force, 50.2, 0.01, 0), force_at(50, -3, 4)}) {
    Solver resumed(bench.resources, grid, Boundary::free, gap.data(), false);
    resumed.restore(whole.state());
    const Pressed expected = state_of(whole, support::solve(whole, {load}), grid.dx);
    const Pressed pressed = state_of(resumed, support::solve(resumed, {load}), grid.dx);
    EXPECT_EQ(pressed.pressure, expected.pressure);
    EXPECT_EQ(pressed.solution.slope_y, expected.solution.slope_y);
  }
}

TEST(Rest, is_the_highest_plane_below_all_nodes) {
  const parallel::Arena arena(2);
  const Grid grid{40, 30, 1, 2};
  const PlacedGrid placed = PlacedGrid::centred(grid);
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<double> gap = support::random_gap(grid, 1, seed);
    const double x = 3.3 * seed, y = -5.1 * seed;
    const Rest rest = rest_under(arena, placed, {gap.data(), 1, 0}, x, y);
    double carried = 0, moment_x = 0, moment_y = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at_x = grid.x(rest.nodes[k] % grid.nx), at_y = grid.y(rest.nodes[k] / grid.nx);
      EXPECT_NEAR(rest.approach.at(at_x, at_y), gap[static_cast<std::size_t>(rest.nodes[k])], 1e-13);
      EXPECT_GE(rest.shares[k], 0);
      carried += rest.shares[k];
      moment_x += rest.shares[k] * at_x;
      moment_y += rest.shares[k] * at_y;
    }
    // The shares are the proof that no other plane is higher: any plane below the gap at these nodes is, at the
    // force's place, below their weighted mean, which this one has.
    EXPECT_NEAR(carried, 1, 1e-13);
    EXPECT_NEAR(moment_x, x, 1e-12);
    EXPECT_NEAR(moment_y, y, 1e-12);
    for (std::int64_t n = 0; n < static_cast<std::int64_t>(grid.nodes()); ++n) {
      EXPECT_LE(rest.approach.at(grid.x(n % grid.nx), grid.y(n / grid.nx)), gap[static_cast<std::size_t>(n)] + 1e-13);
    }
  }
}

TEST(Trend, fits_what_is_linear_exactly_and_leaves_what_is_undetermined) {
  const LinearTrend wanted{0.7, -0.2, 0.05};
  PlaneWeights weights;
  for (const auto& [x, y, w] : {std::array{3.0, 4.0, 1.0}, {-2.0, 5.0, 0.5}, {7.0, -1.0, 2.0}, {100.0, 30.0, 0.1}}) {
    weights.one += w;
    weights.x += w * x;
    weights.y += w * y;
    weights.xx += w * x * x;
    weights.xy += w * x * y;
    weights.yy += w * y * y;
  }
  const LinearTrend fitted = fit(Freedom::linear, weights, weights.times(wanted), {}, 1e-9);
  EXPECT_NEAR(fitted.constant, wanted.constant, 1e-13);
  EXPECT_NEAR(fitted.x, wanted.x, 1e-14);
  EXPECT_NEAR(fitted.y, wanted.y, 1e-14);
  // Two nodes on a line along x, at y = 2: the slope along y stays.
  const PlaneWeights line{2, 1, 4, 1, 2, 8};  // x = 0 and 1
  const LinearTrend along = fit(Freedom::linear, line, line.times({1, 2, 0}), {0, 0, 0.25}, 1e-9);
  EXPECT_NEAR(along.x, 2, 1e-13);
  EXPECT_EQ(along.y, 0.25);
  EXPECT_NEAR(along.at(0.5, 2), 2, 1e-13);
}

}  // namespace
}  // namespace brinell::contact
