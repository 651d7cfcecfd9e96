#include "plastic/elastic_plastic.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "influence/eigenstrain.h"
#include "influence/stress.h"
#include "plastic/indentation.h"
#include "subsurface/invariants.h"
#include "support/direct_contact.h"

namespace brinell::plastic {
namespace {

TEST(ElasticPlastic, below_yield_is_the_elastic_contact) {
  const auto plastic = indentation(lower(PerfectPlasticity{1e12}), 1e-9);
  const support::Workbench bench;
  contact::Solver elastic(bench.resources, plastic->grid, Boundary::free, plastic->gap.data(), false);
  for (const double force : {0.05, kForce, 0.03, 0.0}) {
    const PlasticSolution found = plastic->press(force);
    const contact::Solution expected = support::solve(
        elastic,
        {contact::Drive::force, force / (kModulus * plastic->grid.cell_area()), 1e-11});  // its contacts' tolerance
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.iterations, 1);
    EXPECT_EQ(found.contact.approach, expected.approach);
    EXPECT_EQ(plastic->pressure(), std::vector<double>(elastic.pressure().begin(), elastic.pressure().end()));
    EXPECT_EQ(found.dissipation, 0);
  }
  EXPECT_EQ(plastic->loop.body(0)->largest().cuboids, 0);
}

/// Coefficients of every cuboid on every other, and of every cell, summed one by one.
struct DirectState {
  std::vector<subsurface::Tensor> stress;
  std::vector<double> gap;
};

DirectState by_sums(Indentation& pressed, PlasticBody& body, double weight, const TractionRatio& shear = {}) {
  const Region& region = body.region();
  const Box& box = region.box;
  const Grid& grid = pressed.grid;
  const influence::Eigenstrain cuboid(box.dx, box.dy, box.dz, kPoisson);
  const double mu = kYoung / (2 * (1 + kPoisson));
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return static_cast<std::size_t>((k * box.ny + j) * box.nx + i);
  };
  DirectState state{std::vector<subsurface::Tensor>(box.cuboids()), pressed.gap};
  std::vector<std::size_t> strained;
  for (std::size_t n = 0; n < box.cuboids(); ++n) {
    if (body.equivalent()[n] > 0) strained.push_back(n);
  }
  for (std::int64_t k = 0; k < box.nz; ++k) {
    const double z = (static_cast<double>(k) + 0.5) * box.dz;
    const influence::Stress cell(box.dx, box.dy, z, kPoisson);
    // Coefficients by offset, for each layer of sources.
    for (std::int64_t l = 0; l < box.nz; ++l) {
      const double depth = (static_cast<double>(l) + 0.5) * box.dz;
      std::vector<influence::StressOfStrain> matrix(static_cast<std::size_t>((2 * box.nx - 1) * (2 * box.ny - 1)));
      const auto first = static_cast<std::size_t>(l * box.nx * box.ny);
      const auto begin = std::lower_bound(strained.begin(), strained.end(), first);
      const auto end = std::lower_bound(begin, strained.end(), first + static_cast<std::size_t>(box.nx * box.ny));
      if (begin == end) continue;
      for (std::int64_t j = 1 - box.ny; j < box.ny; ++j) {
        for (std::int64_t i = 1 - box.nx; i < box.nx; ++i) {
          matrix[static_cast<std::size_t>((j + box.ny - 1) * (2 * box.nx - 1) + i + box.nx - 1)] =
              cuboid.stress(static_cast<double>(i) * box.dx, static_cast<double>(j) * box.dy, z, depth);
        }
      }
      for (auto source = begin; source != end; ++source) {
        const auto n = static_cast<std::int64_t>(*source) % (box.nx * box.ny);
        for (std::int64_t j = 0; j < box.ny; ++j) {
          for (std::int64_t i = 0; i < box.nx; ++i) {
            const auto& m = matrix[static_cast<std::size_t>((j - n / box.nx + box.ny - 1) * (2 * box.nx - 1) + i -
                                                            n % box.nx + box.nx - 1)];
            for (std::size_t a = 0; a < 6; ++a) {
              for (std::size_t b = 0; b < 6; ++b) {
                state.stress[at(i, j, k)][a] += 2 * mu * m[a][b] * body.strain()[b][*source];
              }
            }
          }
        }
      }
    }
    for (std::int64_t j = 0; j < box.ny; ++j) {
      for (std::int64_t i = 0; i < box.nx; ++i) {
        for (std::int64_t y = 0; y < grid.ny; ++y) {
          for (std::int64_t x = 0; x < grid.nx; ++x) {
            const double p = pressed.solver.pressure()[static_cast<std::size_t>(y * grid.nx + x)];
            if (!(p > 0)) continue;
            for (const auto& [traction, part] :
                 {std::pair{influence::Traction::pressure, 1.0}, std::pair{influence::Traction::shear_x, shear[0]},
                  std::pair{influence::Traction::shear_y, shear[1]}}) {
              if (part == 0) continue;
              const auto sigma = cell(traction, region.i0 + i - x, region.j0 + j - y);
              for (std::size_t a = 0; a < 6; ++a) {
                state.stress[at(i, j, k)][a] += part * sigma[a] * p * pressed.contact_modulus;
              }
            }
          }
        }
      }
    }
  }
  for (const std::size_t n : strained) {
    const auto m = static_cast<std::int64_t>(n);
    const std::int64_t i = region.i0 + m % box.nx, j = region.j0 + m / box.nx % box.ny, k = m / (box.nx * box.ny);
    for (std::int64_t y = 0; y < grid.ny; ++y) {
      for (std::int64_t x = 0; x < grid.nx; ++x) {
        const auto u = cuboid.displacement(static_cast<double>(x - i) * box.dx, static_cast<double>(y - j) * box.dy,
                                           (static_cast<double>(k) + 0.5) * box.dz);
        for (std::size_t c = 0; c < 6; ++c) {
          state.gap[static_cast<std::size_t>(y * grid.nx + x)] += weight * u[c] * body.strain()[c][n];
        }
      }
    }
  }
  return state;
}

