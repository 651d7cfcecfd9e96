// Contacts at the edge of what the solver meets. Every one must end with the certificate that was asked for, and
// with the right kind of contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "contact/certificate.h"
#include "influence/displacement.h"
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
using support::Workbench;

constexpr double kTight = 1e-11;

void expect_certified(const Pressed& pressed, double tolerance) {
  EXPECT_TRUE(pressed.solution.converged);
  EXPECT_LE(pressed.solution.certificate.worst(), tolerance) << pressed.solution.iterations << " iterations";
  EXPECT_GE(pressed.solution.convolutions, 1);
  EXPECT_GE(*std::ranges::min_element(pressed.pressure), 0);
}

double least(const std::vector<double>& gap) {
  return *std::ranges::min_element(gap);
}

double mean(const std::vector<double>& gap) {
  double sum = 0;
  for (const double h : gap) sum += h;
  return sum / static_cast<double>(gap.size());
}

TEST(Certificate, of_what_is_no_number_proves_nothing) {
  const Grid grid{4, 4, 1, 1};
  const Evidence sound{{2, 0, 0}, 3, 0, 0, 0};
  EXPECT_EQ(certificate_of(sound, {Drive::force, 2}, grid).worst(), 0);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (double Evidence::*const member :
         {&Evidence::displacement, &Evidence::depth, &Evidence::complementarity, &Evidence::tension_displacement}) {
      Evidence evidence = sound;
      evidence.*member = bad;
      EXPECT_EQ(certificate_of(evidence, {Drive::force, 2}, grid).worst(), HUGE_VAL);
    }
    for (double PlaneSums::*const sum : {&PlaneSums::one, &PlaneSums::x, &PlaneSums::y}) {
      Evidence evidence = sound;
      evidence.pressure.*sum = bad;
      EXPECT_EQ(certificate_of(evidence, {Drive::force, 2}, grid).worst(), HUGE_VAL);
    }
    EXPECT_EQ(certificate_of(sound, {Drive::force, bad}, grid).worst(), HUGE_VAL);
  }
  // 0/0, as of a product that underflows.
  EXPECT_EQ(certificate_of({{0, 0, 0}, 3, 0, 0, 0}, {Drive::approach, 1}, grid).worst(), HUGE_VAL);
}

TEST(Contact, beyond_the_range_of_numbers_is_not_certified) {
  const Workbench bench;
  const Grid grid{32, 24, 1, 1};
  for (const bool mixed : {false, true}) {
    const Pressed pressed =
        press(bench, grid, Boundary::free, support::random_gap(grid, 0.01, 1), {Drive::force, 1e307, kTight}, mixed);
    EXPECT_FALSE(pressed.solution.converged);
    EXPECT_EQ(pressed.solution.certificate.worst(), HUGE_VAL);
  }
}

TEST(Contact, of_one_node_has_its_own_compliance) {
  const Workbench bench;
  for (const Grid grid : {Grid{1, 1, 2, 2}, Grid{1, 9, 1, 0.5}, Grid{40, 30, 1e-6, 2e-6}, Grid{130, 67, 1, 1}}) {
    const double compliance = influence::Displacement(grid.dx, grid.dy)(0, 0);
    for (const bool mixed : {false, true}) {
      std::vector<double> gap(grid.nodes(), 100 * grid.dx);
      gap[grid.nodes() / 3] = 0.25 * grid.dx;
      const Pressed by_force = press(bench, grid, Boundary::free, gap, {Drive::force, 0.01, kTight}, mixed);
      expect_certified(by_force, kTight);
      EXPECT_EQ(by_force.nodes_in_contact(), 1);
      // A product and a sum, and the round-off of the transforms of the convolution: a few ε of the compliance.
      EXPECT_NEAR(by_force.solution.approach, 0.25 * grid.dx + 0.01 * compliance, 1e-14 * grid.dx);
      const double approach = 0.25 * grid.dx + 0.02 * compliance;
      const Pressed by_approach = press(bench, grid, Boundary::free, gap, {Drive::approach, approach, kTight}, mixed);
      expect_certified(by_approach, kTight);
      EXPECT_EQ(by_approach.nodes_in_contact(), 1);
      EXPECT_NEAR(by_approach.solution.total, 0.02, kTight);  // a penetration of kTight of the displacement is left
    }
  }
}

