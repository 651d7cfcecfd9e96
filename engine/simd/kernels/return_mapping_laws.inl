// The scalar equation of the radial return, for each form of hardening and many points at a time:
//
//   f Y(p + flow) + 3 mu flow = q        q von Mises stress of the trial, p plastic strain before, flow >= 0
//
// It is solved for the stress, not for the plastic strain increment, wherever the law can be steep: for the power law
// in w = offset + scale·p, where a w + b w^n = q + a w(p) with a = 3 mu/scale, b = f·coefficient. The logarithm of
// the left side over ln w is convex with slopes between n and 1, so that Newton's method there converges from any
// start, and from the right monotonely, also for offset = 0, where the slope of Y is infinite. Starting values come
// from that iteration in single precision; one step of third order (Chebyshev 1838) in double on the original
// equation follows. Points that are not there yet take further steps and do not touch the others' results.
#pragma once

#include <cmath>

#include "simd/kernels/vector_math.inl"
#include "simd/return_mapping_kernels.h"

namespace brinell::simd {
namespace {

constexpr std::size_t kReturnGroup = 16;  // the most lanes of any register: loops over whole groups have no tail

/// A stress this close above the yield stress lies on it: a mapped stress stays as it is when it is mapped again.
constexpr double kOnYield = 1.0 + 0x1p-46;
constexpr double kRounding = 0x1p-52;

/// Points of one block that may yield, one behind the other up to a whole number of groups.
struct Candidates {
  double trial[kReturnBlock];   // q
  double strain[kReturnBlock];  // p
  double factor[kReturnBlock];  // f
  double flow[kReturnBlock];    // results: the increment of p, 0 where the point does not yield,
  double stress[kReturnBlock];  // the von Mises stress then,
  double slope[kReturnBlock];   // and f dY/dp there, if it is wanted
};

/// Short loops over arrays of a block, one after the other: an iteration of a long one has so many instructions that
/// the processor sees no second one, and waits for the results of the first.
struct PowerWork {
  double before[kReturnBlock];   // w of the old plastic strain
  double w[kReturnBlock];        // its estimate
  double settled[kReturnBlock];  // 1: flow and stress are final; else 0
  double rising[kReturnBlock];   // 1: on the power law; 0: on the plateau before it, or elastic
  double logarithm[kReturnBlock];
  // Starting values, first a/total, b/total and the two terms of the left side at `before` over total, total being
  // the right side; then the binary logarithms of the first two, and that of w.
  float along[kReturnBlock], across[kReturnBlock];
  float along_before[kReturnBlock], across_before[kReturnBlock];
  float first[kReturnBlock];
};

inline __attribute__((always_inline)) float in_single(double x) {
  const float rounded = static_cast<float>(x), above = rounded > 1e-30f ? rounded : 1e-30f;
  return above < 1e30f ? above : 1e30f;
}

inline void begin_power(std::size_t m, const HardeningCurve& curve, double stiffness, Candidates& __restrict points,
                        PowerWork& __restrict work) {
  const double a = stiffness / curve.scale, n = curve.exponent;
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    work.before[i] = curve.offset + curve.scale * points.strain[i];
    work.logarithm[i] = n * log_of(work.before[i]);
  }
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    work.w[i] = points.factor[i] * curve.coefficient * exp_of(work.logarithm[i]);
  }
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double q = points.trial[i], power = work.w[i];
    const double onset = points.factor[i] * curve.onset;
    const double yield = power > onset ? power : onset;
    points.flow[i] = 0.0;
    points.stress[i] = q;
    work.rising[i] = 0.0;
    work.settled[i] = q > yield * kOnYield ? 0.0 : 1.0;
    const double along = a * work.before[i], inverse_total = 1.0 / (q + along);
    work.along[i] = in_single(a * inverse_total);
    work.across[i] = in_single(points.factor[i] * curve.coefficient * inverse_total);
    work.along_before[i] = in_single(along * inverse_total);
    work.across_before[i] = in_single(power * inverse_total);
    work.first[i] = in_single(work.before[i]);
  }
}

