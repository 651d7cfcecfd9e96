#include "plastic/flow_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "parallel/arena.h"
#include "plastic/return_mapping.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {
namespace {

constexpr double kShear = 80e9;  // [Pa]
constexpr double kYield = 800e6;

double contracted(const PointTensor& a, const PointTensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

double von_mises(const PointTensor& deviator) {
  return std::sqrt(1.5 * contracted(deviator, deviator));
}

/// A point that is strained: its deviators of stress and of the strain that goes on.
struct Point {
  explicit Point(const HardeningLaw& hardening) : law({hardening, {}}) {}

  /// Solves one increment; second_order: false for the radial return.
  void strain(const PointTensor& change, bool second_order = true) {
    PointFlow flow;
    flow.stress_before = stress;
    flow.shear_modulus = kShear;
    flow.yield_stress = law.yield_stress(p);
    for (std::size_t c = 0; c < 6; ++c) flow.trial[c] = stress[c] + 2 * kShear * change[c];
    EarlyFlow early;
    PointTensor late{};
    double after = p;
    for (int iteration = 0; iteration < 200; ++iteration) {
      PointTensor trial = flow.trial;
      for (std::size_t c = 0; c < 6; ++c) trial[c] -= 2 * kShear * early.strain[c];
      const double before = p + early.equivalent;
      TrialState state;
      MappedState mapped;
      state.count = 1;
      for (std::size_t c = 0; c < 6; ++c) {
        state.trial[c] = &trial[c];
        mapped.increment[c] = &late[c];
      }
      state.plastic_strain = &before;
      mapped.plastic_strain = &after;
      map_to_yield(arena, simd::best_kernels(), law, kShear, state, mapped);
      PointTensor next{};
      double moved = 0;
      for (std::size_t c = 0; c < 6; ++c) {
        next[c] = early.strain[c] + late[c];
        moved = std::max(moved, std::fabs(next[c] - flow.increment[c]));
      }
      flow.increment = next;
      if (!second_order || moved < 1e-17) break;
      early = early_flow(flow);
    }
    FlowEnds ends;
    ends.before = stress;
    for (std::size_t c = 0; c < 6; ++c) stress[c] = flow.trial[c] - 2 * kShear * flow.increment[c];
    dissipation += 0.5 * (law.yield_stress(p) + law.yield_stress(after)) * (after - p);
    if (after > p) {
      ends.after = stress;
      ends.early = early.strain;
      ends.late = late;
      ends.yield_before = flow.yield_stress;
      ends.yield_after = law.yield_stress(after);
      ends.shear_modulus = kShear;
      worst_estimate = std::max(worst_estimate, flow_error(ends));
    }
    p = after;
  }

  parallel::Arena arena{1};
  YieldCurve law;
  PointTensor stress{};
  double p = 0;
  double dissipation = 0, worst_estimate = 0;
};

/// Two deviators of von Mises norm 1 at right angles.
const PointTensor kTension{2.0 / 3, -1.0 / 3, -1.0 / 3, 0, 0, 0};
const PointTensor kTorsion{0, 0, 0, 0, 0, 1 / std::sqrt(3.0)};

PointTensor at_angle(double angle, double size) {
  PointTensor result{};
  for (std::size_t c = 0; c < 6; ++c)
    result[c] = size * (std::cos(angle) * kTension[c] + std::sin(angle) * kTorsion[c]);
  return result;
}

double distance(const PointTensor& a, const PointTensor& b) {
  PointTensor difference{};
  for (std::size_t c = 0; c < 6; ++c) difference[c] = a[c] - b[c];
  return von_mises(difference);
}

// Strained on along kTension by x·σ_y/(2 mu), a stress on the yield surface at the angle a turns to (R. D. Krieg & D.
// B. Krieg, J. Pressure Vessel Technol. 99, 1977, 510-515; perfect plasticity)
//   tan(a'/2) = tan(a/2) exp(−x).
PointTensor turned(double angle, double x) {
  return at_angle(2 * std::atan(std::tan(angle / 2) * std::exp(-x)), kYield);
}

struct Turn {
  double error;     // of the stress / yield stress
  double estimate;  // largest
};

/// A stress at the angle, of a part of the yield stress, is strained on by x in n increments.
Turn turn(double angle, double part, double x, int n, bool second_order) {
  Point point(PerfectPlasticity{kYield});
  point.stress = at_angle(angle, part * kYield);
  for (int k = 0; k < n; ++k) point.strain(at_angle(0, x * kYield / (2 * kShear) / n), second_order);
  // The elastic way to the yield surface along kTension, then the rest.
  const double cosine = std::cos(angle),
               elastic = -part * cosine + std::sqrt(1 + part * part * (cosine * cosine - 1));
  const double reached = std::atan2(part * std::sin(angle), part * cosine + elastic);
  return {distance(point.stress, turned(reached, x - elastic)) / kYield, point.worst_estimate};
}

TEST(FlowPath, is_of_second_order) {
  for (const double angle : {0.5, 1.2, 2.0}) {
    // The error changes its sign between few and more increments; beyond, 16 at second order, 4 at first.
    EXPECT_GT(turn(angle, 1, 2, 16, true).error / turn(angle, 1, 2, 64, true).error, 11) << angle;
    EXPECT_LT(turn(angle, 1, 2, 16, false).error / turn(angle, 1, 2, 64, false).error, 4.5) << "radial return";
    for (const int n : {1, 2, 4, 8, 16}) {
      EXPECT_LT(turn(angle, 1, 2, n, true).error, 0.3 / n * turn(angle, 1, 2, n, false).error) << angle << " " << n;
    }
  }
}

TEST(FlowPath, finds_where_flow_begins) {
  for (const double angle : {0.5, 1.2}) {
    // The elastic share of the increment in which flow begins differs; 64 at second order, 8 at first.
    EXPECT_GT(turn(angle, 0.6, 3, 16, true).error / turn(angle, 0.6, 3, 128, true).error, 15) << angle;
    EXPECT_LT(turn(angle, 0.6, 3, 8, true).error, 0.01 * turn(angle, 0.6, 3, 8, false).error) << angle;
  }
}

TEST(FlowPath, estimate_bounds_the_error_of_the_history) {
  for (const double angle : {0.5, 1.2, 2.0}) {
    for (const int n : {1, 2, 4, 8, 16, 32}) {
      const Turn one = turn(angle, 1, 2, n, true), twice = turn(angle, 1, 2, 2 * n, true);
      EXPECT_GT(one.estimate, one.error) << angle << " " << n;
      // 2 at first order, 4 at second.
      EXPECT_GT(one.estimate / twice.estimate, n < 4 ? 1.2 : 2.8) << angle << " " << n;
    }
  }
}

TEST(FlowPath, does_not_overshoot_in_large_increments) {
  for (const double x : {3.0, 10.0, 100.0, 1e4}) {
    Point point(PerfectPlasticity{kYield});
    point.stress = at_angle(1.5, kYield);
    point.strain(at_angle(0, x * kYield / (2 * kShear)));
    const double along = contracted(point.stress, kTension), across = contracted(point.stress, kTorsion);
    EXPECT_GT(along, 0) << x;
    EXPECT_GE(across, 0) << x;
    EXPECT_NEAR(von_mises(point.stress), kYield, 1e-12 * kYield);
    EXPECT_LT(turn(1.5, 1, x, 1, true).error, turn(1.5, 1, x, 1, false).error + 1e-12) << x;
  }
}

TEST(FlowPath, is_exact_where_the_direction_does_not_turn) {
  Point once(Swift{1240e6, 30, 0.085, 1e6}), often(Swift{1240e6, 30, 0.085, 1e6});
  const double whole = 0.02;
  once.strain(at_angle(0.7, whole));
  EXPECT_GT(once.worst_estimate, 0) << "the way to where flow begins may have been bent";
  for (int k = 0; k < 16; ++k) {
    often.strain(at_angle(0.7, whole / 16));
    if (k == 8) {
      ASSERT_GT(often.p, 0);
      often.worst_estimate = 0;
    }
  }
  // The return leaves 1e-15 of the stress in each increment.
  EXPECT_NEAR(once.p, often.p, 1e-12 * often.p);
  EXPECT_LE(distance(once.stress, often.stress), 1e-12 * von_mises(often.stress));
  // The direction is that of rounded sums; 3 mu p/σ_y is below 2.
  EXPECT_LE(often.worst_estimate, 1e-9);
}

TEST(FlowPath, goes_round_without_giving_work_back) {
  Point point(LinearHardening{500e6, 2e9});
  double last = 0;
  for (int k = 0; k < 200; ++k) {
    const double p = point.p;
    point.strain(at_angle(0.4 * k, 3e-3));
    EXPECT_GE(point.p, p);
    EXPECT_GE(point.dissipation, last);
    EXPECT_LE(von_mises(point.stress), (1 + 1e-12) * point.law.yield_stress(point.p));
    last = point.dissipation;
  }
}

TEST(FlowPath, nothing_is_early_within_the_yield_surface) {
  PointFlow flow;
  flow.shear_modulus = kShear;
  flow.yield_stress = kYield;
  flow.increment = at_angle(0, 1e-3);
  flow.trial = at_angle(0, 0.99 * kYield);
  EXPECT_EQ(early_flow(flow).equivalent, 0);
  flow.trial = at_angle(0, 1.01 * kYield);
  EXPECT_GT(early_flow(flow).equivalent, 0);
  EXPECT_LE(early_flow(flow).equivalent, 0.5 * 0.01 * kYield / (3 * kShear) * (1 + 1e-12))
      << "no more than the excess";
  flow.stress_before = at_angle(3, kYield);
  flow.increment = {};
  EXPECT_EQ(early_flow(flow).equivalent, 0);
}

}  // namespace
}  // namespace brinell::plastic