TEST(Contact, can_be_full) {
  const Workbench bench;
  for (const Grid grid : {Grid{61, 47, 1, 1}, Grid{128, 64, 1, 1.5}, Grid{1, 50, 1, 1}, Grid{32, 32, 1, 1}}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      const std::vector<double> gap = support::random_gap(grid, 0.01, 1);
      const double force = static_cast<double>(grid.nodes());
      for (const bool mixed : {false, true}) {
        const Pressed pressed = press(bench, grid, boundary, gap, {Drive::force, force, kTight}, mixed);
        expect_certified(pressed, kTight);
        EXPECT_EQ(pressed.nodes_in_contact(), grid.nx * grid.ny);
        // Periodic: the mean displacement is zero, so that the approach is the mean gap, to the certificate.
        if (boundary == Boundary::periodic) {
          EXPECT_NEAR(pressed.solution.approach, mean(gap), 0.01 * kTight);
        }
      }
    }
  }
}

// A plane pressed flat: without a height difference to start from.
TEST(Contact, of_a_plane_is_certified_under_both_drives) {
  const Workbench bench;
  for (const Grid grid : {Grid{17, 17, 1, 1}, Grid{100, 64, 1, 1}}) {
    const std::vector<double> gap(grid.nodes(), 0.0);
    const Pressed by_force = press(bench, grid, Boundary::free, gap, {Drive::force, 10, 1e-9});
    expect_certified(by_force, 1e-9);
    const Pressed by_approach =
        press(bench, grid, Boundary::free, gap, {Drive::approach, by_force.solution.approach, 1e-9});
    expect_certified(by_approach, 1e-9);
    EXPECT_NEAR(by_approach.solution.total, 10, 1e-8);
    // Periodic: a plane under uniform pressure is undeformed; there is no displacement to be relative to.
    const Pressed periodic = press(bench, grid, Boundary::periodic, gap, {Drive::force, 10, 1e-9});
    expect_certified(periodic, 1e-9);
    EXPECT_EQ(periodic.nodes_in_contact(), grid.nx * grid.ny);
  }
}

// E* · rms slope / 2 is the rms of the pressure that flattens a surface, here 0.05 E*; from about three times that
// the last valleys close.
TEST(Contact, close_to_full_converges) {
  const Workbench bench;
  const Grid grid{128, 128, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 3), grid);
  double last = 0;
  bool nearly_full = false;
  for (const double p : {0.06, 0.08, 0.1, 0.12, 0.14, 0.25}) {
    const Pressed pressed =
        press(bench, grid, Boundary::periodic, gap, {Drive::force, p * static_cast<double>(grid.nodes()), 1e-9});
    expect_certified(pressed, 1e-9);
    EXPECT_LE(pressed.solution.iterations, 100);
    const double area = static_cast<double>(pressed.nodes_in_contact()) / static_cast<double>(grid.nodes());
    EXPECT_GE(area, last);
    nearly_full = nearly_full || (area > 0.95 && area < 1);
    last = area;
  }
  EXPECT_TRUE(nearly_full);
  EXPECT_EQ(last, 1);
}

TEST(Contact, can_be_dilute) {
  const Workbench bench;
  const Grid grid{256, 256, 1, 1};
  const double nodes = static_cast<double>(grid.nodes());
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    const std::vector<double> gap = gap_of(self_affine(grid, 2), grid);
    const Pressed pressed = press(bench, grid, boundary, gap, {Drive::force, 1e-5 * nodes, 1e-9});
    expect_certified(pressed, 1e-9);
    EXPECT_LT(static_cast<double>(pressed.nodes_in_contact()), 1e-3 * nodes);
  }
}