/// Newton's method for log2(x + y) = 0, x = 2^(log2 along + t) and y = 2^(log2 across + n t), t = log2 w, begun from
/// the nearer of two upper bounds. Its logarithm is replaced by the first term of its series in (v − 1)/(v + 1),
/// which is never larger: steps only get smaller where they were long.
inline void start_power(std::size_t m, const HardeningCurve& curve, PowerWork& __restrict work) {
  constexpr int kSteps = 4;
  const float n = static_cast<float>(curve.exponent);
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const float before = work.first[i], x = work.along_before[i], y = work.across_before[i], left = x + y;
    const float log_along = log2_of(work.along[i]);
    const float from_left = log2_of(before) - log2_of(left) * left / (x + n * y);
    const float nearer = from_left < -log_along ? from_left : -log_along;
    work.first[i] = before > 1e-29f ? nearer : -log_along;
    work.along[i] = log_along;
  }
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) work.across[i] = log2_of(work.across[i]);
  for (int step = 0; step < kSteps; ++step) {
#pragma omp simd
    for (std::size_t i = 0; i < m; ++i) {
      const float t = work.first[i];
      const float x = exp2_of(work.along[i] + t), y = exp2_of(work.across[i] + n * t), v = x + y;
      work.first[i] = t - 2.88539008f * (v - 1.0f) * v / ((v + 1.0f) * (x + n * y));
    }
  }
}

/// One step of third order from w, and the results if that is enough. Returns how many points are not settled.
inline double settle_power(std::size_t m, const HardeningCurve& curve, double stiffness,
                           Candidates& __restrict points, PowerWork& __restrict work) {
  constexpr double kNear = 1.5e-5;  // a step relative to w whose cube is below a rounding
  const double n = curve.exponent, inverse_scale = 1.0 / curve.scale, inverse_stiffness = 1.0 / stiffness;
  double pending = 0;
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double guess = (work.w[i] - work.before[i]) * inverse_scale;
    work.logarithm[i] = n * log_of(work.before[i] + curve.scale * guess);
  }
#pragma omp simd reduction(+ : pending)
  for (std::size_t i = 0; i < m; ++i) {
    const double q = points.trial[i], before = work.before[i];
    const double guess = (work.w[i] - before) * inverse_scale;
    const double w = before + curve.scale * guess;
    const double exponent = work.logarithm[i];
    const double y = points.factor[i] * curve.coefficient * exp_of(exponent);
    const double excess = stiffness * guess + (y - q);
    // Relative to w, so that its inverse, which may overflow, is not needed.
    const double inverse = 1.0 / (stiffness * inverse_scale * w + n * y);
    const double newton = -excess * inverse;
    const double third = newton * (1.0 - 0.5 * newton * (n - 1.0) * n * y * inverse);
    const double near = std::fabs(third) <= kNear ? 1.0 : 0.0;
    const double noise = (8.0 + std::fabs(exponent)) * kRounding * q;
    const double exact = std::fabs(excess) <= noise ? 1.0 : 0.0;
    const double ratio = near * third;
    const double sum = guess + ratio * w * inverse_scale;
    const double grown =
        y * (1.0 + n * ratio * (1.0 + (n - 1.0) * ratio * (1.0 / 2) * (1.0 + (n - 2.0) * ratio * (1.0 / 3))));
    const double onset = points.factor[i] * curve.onset;
    const double rising = grown >= onset ? 1.0 : 0.0;
    const double flow = rising != 0 ? (sum > 0 ? sum : 0.0) : (q - onset) * inverse_stiffness;
    const double stress = rising != 0 ? grown : onset;
    const double settled = work.settled[i];
    work.w[i] = settled != 0 ? work.w[i] : w + ratio * w;
    work.rising[i] = settled != 0 ? work.rising[i] : rising;
    points.flow[i] = settled != 0 ? points.flow[i] : flow;
    points.stress[i] = settled != 0 ? points.stress[i] : stress;
    const double now = near + exact + settled > 0 ? 1.0 : 0.0;
    work.settled[i] = now;
    pending += 1.0 - now;
  }
  return pending;
}

