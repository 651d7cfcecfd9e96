// A rigid sphere that slides over a body that hardens: the shear adds to the stress that yields.
//
// In the elastic range the stress is that of G. M. Hamilton (1983; support/sliding_sphere.h). With the largest von
// Mises stress k(mu) p0 in it, yielding begins at p0 = Y/k, that is at the force F(mu)/F(0) = (k(0)/k(mu))³ of the
// frictionless contact, and nearer to the surface; beyond mu = 0.4 at the surface itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "physics/nanoindentation.h"
#include "plastic/elastic_plastic.h"
#include "subsurface/invariants.h"
#include "support/sliding_sphere.h"
#include "support/workbench.h"

namespace brinell::physics {
namespace {

using plastic::PlasticBody;
using plastic::PlasticSolution;
using plastic::TractionRatio;

/// A rigid sphere on a body of one material, or between two of it.
struct Slide {
  Slide(const plastic::HardeningLaw& law, std::int64_t nodes, double spacing, const plastic::Layers& layers,
        double tolerance, bool both = false)
      : grid{nodes, nodes, spacing, spacing},
        modulus(both ? kModulus / 2 : kModulus),
        gap(support::gap_of(surface::Sphere{kRadius}, grid)),
        present(gap),
        solver(bench.resources, grid, Boundary::free, present.data(), false),
        loop(bench.resources, grid, gap.data(), present.data(), solver, pair_of(law, both),
             {modulus, layers, tolerance, 2000, std::size_t{1} << 28}) {}

  static plastic::Pair pair_of(const plastic::HardeningLaw& law, bool both) {
    plastic::Pair pair;
    pair.material[0] = plastic::PlasticMaterial{kYoung, kPoisson, {law, {}}};
    if (both) pair.material[1] = pair.material[0];
    return pair;
  }

  PlasticSolution to(double force, const TractionRatio& shear) {
    return loop.advance(
        {contact::Drive::force, force / (modulus * grid.cell_area())}, [](const contact::Report&) { return true; },
        shear);
  }

  support::Workbench bench;
  Grid grid;
  double modulus;
  std::vector<double> gap, present;
  contact::Solver solver;
  plastic::ElasticPlastic loop;
};

struct Place {
  double ratio = 0;  // von Mises stress / p0
  double x = 0, y = 0, z = 0;
};

/// The largest of the centres of cuboids with sides of a/10 and a height of a/20, one of which lies on the axis; a
/// = 1.
Place largest_below(double friction) {
  const reference::SlidingSphere stress{1, 1, friction, kPoisson};
  Place largest;
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j <= 3; ++j) {
      for (int i = -11; i <= 11; ++i) {
        const Place at{0, 0.1 * i, 0.1 * j, 0.05 * k + 0.025};
        const auto s = stress(at.x, at.y, at.z);
        const double mises = subsurface::von_mises({s[0], s[1], s[2], s[3], s[4], s[5]});
        if (mises > largest.ratio) largest = {mises, at.x, at.y, at.z};
      }
    }
  }
  return largest;
}

double hertz_force(double p0) {
  const double contact_radius = std::numbers::pi * p0 * kRadius / (2 * kModulus);
  return 2.0 / 3 * std::numbers::pi * p0 * contact_radius * contact_radius;
}

TEST(SlidingPlasticity, begins_where_the_sliding_sphere_reaches_the_yield_stress) {
  constexpr double yield_stress = 3e9;
  Place before;
  double force_before = 0;
  for (const double friction : {0.0, 0.3, 0.5}) {
    const Place hertz = largest_below(friction);
    const double p0 = yield_stress / hertz.ratio;
    const double contact_radius = std::numbers::pi * p0 * kRadius / (2 * kModulus);
    const double force = hertz_force(p0);
    // The stress is that at the centres of the cuboids, so that only the pressure by cells errs, by as much as 0.2 %
    // (Hertz, sphere_converges_with_second_order), and near the surface by what a cell levels of it, 1 %: 3 % in
    // load.
    constexpr double resolved = 0.03;
    Slide slide(plastic::PerfectPlasticity{yield_stress}, 27, contact_radius / 10, {24, contact_radius / 20}, 1e-7);
    ASSERT_TRUE(slide.to((1 - resolved) * force, {friction, 0}).converged);
    EXPECT_EQ(slide.loop.body(0)->largest().cuboids, 0) << friction;
    ASSERT_TRUE(slide.to((1 + resolved) * force, {friction, 0}).converged);
    const plastic::LargestPlasticStrain first = slide.loop.body(0)->largest();
    EXPECT_GT(first.cuboids, 0) << friction;
    EXPECT_LT(first.cuboids, 100) << friction;
    EXPECT_NEAR(first.at[0], hertz.x * contact_radius, 1.5 * slide.grid.dx) << friction;
    EXPECT_NEAR(first.at[1], hertz.y * contact_radius, 1.5 * slide.grid.dx) << friction;
    EXPECT_NEAR(first.at[2], hertz.z * contact_radius, 1.5 * slide.grid.dx) << friction;
    if (friction > 0) {
      EXPECT_LT(force, force_before);
      EXPECT_LT(hertz.z, before.z);
    }
    before = hertz;
    force_before = force;
  }
}