// Towards no load a contact shrinks to one node: approach = K(0, 0) · force.
TEST(Contact, under_tiny_loads_is_one_node) {
  const Workbench bench;
  const Grid grid{65, 65, 1, 1};
  const double compliance = influence::Displacement(1, 1)(0, 0);
  const std::vector<double> gap = gap_of(surface::Sphere{1000}, grid);
  for (const double force : {1e-6, 1e-9, 1e-12, 1e-100}) {
    const Pressed by_force = press(bench, grid, Boundary::free, gap, {Drive::force, force, kTight});
    expect_certified(by_force, kTight);
    EXPECT_EQ(by_force.nodes_in_contact(), 1);
    EXPECT_NEAR(by_force.solution.approach / force, compliance, 1e-13);
    const Pressed by_approach =
        press(bench, grid, Boundary::free, gap, {Drive::approach, force * compliance, kTight});
    expect_certified(by_approach, kTight);
    EXPECT_NEAR(by_approach.solution.total / force, 1, kTight);
  }
}

TEST(Contact, of_white_noise_converges) {
  const Workbench bench;
  for (const Grid grid : {Grid{128, 128, 1, 1}, Grid{101, 89, 1, 1}}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      for (const double height : {1e-3, 0.1, 10.0}) {
        const std::vector<double> gap = support::random_gap(grid, height, 5);
        const double force = 0.05 * height * static_cast<double>(grid.nodes());
        expect_certified(press(bench, grid, boundary, gap, {Drive::force, force, 1e-9}), 1e-9);
        // Coarser grids, whose gaps are means, do not see the peaks that touch first.
        for (const double part : {1e-3, 0.3}) {
          const double approach = least(gap) + part * (mean(gap) - least(gap));
          expect_certified(press(bench, grid, boundary, gap, {Drive::approach, approach, 1e-9}), 1e-9);
        }
      }
    }
  }
}

// Heights are multiples of 2^-30, so that the constants are added without rounding and both problems are the same.
TEST(Contact, knows_gaps_only_up_to_a_constant) {
  const Workbench bench;
  const Grid grid{70, 66, 1, 1};
  std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  for (double& h : gap) h = std::round(h * 0x1p30) * 0x1p-30;
  const Request request{Drive::force, 0.005 * static_cast<double>(grid.nodes()), 1e-10};
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    const Pressed reference = press(bench, grid, boundary, gap, request);
    expect_certified(reference, 1e-10);
    for (const double constant : {-1.0, 1.0, 1024.0, -1048576.0}) {
      std::vector<double> moved = gap;
      for (double& h : moved) h += constant;
      const Pressed pressed = press(bench, grid, boundary, moved, request);
      expect_certified(pressed, 1e-10);
      // Each differs from the solution by its certificate, times some ten for the contact's size in nodes.
      EXPECT_LE(largest_difference(pressed.pressure, reference.pressure), 1e-8 * reference.largest());
      const double round_off = 4e-16 * std::fabs(constant);
      EXPECT_NEAR(pressed.solution.approach - constant, reference.solution.approach, 1e-9 + round_off);
      const Pressed by_approach =
          press(bench, grid, boundary, moved, {Drive::approach, pressed.solution.approach, 1e-10});
      expect_certified(by_approach, 1e-10);
    }
  }
}

TEST(Contact, is_the_same_in_any_unit_of_length) {
  const Workbench bench;
  const Grid grid{70, 66, 1, 1.25};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    for (const bool mixed : {false, true}) {
      const Request by_force{Drive::force, 0.005 * static_cast<double>(grid.nodes()), kTight};
      const Pressed reference = press(bench, grid, boundary, gap, by_force, mixed);
      const Request by_approach{Drive::approach, reference.solution.approach, kTight};
      for (const double unit : {1e-9, 1e-6, 0x1p-20, 1e3, 0x1p40}) {
        std::vector<double> scaled = gap;
        for (double& h : scaled) h *= unit;
        const Grid scaled_grid{grid.nx, grid.ny, grid.dx * unit, grid.dy * unit};
        const Pressed pressed = press(bench, scaled_grid, boundary, scaled, by_force, mixed);
        expect_certified(pressed, kTight);
        const bool exact = unit == 0x1p-20 || unit == 0x1p40;  // powers of two round nothing: the same bits
        EXPECT_LE(largest_difference(pressed.pressure, reference.pressure),
                  exact ? 0 : 1e2 * kTight * reference.largest());
        EXPECT_NEAR(pressed.solution.approach / unit, reference.solution.approach, exact ? 0 : 10 * kTight);
        Request again = by_approach;
        again.load.target *= unit;
        const Pressed back = press(bench, scaled_grid, boundary, scaled, again, mixed);
        expect_certified(back, kTight);
        EXPECT_NEAR(back.solution.total, by_force.load.target, 1e3 * kTight * by_force.load.target);
      }
    }
  }
}