/// One step of Newton's method for the logarithms, in double.
inline void advance_power(std::size_t m, const HardeningCurve& curve, double stiffness,
                          const Candidates& __restrict points, PowerWork& __restrict work) {
  const double a = stiffness / curve.scale, n = curve.exponent;
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double w = work.w[i], before = work.before[i];
    const double total = points.trial[i] + a * before;
    const double y = points.factor[i] * curve.coefficient * exp_of(n * log_of(w));
    const double left = a * w + y;
    const double step = log_of(left / total) * left / (a * w + n * y);
    const double moved = w * exp_of(-step);
    const double above = moved > before ? moved : before;
    const double upper = total / a;
    const double next = above < upper ? above : upper;
    work.w[i] = work.settled[i] != 0 ? w : next;
  }
}

inline void solve_power(std::size_t m, const HardeningCurve& curve, double stiffness, bool wants_slope,
                        Candidates& points) {
  constexpr int kRounds = 100;  // Newton's logarithmic steps shrink w at least e times each, to a rounding of it
  PowerWork work;
  begin_power(m, curve, stiffness, points, work);
  start_power(m, curve, work);
  const double inverse_a = curve.scale / stiffness;
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double start = static_cast<double>(exp2_of(work.first[i])), before = work.before[i];
    const double above = start > before ? start : before;
    const double upper = before + points.trial[i] * inverse_a;
    work.w[i] = above < upper ? above : upper;
  }
  for (int round = 0; settle_power(m, curve, stiffness, points, work) > 0 && round < kRounds; ++round) {
    advance_power(m, curve, stiffness, points, work);
  }
  if (!wants_slope) return;
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    points.slope[i] = work.rising[i] * curve.exponent * points.stress[i] * curve.scale / work.w[i];
  }
}

inline void solve_linear(std::size_t m, const HardeningCurve& curve, double stiffness,
                         Candidates& __restrict points) {
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double q = points.trial[i], factor = points.factor[i], before = points.strain[i];
    const double yield = factor * (curve.initial + curve.modulus * before);
    const double slope = factor * curve.modulus;
    const double flow = (q - yield) / (stiffness + slope);
    const bool yields = q > yield * kOnYield;
    points.flow[i] = yields ? flow : 0.0;
    points.stress[i] = yields ? factor * (curve.initial + curve.modulus * (before + flow)) : q;
    points.slope[i] = yields ? slope : 0.0;
  }
}

/// In x = rate·flow: left (1 − exp(−x)) + b x = g with left, the hardening that is left, b = 3 mu/rate, and g the
/// stress above yield. The left side is concave, and Newton's method from a lower bound on x monotone.
inline void solve_voce(std::size_t m, const HardeningCurve& curve, double stiffness, Candidates& __restrict points) {
  constexpr int kRounds = 100;      // each step adds at least one to x while the exponential matters
  constexpr double kNear = 1.0e-8;  // a step whose square is below a rounding
  const double b = stiffness / curve.rate, inverse_rate = 1.0 / curve.rate;
  double left[kReturnBlock], above[kReturnBlock], x[kReturnBlock], settled[kReturnBlock];
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const double exponent = -curve.rate * points.strain[i];
    const double yield = points.factor[i] * (curve.initial - curve.amplitude * expm1_of(exponent));
    const double g = points.trial[i] - yield;
    left[i] = points.factor[i] * curve.amplitude * exp_of(exponent);
    above[i] = g;
    settled[i] = points.trial[i] > yield * kOnYield ? 0.0 : 1.0;
    const double tangent = g / (left[i] + b), saturated = (g - left[i]) / b;
    const double start = tangent > saturated ? tangent : saturated;
    x[i] = settled[i] != 0 ? 0.0 : start;
  }
  double pending = 1;
  for (int round = 0; pending > 0 && round < kRounds; ++round) {
    pending = 0;
#pragma omp simd reduction(+ : pending)
    for (std::size_t i = 0; i < m; ++i) {
      const double rest = expm1_of(-x[i]);
      const double step = (above[i] + left[i] * rest - b * x[i]) / (left[i] * (1.0 + rest) + b);
      const double small = std::fabs(step) <= kNear * x[i] ? 1.0 : 0.0;
      x[i] = settled[i] != 0 ? x[i] : x[i] + step;
      settled[i] = small + settled[i] > 0 ? 1.0 : 0.0;
      pending += 1.0 - settled[i];
    }
  }
