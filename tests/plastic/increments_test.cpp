// The size of increments: order, what their estimate says, and steering by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/error.h"
#include "plastic/flow_path.h"
#include "plastic/indentation.h"

namespace brinell::plastic {
namespace {

/// Loads to kForce in equal increments; the largest estimate.
double load(Indentation& pressed, int increments, double from = 0) {
  double estimate = 0;
  for (int k = 1; k <= increments; ++k) {
    const PlasticSolution solution = pressed.press((from + (1 - from) * k / increments) * kForce);
    EXPECT_TRUE(solution.converged);
    EXPECT_GE(solution.dissipation, 0);
    estimate = std::max(estimate, solution.increment_error);
  }
  return estimate;
}

/// Plastic strain of every cuboid of the whole grid.
std::vector<PointTensor> strains(const Indentation& pressed) {
  const PlasticBody& body = *pressed.loop.body(0);
  const Region& region = body.region();
  std::vector<PointTensor> all(static_cast<std::size_t>(kNodes * kNodes * kLayers.count));
  for (std::size_t n = 0; n < region.box.cuboids(); ++n) {
    const auto at = static_cast<std::int64_t>(n);
    const std::int64_t i = region.i0 + at % region.box.nx, j = region.j0 + at / region.box.nx % region.box.ny;
    const std::int64_t k = at / (region.box.nx * region.box.ny);
    for (std::size_t c = 0; c < 6; ++c) {
      all[static_cast<std::size_t>((k * kNodes + j) * kNodes + i)][c] = body.strain()[c][n];
    }
  }
  return all;
}

/// As the estimate measures it: what the difference of the plastic strains makes of stress / yield stress, root mean
/// square over what has flowed.
double difference(const Indentation& pressed, const Indentation& reference) {
  const double thrice_mu = 3 * kYoung / (2 * (1 + kPoisson));
  const std::vector<PointTensor> a = strains(pressed), b = strains(reference);
  const YieldCurve& law = reference.loop.body(0)->law();
  double squares = 0, count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    PointTensor wrong{};
    for (std::size_t c = 0; c < 6; ++c) wrong[c] = a[n][c] - b[n][c];
    const double flowed = equivalent_strain(b[n]);
    if (flowed == 0 && equivalent_strain(wrong) == 0) continue;
    const double stress = thrice_mu * equivalent_strain(wrong) / law.yield_stress(flowed);
    squares += stress * stress;
    count += 1;
  }
  return std::sqrt(squares / count);
}

/// Its own error is (12/32)² of the least that is compared with it.
const Indentation& fine() {
  static const std::unique_ptr<Indentation> pressed = [] {
    auto reference = indentation(lower(kSteel), 1e-8);
    load(*reference, 32);
    return reference;
  }();
  return *pressed;
}

TEST(Increments, are_of_second_order_and_their_estimate_tells_the_error) {
  const Indentation& reference = fine();
  double last = 0;
  for (const int increments : {1, 3, 6, 12}) {
    const auto pressed = indentation(lower(kSteel), 1e-8);
    const double estimate = load(*pressed, increments), error = difference(*pressed, reference);
    EXPECT_GT(estimate, 0.5 * error) << increments;
    EXPECT_LT(estimate, 20 * error) << increments;
    if (increments > 1) {
      EXPECT_LT(relative(pressed->peak(), reference.peak()), estimate) << increments;
    }
    // 2 at first order, 4 at second.
    if (increments > 3) {
      EXPECT_GT(last / error, 2.8) << increments;
    }
    last = error;
  }
}

TEST(Increments, are_divided_until_the_estimate_is_small_enough) {
  const Indentation& reference = fine();
  double last = 1;
  for (const double tolerance : {5e-3, 1e-3}) {
    const auto pressed = indentation(lower(kSteel), 1e-7, 1, tolerance);
    const PlasticSolution solution = pressed->press(kForce);
    EXPECT_TRUE(solution.converged);
    EXPECT_GT(solution.substeps, 1);
    EXPECT_LE(solution.increment_error, tolerance);
    EXPECT_LE(solution.yield, 1e-7);
    const double error = difference(*pressed, reference);
    EXPECT_LT(error, tolerance);
    EXPECT_LT(error, 0.5 * last) << "five times less was asked for";
    last = error;
    // What is elastic is solved at once, with one contact.
    const PlasticSolution apart = pressed->press(0);
    EXPECT_EQ(apart.substeps, 1);
    EXPECT_EQ(apart.iterations, 1);
    EXPECT_EQ(apart.increment_error, 0);
    EXPECT_EQ(apart.dissipation, 0);
  }
}

TEST(Increments, of_two_bodies_are_divided_alike) {
  Pair two = lower(kSteel), one = two;
  two.material[1] = two.material[0];
  one.identical = true;
  Indentation of_two(two, kModulus / 2, 20, 0.6e-6, {14, 0.6e-6}, 1e-7, 1, 5e-3);
  Indentation of_one(one, kModulus / 2, 20, 0.6e-6, {14, 0.6e-6}, 1e-7, 1, 5e-3);
  const PlasticSolution first = of_two.press(0.12), second = of_one.press(0.12);
  EXPECT_EQ(first.substeps, second.substeps);
  EXPECT_LE(first.increment_error, 5e-3);
  // Both within 1e-7 of the yield condition, which the estimate takes from its flow of 1e-2.
  EXPECT_NEAR(first.increment_error, second.increment_error, 1e-4 * second.increment_error);
}

TEST(Increments, that_are_divided_go_on_from_a_saved_state_with_the_same_bits) {
  const auto whole = indentation(lower(kSteel), 1e-7, 1, 5e-3), resumed = indentation(lower(kSteel), 1e-7, 1, 5e-3);
  whole->press(0.6 * kForce);
  resumed->loop.restore(whole->loop.state());
  for (const double part : {1.0, 0.5, 1.1}) {
    const PlasticSolution first = whole->press(part * kForce), second = resumed->press(part * kForce);
    EXPECT_EQ(first.substeps, second.substeps);
    EXPECT_EQ(first.increment_error, second.increment_error);
    EXPECT_EQ(first.contact.approach, second.contact.approach);
    EXPECT_EQ(resumed->pressure(), whole->pressure());
    EXPECT_EQ(resumed->present, whole->present);
  }
}

TEST(Increments, that_are_stopped_between_their_parts_are_as_before) {
  const auto whole = indentation(lower(kSteel), 1e-7, 1, 5e-3), stopped = indentation(lower(kSteel), 1e-7, 1, 5e-3);
  whole->press(0.5 * kForce);
  stopped->press(0.5 * kForce);
  const std::vector<double> pressure = whole->pressure(), present = whole->present;
  const contact::Load load{contact::Drive::force, kForce / (kModulus * whole->grid.cell_area())};
  int all = 0, calls = 0;
  EXPECT_GT(whole->loop.advance(load, [&](const contact::Report&) { return ++all > 0; }).substeps, 1);
  const auto most = [&](const contact::Report&) { return ++calls < 9 * all / 10; };
  EXPECT_THROW(stopped->loop.advance(load, most), Error);
  EXPECT_EQ(stopped->pressure(), pressure);
  EXPECT_EQ(stopped->present, present);
  stopped->press(kForce);
  EXPECT_EQ(stopped->pressure(), whole->pressure());
}

TEST(Increments, of_cycles_shake_down) {
  const auto pressed = indentation(lower(PerfectPlasticity{1.7e9}), 1e-7);
  std::vector<double> work;
  for (int cycle = 0; cycle < 4; ++cycle) {
    double dissipated = 0;
    for (const double part : {0.5, 1.0, 0.4, 0.0}) {
      const PlasticSolution solution = pressed->press(part * kForce);
      EXPECT_TRUE(solution.converged);
      EXPECT_GE(solution.dissipation, 0);
      dissipated += solution.dissipation;
    }
    work.push_back(dissipated);
  }
  EXPECT_LE(work[1], 0.1 * work[0]);
  for (std::size_t cycle = 1; cycle < work.size(); ++cycle) EXPECT_LE(work[cycle], work[cycle - 1]);
}

}  // namespace
}  // namespace brinell::plastic