TEST(Contact, below_first_touch_is_none) {
  const Workbench bench;
  const Grid grid{80, 70, 1, 1};
  std::vector<double> gap = gap_of(surface::Sphere{50}, grid);
  for (double& h : gap) h += 0.5;
  Solver solver(bench.resources, grid, Boundary::free, gap.data(), false);
  EXPECT_EQ(solver.first_touch(), least(gap));
  // Also after there was contact, and again contact after that.
  for (const Request& request :
       {Request{Drive::approach, -1}, Request{Drive::approach, 1}, Request{Drive::approach, least(gap)},
        Request{Drive::force, 3}, Request{Drive::force, 0}, Request{Drive::approach, 0.6}}) {
    const Solution solution = solve(solver, request);
    EXPECT_TRUE(solution.converged);
    const bool touches =
        request.load.drive == Drive::force ? request.load.target > 0 : request.load.target > least(gap);
    EXPECT_EQ(solution.total > 0, touches);
    if (request.load.drive == Drive::approach) {
      EXPECT_EQ(solution.approach, request.load.target);
    }
    if (touches) continue;
    for (std::size_t n = 0; n < gap.size(); ++n) {
      ASSERT_EQ(solver.pressure()[n], 0);
      ASSERT_EQ(solver.deformed_gap()[n], gap[n] - least(gap));
    }
    EXPECT_EQ(solution.certificate.worst(), 0);
  }
}

TEST(Contact, periodic_beyond_the_mean_gap_has_no_equilibrium) {
  const Workbench bench;
  for (const Grid grid : {Grid{64, 32, 1, 1}, Grid{1, 1, 1, 1}}) {
    const std::vector<double> gap = support::random_gap(grid, 1, 2);
    for (const double beyond : {1e-9, 1.0}) {
      Solver solver(bench.resources, grid, Boundary::periodic, gap.data(), false);
      try {
        solve(solver, {Drive::approach, mean(gap) + beyond});
        FAIL() << "accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.status(), Status::no_equilibrium);
        EXPECT_NE(std::string(error.what()).find("approach = "), std::string::npos) << error.what();
      }
      EXPECT_TRUE(solve(solver, {Drive::force, 1}).converged);  // still of use
    }
  }
}

TEST(Contact, periodic_just_below_the_mean_gap_converges) {
  const Workbench bench;
  const Grid grid{64, 64, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  const double full = mean(gap), range = full - least(gap);
  for (const double below : {1e-1, 1e-2, 1e-4}) {
    const Pressed pressed =
        press(bench, grid, Boundary::periodic, gap, {Drive::approach, full - below * range, 1e-9, 2000});
    expect_certified(pressed, 1e-9);
  }
}

TEST(Contact, with_an_unreachable_tolerance_ends_with_its_honest_certificate) {
  const Workbench bench;
  for (const Grid grid : {Grid{20, 20, 1, 1}, Grid{96, 96, 1, 1}}) {
    const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      for (const bool mixed : {false, true}) {
        const double force = 0.01 * static_cast<double>(grid.nodes());
        const Pressed pressed = press(bench, grid, boundary, gap, {Drive::force, force, 1e-17, 1000}, mixed);
        EXPECT_FALSE(pressed.solution.converged);
        EXPECT_LE(pressed.solution.certificate.worst(), 1e-11);  // round-off, with room
        EXPECT_LT(pressed.solution.iterations, 1000);            // given up before
        const Certificate expected = support::certificate_by_sums(grid, boundary, gap, pressed.pressure,
                                                                  pressed.solution.approach, Drive::force, force);
        EXPECT_NEAR(pressed.solution.certificate.worst(), expected.worst(), 1e-13);
      }
    }
  }
}