#pragma omp simd
  for (std::size_t i = 0; i < m; ++i) {
    const bool yields = x[i] > 0;
    const double flow = x[i] * inverse_rate;
    const double exponent = -curve.rate * (points.strain[i] + flow);
    const double stress = points.factor[i] * (curve.initial - curve.amplitude * expm1_of(exponent));
    points.flow[i] = yields ? flow : 0.0;
    points.stress[i] = yields ? stress : points.trial[i];
    points.slope[i] = yields ? points.factor[i] * curve.amplitude * curve.rate * exp_of(exponent) : 0.0;
  }
}

/// The last point of the table whose strain is not above p.
inline std::size_t table_interval(const HardeningCurve& curve, double p) {
  std::size_t low = 0, high = curve.count;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (curve.strain[middle] <= p ? low : high) = middle;
  }
  return low;
}

struct TableValue {
  double stress, slope;
};

inline TableValue table_value(const HardeningCurve& curve, std::size_t k, double p) {
  if (k + 1 >= curve.count) return {curve.stress[curve.count - 1], 0.0};
  const double width = curve.strain[k + 1] - curve.strain[k], chord = (curve.stress[k + 1] - curve.stress[k]) / width;
  const double u = (p - curve.strain[k]) / width, first = curve.slope[k];
  const double second = 3 * chord - 2 * first - curve.slope[k + 1], third = first + curve.slope[k + 1] - 2 * chord;
  return {curve.stress[k] + width * u * (first + u * (second + u * third)), first + u * (2 * second + 3 * u * third)};
}

/// Point by point: the interval by bisection, then Newton's method, which may not leave it.
inline void solve_table(std::size_t m, const HardeningCurve& curve, double stiffness, Candidates& points) {
  constexpr int kRounds = 200;
  for (std::size_t i = 0; i < m; ++i) {
    const double q = points.trial[i], factor = points.factor[i], before = points.strain[i];
    std::size_t k = table_interval(curve, before);
    const double yield = factor * table_value(curve, k, before).stress;
    points.flow[i] = 0.0;
    points.stress[i] = q;
    points.slope[i] = 0.0;
    if (!(q > yield * kOnYield)) continue;
    for (std::size_t high = curve.count; high - k > 1;) {
      const std::size_t middle = k + (high - k) / 2;
      const bool below = factor * curve.stress[middle] + stiffness * (curve.strain[middle] - before) <= q;
      (below ? k : high) = middle;
    }
    const double begin = curve.strain[k] - before, most = (q - yield) / stiffness;
    double low = begin > 0 ? begin : 0.0, high = most;
    if (k + 1 < curve.count && curve.strain[k + 1] - before < most) high = curve.strain[k + 1] - before;
    double flow = low;
    for (int round = 0; round < kRounds; ++round) {
      const TableValue at = table_value(curve, k, before + flow);
      const double excess = factor * at.stress + stiffness * flow - q;
      (excess > 0 ? high : low) = flow;
      const double newton = flow - excess / (stiffness + factor * at.slope);
      const double next = newton >= low && newton <= high ? newton : 0.5 * (low + high);
      const bool settled = std::fabs(next - flow) <= kRounding * next;
      flow = next;
      if (settled) break;
    }
    const TableValue at = table_value(curve, table_interval(curve, before + flow), before + flow);
    points.flow[i] = flow;
    points.stress[i] = factor * at.stress;
    points.slope[i] = factor * at.slope;
  }
}

}  // namespace
}  // namespace brinell::simd