double worst_yield(PlasticBody& body, const std::vector<subsurface::Tensor>& stress,
                   const std::vector<double>& plastic_before) {
  double worst = 0;
  for (std::size_t n = 0; n < stress.size(); ++n) {
    const double p = body.equivalent()[n];
    const double yield = body.law().yield_stress(p);
    const double excess = subsurface::von_mises(stress[n]) - yield;
    worst = std::max(worst, (p > plastic_before[n] ? std::fabs(excess) : excess) / yield);
  }
  return worst;
}

TEST(ElasticPlastic, certificate_holds_by_sums_of_its_own) {
  constexpr double tolerance = 1e-7;
  Indentation pressed(lower(kSteel), kModulus, 14, 0.9e-6, {10, 0.8e-6}, tolerance);
  ASSERT_TRUE(pressed.press(0.06).converged);
  PlasticBody& body = *pressed.loop.body(0);
  const Region region = body.region();
  const std::vector<double> before(body.equivalent().begin(), body.equivalent().end());
  const PlasticSolution solution = pressed.press(0.075);
  ASSERT_TRUE(solution.converged);
  ASSERT_TRUE(body.region() == region) << "plastic strain before stands elsewhere";
  ASSERT_GT(body.largest().cuboids, 20);
  const DirectState direct = by_sums(pressed, body, 1);
  // Both sums round; what they differ by is far below the tolerance.
  EXPECT_NEAR(worst_yield(body, direct.stress, before), solution.yield, 1e-10);
  EXPECT_LE(solution.yield, tolerance);
  const contact::Certificate expected = support::certificate_by_sums(
      pressed.grid, Boundary::free, direct.gap, pressed.pressure(), solution.contact.approach, contact::Drive::force,
      0.075 / (kModulus * pressed.grid.cell_area()));
  EXPECT_LE(expected.worst(), tolerance);
}

TEST(ElasticPlastic, certificate_holds_by_sums_of_its_own_in_sliding) {
  constexpr double tolerance = 1e-7;
  constexpr TractionRatio shear{0.3, -0.1};
  Indentation pressed(lower(kSteel), kModulus, 14, 0.9e-6, {10, 0.8e-6}, tolerance);
  const auto press = [&](double force) {
    return pressed.loop.advance(
        {contact::Drive::force, force / (kModulus * pressed.grid.cell_area())},
        [](const contact::Report&) { return true; }, shear);
  };
  ASSERT_TRUE(press(0.05).converged);
  PlasticBody& body = *pressed.loop.body(0);
  const Region region = body.region();
  const std::vector<double> before(body.equivalent().begin(), body.equivalent().end());
  const PlasticSolution solution = press(0.06);
  ASSERT_TRUE(solution.converged);
  ASSERT_TRUE(body.region() == region) << "plastic strain before stands elsewhere";
  ASSERT_GT(body.largest().cuboids, 20);
  // As without shear.
  EXPECT_NEAR(worst_yield(body, by_sums(pressed, body, 1, shear).stress, before), solution.yield, 1e-10);
  EXPECT_LE(solution.yield, tolerance);
  EXPECT_GT(worst_yield(body, by_sums(pressed, body, 1).stress, before), 1e3 * tolerance);
}