TEST(Contact, stopped_by_its_iterations_reports_its_honest_certificate) {
  const Workbench bench;
  const Grid grid{96, 96, 1, 1};
  const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
  for (const Drive drive : {Drive::force, Drive::approach}) {
    const double target = drive == Drive::force ? 100 : 0.5 * least(gap);
    for (const int iterations : {0, 1, 3}) {
      const Pressed pressed = press(bench, grid, Boundary::free, gap, {drive, target, 1e-12, iterations});
      EXPECT_FALSE(pressed.solution.converged);
      EXPECT_LE(pressed.solution.iterations, iterations);
      const Certificate expected = support::certificate_by_sums(grid, Boundary::free, gap, pressed.pressure,
                                                                pressed.solution.approach, drive, target);
      EXPECT_NEAR(pressed.solution.certificate.worst(), expected.worst(), 1e-13);
      EXPECT_GT(expected.worst(), 1e-12);
    }
  }
}

TEST(Contact, in_mixed_precision_reaches_the_same_certificate) {
  const Workbench bench;
  for (const Grid grid : {Grid{128, 128, 1, 1}, Grid{97, 83, 1, 2}}) {
    const std::vector<double> gap = gap_of(self_affine(grid, 4), grid);
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      const Request request{Drive::force, 0.01 * static_cast<double>(grid.nodes()), kTight};
      const Pressed in_double = press(bench, grid, boundary, gap, request, false);
      const Pressed mixed = press(bench, grid, boundary, gap, request, true);
      expect_certified(in_double, kTight);
      expect_certified(mixed, kTight);
      EXPECT_LE(largest_difference(in_double.pressure, mixed.pressure), 1e2 * kTight * in_double.largest());
    }
  }
}

TEST(Contact, force_and_approach_lead_to_each_other) {
  const Workbench bench;
  for (const Grid grid : {Grid{100, 90, 1, 1}, Grid{31, 29, 1, 1}}) {
    const std::vector<double> gap = gap_of(self_affine(grid, 1), grid);
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      const double force = 0.008 * static_cast<double>(grid.nodes());
      const Pressed there = press(bench, grid, boundary, gap, {Drive::force, force, kTight});
      const Pressed back = press(bench, grid, boundary, gap, {Drive::approach, there.solution.approach, kTight});
      expect_certified(there, kTight);
      expect_certified(back, kTight);
      EXPECT_LE(largest_difference(there.pressure, back.pressure), 1e3 * kTight * there.largest());
      EXPECT_NEAR(back.solution.total, force, 1e3 * kTight * force);
      const Pressed again = press(bench, grid, boundary, gap, {Drive::force, back.solution.total, kTight});
      EXPECT_NEAR(again.solution.approach, there.solution.approach, 1e3 * kTight);
    }
  }
}

// Iterations on the full grid, an algorithm's property that no machine changes; about half as many again as today.
TEST(Contact, needs_few_iterations) {
  const Workbench bench;
  const Grid grid{512, 512, 1, 1};
  const double nodes = static_cast<double>(grid.nodes());
  const std::vector<double> sphere = gap_of(surface::Sphere{1e4}, grid);
  const Pressed smooth = press(bench, grid, Boundary::free, sphere, {Drive::force, 1.3e3, 1e-8});
  expect_certified(smooth, 1e-8);
  EXPECT_LE(smooth.solution.iterations, 15);
  const std::vector<double> rough = gap_of(self_affine(grid, 1), grid);
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    const Pressed five = press(bench, grid, boundary, rough, {Drive::force, 0.0022 * nodes, 1e-6});
    expect_certified(five, 1e-6);
    EXPECT_NEAR(static_cast<double>(five.nodes_in_contact()) / nodes, 0.05, 0.01);
    EXPECT_LE(five.solution.iterations, 35);
    const Pressed twenty = press(bench, grid, boundary, rough, {Drive::force, 0.01 * nodes, 1e-6});
    expect_certified(twenty, 1e-6);
    EXPECT_NEAR(static_cast<double>(twenty.nodes_in_contact()) / nodes, 0.2, 0.03);
    EXPECT_LE(twenty.solution.iterations, 60);
  }
}

}  // namespace
}  // namespace brinell::contact
