// The solver against the direct solution of the same discrete problem.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/direct_contact.h"
#include "support/workbench.h"

namespace brinell::contact {
namespace {

using support::Pressed;

// A certificate of 1e-13 leaves residuals of 1e-13 of the largest displacement. K's smallest eigenvalue is about
// 1/π dx (symbol 2/|q| at the Nyquist wave number), the largest displacement u a few to 30 dx p_max for contacts
// 1 to 32 nodes wide: pressures err by less than 30 π 1e-13, about 1e-11, of p_max. Asked for: 1e-10.
constexpr double kTolerance = 1e-13;
constexpr double kAgreement = 1e-10;

void expect_agreement(const Grid& grid, Boundary boundary, const std::vector<double>& gap, Drive drive,
                      double target) {
  const support::DirectContact direct = support::direct_contact(grid, boundary, gap, drive, target);
  ASSERT_TRUE(direct.solved);
  const support::Workbench bench;
  for (const bool mixed : {false, true}) {
    SCOPED_TRACE(mixed ? "mixed precision" : "double precision");
    const Pressed pressed = support::press(bench, grid, boundary, gap, {drive, target, kTolerance, 2000}, mixed);
    EXPECT_TRUE(pressed.solution.converged)
        << pressed.solution.certificate.worst() << " after " << pressed.solution.iterations;
    const double largest = pressed.largest();
    EXPECT_LE(support::largest_difference(pressed.pressure, direct.pressure), kAgreement * largest);
    EXPECT_NEAR(pressed.solution.total, direct.total, kAgreement * direct.total);
    // The approach is a gap where there is contact; p_max dx is of the order of the displacement of one node.
    EXPECT_NEAR(pressed.solution.approach, direct.approach,
                kAgreement * (std::fabs(direct.approach) + largest * grid.dx));
  }
}

struct Case {
  Grid grid;
  Boundary boundary;
};

std::string text_of(const Case& c) {
  return std::to_string(c.grid.nx) + " x " + std::to_string(c.grid.ny) + " spaced " + std::to_string(c.grid.dx) +
         " x " + std::to_string(c.grid.dy) + (c.boundary == Boundary::free ? " free" : " periodic");
}

constexpr Case kCases[] = {
    {{32, 32, 1, 1}, Boundary::free},         {{19, 19, 0.3, 0.3}, Boundary::periodic},
    {{24, 17, 1e-6, 1.7e-6}, Boundary::free}, {{12, 31, 2.5e-3, 1e-3}, Boundary::free},
    {{16, 10, 1, 3}, Boundary::periodic},     {{27, 8, 0.2, 0.5}, Boundary::periodic},
};

TEST(Solver, agrees_with_the_direct_solution_for_a_sphere) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(text_of(c));
    const double radius = 20 * c.grid.dx * static_cast<double>(c.grid.nx);
    const std::vector<double> gap =
        support::gap_of(surface::Sphere{radius}, c.grid, {0.3 * c.grid.dx, -1.2 * c.grid.dy});
    const double contact_radius =
        0.3 * std::min(static_cast<double>(c.grid.nx) * c.grid.dx, static_cast<double>(c.grid.ny) * c.grid.dy);
    const double force = 4 * std::pow(contact_radius, 3) / (3 * radius);
    expect_agreement(c.grid, c.boundary, gap, Drive::force, force / c.grid.cell_area());
    expect_agreement(c.grid, c.boundary, gap, Drive::approach, 0.5 * contact_radius * contact_radius / radius);
  }
}

TEST(Solver, agrees_with_the_direct_solution_for_rough_surfaces) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(text_of(c));
    const double nodes = static_cast<double>(c.grid.nodes());
    for (const unsigned seed : {1U, 2U, 3U}) {
      const std::vector<double> gap = support::gap_of(support::self_affine(c.grid, seed), c.grid);
      // A mean pressure of rms slope · E* / 25 makes a contact of about a tenth of the area.
      expect_agreement(c.grid, c.boundary, gap, Drive::force, 0.004 * nodes * (1 + seed));
      double lowest = gap[0];
      for (const double h : gap) lowest = std::min(lowest, h);
      expect_agreement(c.grid, c.boundary, gap, Drive::approach, 0.7 * lowest);
    }
  }
}

TEST(Solver, agrees_with_the_direct_solution_for_random_gaps) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(text_of(c));
    const double nodes = static_cast<double>(c.grid.nodes());
    for (const unsigned seed : {1U, 2U, 3U}) {
      const std::vector<double> gap = support::random_gap(c.grid, 0.2 * c.grid.dx, seed);
      expect_agreement(c.grid, c.boundary, gap, Drive::force, 0.02 * nodes);
      expect_agreement(c.grid, c.boundary, gap, Drive::approach, 0.08 * c.grid.dx);
    }
  }
}

TEST(Solver, agrees_with_the_direct_solution_on_lines_and_small_grids) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {2, 1}, {1, 2}, {3, 2}, {1, 37}, {64, 1}, {5, 7}}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      const Case c{{nx, ny, 0.5, 0.8}, boundary};
      SCOPED_TRACE(text_of(c));
      const std::vector<double> gap = support::random_gap(c.grid, 0.2, 4);
      double lowest = gap[0], mean = 0;
      for (const double h : gap) {
        lowest = std::min(lowest, h);
        mean += h / static_cast<double>(gap.size());
      }
      expect_agreement(c.grid, c.boundary, gap, Drive::force, 0.03 * static_cast<double>(c.grid.nodes()));
      if (c.grid.nodes() == 1 && boundary == Boundary::periodic) continue;  // cannot be indented: its mean is zero
      expect_agreement(c.grid, c.boundary, gap, Drive::approach, 0.5 * (lowest + mean) + (nx * ny == 1 ? 0.1 : 0));
    }
  }
}

TEST(Solver, certificate_is_what_direct_sums_give) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(text_of(c));
    const std::vector<double> gap = support::gap_of(support::self_affine(c.grid, 7), c.grid);
    for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
      for (const Drive drive : {Drive::force, Drive::approach}) {
        double lowest = gap[0], highest = gap[0];
        for (const double h : gap) {
          lowest = std::min(lowest, h);
          highest = std::max(highest, h);
        }
        const double target = drive == Drive::force ? 0.01 * static_cast<double>(c.grid.nodes()) : 0.6 * lowest;
        const Pressed pressed =
            support::press(support::Workbench(), c.grid, c.boundary, gap, {drive, target, tolerance, 500});
        const Certificate expected = support::certificate_by_sums(c.grid, c.boundary, gap, pressed.pressure,
                                                                  pressed.solution.approach, drive, target);
        EXPECT_TRUE(pressed.solution.converged);
        EXPECT_LE(pressed.solution.certificate.worst(), tolerance);
        // Round-off of the convolution and of the sum gap + u: some tens of ε of the largest gap, which is a few
        // displacements at these loads.
        const double round_off = 1e-13;
        EXPECT_NEAR(pressed.solution.certificate.penetration, expected.penetration, round_off);
        EXPECT_NEAR(pressed.solution.certificate.complementarity, expected.complementarity, round_off);
        EXPECT_NEAR(pressed.solution.certificate.balance, expected.balance, round_off);
        EXPECT_EQ(expected.tension, 0);
      }
    }
  }
}

}  // namespace
}  // namespace brinell::contact
