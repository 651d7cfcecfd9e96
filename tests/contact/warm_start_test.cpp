// Solutions that start from an earlier one: certified anew, never taken for solved because they start close; and
// solvers that are restored, also after a cancelled solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "base/error.h"
#include "support/direct_contact.h"
#include "support/workbench.h"

namespace brinell::contact {
namespace {

using support::gap_of;
using support::largest_difference;
using support::press;
using support::Pressed;
using support::Request;
using support::self_affine;
using support::solve;
using support::state_of;
using support::Workbench;

void expect_certified(const Pressed& pressed, double tolerance) {
  EXPECT_TRUE(pressed.solution.converged);
  EXPECT_LE(pressed.solution.certificate.worst(), tolerance) << pressed.solution.iterations << " iterations";
  EXPECT_GE(pressed.solution.convolutions, 1);
  EXPECT_GE(*std::ranges::min_element(pressed.pressure), 0);
}

double least(const std::vector<double>& gap) {
  return *std::ranges::min_element(gap);
}

TEST(WarmStart, of_the_same_target_is_certified_again) {
  const Workbench bench;
  const Grid grid{96, 96, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  for (const bool mixed : {false, true}) {
    Solver solver(bench.resources, grid, Boundary::free, gap.data(), mixed);
    const Request request{Drive::force, 50, 1e-9};
    const Solution first = solve(solver, request);
    const Pressed before = state_of(solver, first, grid.dx);
    const Solution second = solve(solver, request);
    const Pressed after = state_of(solver, second, grid.dx);
    expect_certified(after, 1e-9);
    EXPECT_LE(second.iterations, 2);
    EXPECT_LE(largest_difference(before.pressure, after.pressure), 1e-7 * before.largest());
    // By sums of its own: the certificate of the second is not a copy of the first's.
    const Certificate expected = support::certificate_by_sums(grid, Boundary::free, gap, after.pressure,
                                                              second.approach, Drive::force, request.load.target);
    EXPECT_NEAR(second.certificate.penetration, expected.penetration, 1e-13);
    EXPECT_NEAR(second.certificate.complementarity, expected.complementarity, 1e-13);
  }
}

// Small grids, few nodes in contact, loads decades apart one after the other: where a solver stalls first.
TEST(WarmStart, histories_over_many_decades_of_load_converge) {
  const Workbench bench;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    const auto nodes = [&] { return static_cast<std::int64_t>(1 + std::pow(50, part(random))); };
    const Grid grid{nodes(), nodes(), 1, std::exp(part(random) - 0.5)};
    const double height = std::pow(10, -3 + 4 * part(random));
    const bool wavy = random() % 2U == 0;
    std::vector<double> gap(grid.nodes());
    for (std::int64_t j = 0; j < grid.ny; ++j) {
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        const double x = grid.x(i), y = grid.y(j);
        const double smooth = wavy ? std::sin(0.7 * x) + std::cos(0.9 * y) : 0.01 * (x * x + y * y);
        gap[static_cast<std::size_t>(j * grid.nx + i)] = height * (smooth + 0.3 * part(random));
      }
    }
    const bool periodic = random() % 3U == 0, mixed = random() % 3U == 0, beside = !periodic && random() % 3U == 0;
    const double mean = std::accumulate(gap.begin(), gap.end(), 0.0) / static_cast<double>(gap.size());
    Solver solver(bench.resources, grid, periodic ? Boundary::periodic : Boundary::free, gap.data(), mixed);
    for (int step = 0; step < 4; ++step) {
      Load load;
      load.drive = random() % 2U == 0 ? Drive::force : Drive::approach;
      if (load.drive == Drive::force) {
        load.target = height * static_cast<double>(grid.nodes()) * std::pow(10, -6 + 7 * part(random));
        load.moments = beside;
        if (beside) load.force_x = 0.5 * (part(random) - 0.5) * static_cast<double>(grid.nx - 1);
      } else if (periodic) {
        load.target = mean - (mean - least(gap)) * std::pow(10, -2 * part(random));
      } else {
        load.target = least(gap) + height * std::pow(10, -5 + 6 * part(random));
      }
      const Solution solution = solve(solver, {load, 1e-8, 2000});
      EXPECT_TRUE(solution.converged) << seed << ", step " << step << ": " << grid.nx << " x " << grid.ny << ", "
                                      << solution.certificate.worst();
    }
  }
}

TEST(WarmStart, from_a_wrong_pressure_is_not_declared_solved) {
  const Workbench bench;
  const Grid grid{96, 96, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  const double nodes = static_cast<double>(grid.nodes());
  for (const Drive drive : {Drive::force, Drive::approach}) {
    const Request request{drive, drive == Drive::force ? 50.0 : 0.5 * least(gap), 1e-9};
    const Pressed expected = press(bench, grid, Boundary::free, gap, request);
    std::vector<double> uniform(grid.nodes(), expected.solution.total / nodes), single(grid.nodes(), 0.0),
        none(single);
    single[17] = expected.solution.total;
    std::vector<double> mirrored(expected.pressure.rbegin(), expected.pressure.rend()), uneven = expected.pressure;
    for (std::size_t n = 0; n < uneven.size(); n += 2) uneven[n] *= 0.5;
    for (const auto& start : {uniform, single, none, mirrored, uneven}) {
      Solver solver(bench.resources, grid, Boundary::free, gap.data(), false);
      Solver::State state{Buffer<double>(grid.nodes()), expected.solution.total, expected.solution.approach};
      std::ranges::copy(start, state.pressure.begin());
      solver.restore(state);
      const Pressed pressed = state_of(solver, solve(solver, request), grid.dx);
      expect_certified(pressed, 1e-9);
      EXPECT_GT(pressed.solution.iterations, 1);
      EXPECT_LE(largest_difference(pressed.pressure, expected.pressure), 1e-7 * expected.largest());
    }
  }
}

TEST(WarmStart, follows_a_load_history) {
  const Workbench bench;
  const Grid grid{96, 80, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  Solver solver(bench.resources, grid, Boundary::periodic, gap.data(), false);
  for (const double force : {1.0, 30.0, 30.3, 30.3, 200.0, 5.0, 0.0, 5.0, 800.0, 1e-3}) {
    const Request request{Drive::force, force, 1e-10};
    const Pressed pressed = state_of(solver, solve(solver, request), grid.dx);
    EXPECT_TRUE(pressed.solution.converged) << force;
    const Pressed afresh = press(bench, grid, Boundary::periodic, gap, request);
    EXPECT_LE(largest_difference(pressed.pressure, afresh.pressure), 1e-8 * afresh.largest()) << force;
  }
}

TEST(WarmStart, restores_the_bits_of_an_uninterrupted_history) {
  const Workbench bench;
  const Grid grid{96, 80, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    Solver whole(bench.resources, grid, boundary, gap.data(), false);
    const double touch = whole.first_touch();
    for (const Request& request :
         {Request{Drive::force, 50.0}, Request{Drive::force, 51.0}, Request{Drive::approach, 0.5 * touch},
          Request{Drive::approach, 0.495 * touch}, Request{Drive::force, 20.0}, Request{Drive::force, 20.4}}) {
      Solver resumed(bench.resources, grid, boundary, gap.data(), false);
      resumed.restore(whole.state());
      const Pressed expected = state_of(whole, solve(whole, request), grid.dx);
      const Pressed pressed = state_of(resumed, solve(resumed, request), grid.dx);
      EXPECT_EQ(pressed.pressure, expected.pressure) << request.load.target;
      EXPECT_EQ(pressed.solution.approach, expected.solution.approach);
    }
  }
}

TEST(Contact, cancelled_by_its_observer_can_be_restored_and_continued) {
  const Workbench bench;
  const Grid grid{128, 128, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  const Request earlier{Drive::force, 50}, request{Drive::force, 200};
  Solver solver(bench.resources, grid, Boundary::free, gap.data(), false);
  solve(solver, earlier);
  const Solver::State saved = solver.state();
  const Pressed expected = state_of(solver, solve(solver, request), grid.dx);
  for (const int stop : {1, 2, 5, 12}) {
    solver.restore(saved);
    int count = 0;
    try {
      solver.solve(request.load, request.tolerance, 500, [&](const Report&) { return ++count < stop; });
      FAIL() << "not stopped";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::cancelled);
    }
    EXPECT_EQ(count, stop);
    solver.restore(saved);
    EXPECT_EQ(state_of(solver, solve(solver, request), grid.dx).pressure, expected.pressure);
  }
}

}  // namespace
}  // namespace brinell::contact