TEST(ElasticPlastic, by_force_and_by_approach_is_the_same) {
  const auto by_force = indentation(lower(kSteel), 1e-8), by_approach = indentation(lower(kSteel), 1e-8);
  for (const double part : {0.25, 0.5, 0.75, 1.0, 0.4}) {
    const PlasticSolution first = by_force->press(part * kForce);
    const PlasticSolution second = by_approach->approach(first.contact.approach);
    ASSERT_TRUE(first.converged && second.converged);
    EXPECT_LE(relative(by_approach->force(second), part * kForce), 1e-6);
    EXPECT_LE(support::largest_difference(by_force->pressure(), by_approach->pressure()), 1e-5 * by_force->peak());
  }
}

TEST(ElasticPlastic, unloads_to_zero_and_reloads_along_the_same_path) {
  const auto pressed = indentation(lower(kSteel), 1e-8);
  ASSERT_TRUE(pressed->press(0.5 * kForce).converged);
  const PlasticSolution top = pressed->press(kForce);
  const std::vector<double> at_top = pressed->pressure();
  const PlasticSolution half = pressed->press(0.5 * kForce);
  const std::vector<double> at_half = pressed->pressure();
  const double plastic = pressed->loop.body(0)->largest().value;
  const PlasticSolution apart = pressed->press(0);
  EXPECT_TRUE(apart.converged);
  EXPECT_EQ(apart.contact.total, 0);
  EXPECT_EQ(pressed->peak(), 0);
  EXPECT_LT(pressed->solver.first_touch(), top.contact.approach);
  EXPECT_GT(pressed->solver.first_touch(), 0) << "an imprint stays";
  const PlasticSolution half_again = pressed->press(0.5 * kForce);
  // Tolerance 1e-8 on the gap; the pressure at the edge follows it with its square root.
  EXPECT_LE(relative(half_again.contact.approach, half.contact.approach), 1e-7);
  EXPECT_LE(support::largest_difference(pressed->pressure(), at_half), 1e-4 * pressed->peak());
  const PlasticSolution top_again = pressed->press(kForce);
  EXPECT_TRUE(top_again.converged);
  EXPECT_LE(relative(top_again.contact.approach, top.contact.approach), 1e-7);
  EXPECT_LE(relative(pressed->loop.body(0)->largest().value, plastic), 1e-6);
  EXPECT_GE(top.dissipation, 0);
  EXPECT_LE(std::fabs(top_again.dissipation), 1e-6 * top.dissipation);
}

TEST(ElasticPlastic, identical_bodies_are_two_bodies_of_one_law) {
  Pair two = lower(kSteel), one = two;
  two.material[1] = two.material[0];
  one.identical = true;
  Indentation of_two(two, kModulus / 2, 20, 0.6e-6, {14, 0.6e-6});
  Indentation of_one(one, kModulus / 2, 20, 0.6e-6, {14, 0.6e-6});
  for (const double force : {0.06, 0.12, 0.0}) {
    const PlasticSolution first = of_two.press(force), second = of_one.press(force);
    ASSERT_TRUE(first.converged && second.converged);
    EXPECT_NEAR(first.contact.approach, second.contact.approach, 1e-6 * 2e-7);
    EXPECT_NEAR(first.dissipation, second.dissipation, 1e-5 * first.dissipation);
    EXPECT_EQ(of_two.loop.body(0)->equivalent()[0], of_two.loop.body(1)->equivalent()[0]);
  }
  EXPECT_LE(relative(of_one.loop.body(0)->largest().value, of_two.loop.body(1)->largest().value), 1e-5);
}

TEST(ElasticPlastic, bodies_have_laws_of_their_own) {
  Pair pair = lower(kSteel);
  pair.material[1] = PlasticMaterial{kYoung, kPoisson, {PerfectPlasticity{3e9}, {}}};
  Indentation pressed(pair, kModulus / 2, 20, 0.6e-6, {14, 0.6e-6});
  const PlasticSolution solution = pressed.press(0.15);
  EXPECT_TRUE(solution.converged);
  EXPECT_GT(pressed.loop.body(0)->largest().value, 10 * pressed.loop.body(1)->largest().value);
}