constexpr std::int64_t kNodes = 20;
constexpr double kCell = 0.6e-6;
constexpr plastic::Layers kLayers{14, 0.6e-6};
constexpr double kTolerance = 1e-9;

/// Component c of the plastic strain below all nodes; 6: equivalent.
std::vector<double> strain_below(const Slide& slide, int which, std::size_t c, bool mirrored = false) {
  const PlasticBody& body = *slide.loop.body(which);
  const plastic::Region& region = body.region();
  std::vector<double> values(static_cast<std::size_t>(kNodes * kNodes * kLayers.count));
  for (std::int64_t k = 0; k < region.box.nz; ++k) {
    for (std::int64_t j = 0; j < region.box.ny; ++j) {
      for (std::int64_t i = 0; i < region.box.nx; ++i) {
        const std::int64_t x = mirrored ? kNodes - 1 - region.i0 - i : region.i0 + i;
        const auto n = static_cast<std::size_t>((k * region.box.ny + j) * region.box.nx + i);
        values[static_cast<std::size_t>((k * kNodes + region.j0 + j) * kNodes + x)] =
            c < 6 ? body.strain()[c][n] : body.equivalent()[n];
      }
    }
  }
  return values;
}

/// All that changes its sign in a mirror x -> -x are the components xz and xy.
void expect_mirrored(const Slide& a, int of_a, const Slide& b, int of_b) {
  const double largest = a.loop.body(of_a)->largest().value;
  ASSERT_GT(largest, 1e-4);
  for (std::size_t c = 0; c < 7; ++c) {
    const double sign = c == 4 || c == 5 ? -1 : 1;
    const std::vector<double> expected = strain_below(a, of_a, c), found = strain_below(b, of_b, c, true);
    for (std::size_t n = 0; n < found.size(); ++n) {
      // Each meets the yield condition within the tolerance; 1e3 for the softness of flow, 2 mu against the
      // hardening.
      ASSERT_NEAR(found[n], sign * expected[n], 1e3 * kTolerance * largest) << c;
    }
  }
}

TEST(SlidingPlasticity, the_other_way_round_is_the_mirror_image) {
  Slide forth(kSteel, kNodes, kCell, kLayers, kTolerance), back(kSteel, kNodes, kCell, kLayers, kTolerance);
  for (const double force : {0.05, 0.1, 0.0}) {
    ASSERT_TRUE(forth.to(force, {0.3, 0.05}).converged);
    ASSERT_TRUE(back.to(force, {-0.3, 0.05}).converged);
  }
  expect_mirrored(forth, 0, back, 0);
}

TEST(SlidingPlasticity, the_upper_body_is_pushed_the_other_way) {
  Slide slide(kSteel, kNodes, kCell, kLayers, kTolerance, true);
  for (const double force : {0.1, 0.2}) {
    const PlasticSolution solution = slide.to(force, {0.3, 0});
    ASSERT_TRUE(solution.converged);
    EXPECT_LE(solution.yield, kTolerance);
    EXPECT_GE(solution.dissipation, 0);
  }
  expect_mirrored(slide, 0, slide, 1);
  // A shear that pushes the lower body along +x is a stress xz of the opposite sign, z pointing into the body.
  double sum = 0, magnitude = 0;
  for (const double xz : strain_below(slide, 0, 4)) {
    sum += xz;
    magnitude += std::fabs(xz);
  }
  EXPECT_LT(sum, -0.5 * magnitude);
}

TEST(SlidingPlasticity, no_shear_is_the_frictionless_contact_to_the_bit) {
  Slide none(kSteel, kNodes, kCell, kLayers, 1e-7), zero(kSteel, kNodes, kCell, kLayers, 1e-7);
  Slide slid(kSteel, kNodes, kCell, kLayers, 1e-7);
  const auto press = [](Slide& slide, double force) {
    return slide.loop.advance({contact::Drive::force, force / (slide.modulus * slide.grid.cell_area())},
                              [](const contact::Report&) { return true; });
  };
  for (const double force : {0.06, 0.1}) {
    press(none, force);
    zero.to(force, {0, 0});
    slid.to(force, {0.2, 0});
  }
  EXPECT_EQ(strain_below(none, 0, 6), strain_below(zero, 0, 6));
  EXPECT_GT(slid.loop.body(0)->largest().cuboids, none.loop.body(0)->largest().cuboids);
}

}  // namespace
}  // namespace brinell::physics