TEST(ElasticPlastic, gives_the_same_bits_for_any_number_of_threads) {
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  const auto history = [](int threads) {
    const auto pressed = indentation(lower(kSteel), 1e-7, threads);
    std::vector<double> values;
    for (const double part : {0.6, 1.0, 0.5}) {
      const PlasticSolution solution = pressed->press(part * kForce);
      values.insert(values.end(), {solution.contact.approach, solution.yield, solution.dissipation});
      const std::vector<double> p = pressed->pressure();
      values.insert(values.end(), p.begin(), p.end());
      const Buffer<double>& plastic = pressed->loop.body(0)->equivalent();
      values.insert(values.end(), plastic.begin(), plastic.end());
    }
    return values;
  };
  const std::vector<double> alone = history(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(history(threads), alone) << threads;
}

TEST(ElasticPlastic, goes_on_from_a_saved_state_with_the_same_bits) {
  const auto whole = indentation(lower(kSteel)), resumed = indentation(lower(kSteel));
  whole->press(0.4 * kForce);
  whole->press(0.7 * kForce);
  resumed->loop.restore(whole->loop.state());
  EXPECT_EQ(resumed->pressure(), whole->pressure());
  EXPECT_EQ(resumed->present, whole->present);
  for (const double part : {1.0, 0.6, 0.0}) {
    const PlasticSolution first = whole->press(part * kForce), second = resumed->press(part * kForce);
    EXPECT_EQ(first.contact.approach, second.contact.approach);
    EXPECT_EQ(first.iterations, second.iterations);
    EXPECT_EQ(resumed->pressure(), whole->pressure());
    EXPECT_EQ(resumed->present, whole->present);
  }
}

TEST(ElasticPlastic, stopped_by_its_observer_is_as_before) {
  const auto whole = indentation(lower(kSteel)), stopped = indentation(lower(kSteel));
  whole->press(0.5 * kForce);
  stopped->press(0.5 * kForce);
  const contact::Load load{contact::Drive::force, kForce / (kModulus * whole->grid.cell_area())};
  int calls = 0;
  EXPECT_THROW(stopped->loop.advance(load, [&](const contact::Report&) { return ++calls < 12; }), Error);
  EXPECT_EQ(stopped->pressure(), whole->pressure());
  EXPECT_EQ(stopped->present, whole->present);
  whole->press(kForce);
  stopped->press(kForce);
  EXPECT_EQ(stopped->pressure(), whole->pressure());
}

TEST(ElasticPlastic, refuses_plastic_strain_in_the_last_layer) {
  Indentation shallow(lower(kSteel), kModulus, kNodes, kSpacing, {3, 0.5e-6});
  try {
    shallow.press(kForce);
    FAIL() << "nothing was said";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_scene);
  }
  EXPECT_EQ(shallow.peak(), 0);
}

// The von Mises stress under a sphere is 0.52 of the Hertz pressure at 0.8 µm, the first box's depth, and largest,
// 0.62, at 1.7 µm: a yield stress of 0.6 is exceeded where there is no box yet.
TEST(ElasticPlastic, finds_yielding_below_the_box) {
  const double radius = std::cbrt(0.75 * kForce * 105e-6 / kModulus);
  const double hertz = 1.5 * kForce / (std::numbers::pi * radius * radius);
  Indentation pressed(lower(PerfectPlasticity{0.6 * hertz}), kModulus, kNodes, kSpacing, {40, 0.1e-6});
  const PlasticSolution solution = pressed.press(kForce);
  EXPECT_TRUE(solution.converged);
  const PlasticBody& body = *pressed.loop.body(0);
  EXPECT_GT(body.largest().cuboids, 0);
  EXPECT_GT(body.largest().at[2], 0.8e-6);
  EXPECT_GT(static_cast<double>(body.region().box.nz) * 0.1e-6, 2e-6);
}

TEST(ElasticPlastic, takes_depths_that_yield_earlier) {
  Pair soft = lower(kSteel);
  soft.material[0]->hardening.depth_factor = {{2e-6, 1}, {3e-6, 0.5}, {4e-6, 0.5}, {5e-6, 1}};
  const auto layered = indentation(soft), uniform = indentation(lower(kSteel));
  ASSERT_TRUE(layered->press(0.5 * kForce).converged);
  ASSERT_TRUE(uniform->press(0.5 * kForce).converged);
  EXPECT_GT(layered->loop.body(0)->largest().value, 1.2 * uniform->loop.body(0)->largest().value);
  EXPECT_GT(layered->loop.body(0)->largest().at[2], uniform->loop.body(0)->largest().at[2]);
}

TEST(ElasticPlastic, takes_laws_without_a_yield_stress_and_without_hardening) {
  for (const HardeningLaw& law :
       {HardeningLaw(RambergOsgood{4320e6, 12.6, 0}), HardeningLaw(PerfectPlasticity{2e9})}) {
    const auto pressed = indentation(lower(law));
    for (const double part : {0.5, 1.0, 0.0}) {
      const PlasticSolution solution = pressed->press(part * kForce);
      EXPECT_TRUE(solution.converged);
      EXPECT_EQ(solution.substeps, 1);
      EXPECT_GE(solution.dissipation, 0);
    }
    EXPECT_GT(pressed->loop.body(0)->largest().value, 1e-3);
  }
}

TEST(ElasticPlastic, goes_in_smaller_steps_where_a_step_does_not_converge) {
  const auto pressed = indentation(lower(PerfectPlasticity{1.2e9}), 1e-7);
  const PlasticSolution solution = pressed->press(1.5 * kForce);
  EXPECT_TRUE(solution.converged);
  EXPECT_GT(solution.substeps, 1);
  EXPECT_LE(solution.yield, 1e-7);
}

}  // namespace
}  // namespace brinell::plastic
