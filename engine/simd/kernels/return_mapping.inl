// Radial return in blocks. A block is measured first; if no point can yield, because no von Mises stress is above the
// yield stress at zero plastic strain, its increments are zero and no more is done. Else the points that can are
// moved together, solved in whole registers (return_mapping_laws.inl), and moved back. Every point goes through the
// same instructions wherever it stands, the last ones in a block of their own filled up with zeros.
#pragma once

#include <cmath>
#include <cstring>

#include "simd/kernels/return_mapping_laws.inl"
#include "simd/return_mapping_kernels.h"

namespace brinell::simd {
namespace {

constexpr double kMostSquare = 1e300;  // of the von Mises stress; and the largest plastic strain

struct Measured {
  double square[kReturnBlock];  // of the von Mises stress
  double above[kReturnBlock];   // square less that of the yield stress at zero plastic strain
  double most = 0;              // largest `above`
  double total = 0;             // of squares and plastic strains: NaN or infinite if any of them is
  double least = 0;             // plastic strain
};

inline void measure(const ReturnPoints& points, double initial, Measured& __restrict measured) {
  const double *xx = points.trial[0], *yy = points.trial[1], *zz = points.trial[2];
  const double *yz = points.trial[3], *xz = points.trial[4], *xy = points.trial[5];
  const double *factor = points.factor, *strain = points.plastic_strain;
  double most = 0, total = 0, least = 0;
#pragma omp simd reduction(max : most) reduction(+ : total) reduction(min : least)
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    const double a = xx[i] - yy[i], b = yy[i] - zz[i], c = zz[i] - xx[i];
    const double shear = yz[i] * yz[i] + xz[i] * xz[i] + xy[i] * xy[i];
    const double square = 0.5 * (a * a + b * b + c * c) + 3 * shear;
    const double limit = factor[i] * initial;
    const double above = square - limit * limit;
    measured.square[i] = square;
    measured.above[i] = above;
    most = above > most ? above : most;
    total += square + strain[i];
    least = strain[i] < least ? strain[i] : least;
  }
  measured.most = most;
  measured.total = total;
  measured.least = least;
}

/// The first point that is out of range, else kReturnBlock.
inline std::size_t first_refused(const ReturnPoints& points, const Measured& measured) {
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    const double p = points.plastic_strain[i];
    if (!(measured.square[i] <= kMostSquare && p >= 0 && p <= kMostSquare)) return i;
  }
  return kReturnBlock;
}

/// Moves the points that may yield together, in their order, and fills them up to a whole number of groups, which is
/// returned. place: where each stood; count: how many they are.
inline std::size_t collect(const ReturnPoints& points, const Measured& measured, Candidates& __restrict candidates,
                           std::uint32_t* __restrict place, std::size_t* count) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    place[found] = static_cast<std::uint32_t>(i);
    found += measured.above[i] > 0 ? 1 : 0;
  }
  *count = found;
  if (found == kReturnBlock) {
    std::memcpy(candidates.trial, measured.square, sizeof candidates.trial);
    std::memcpy(candidates.strain, points.plastic_strain, sizeof candidates.strain);
    std::memcpy(candidates.factor, points.factor, sizeof candidates.factor);
  } else {
    for (std::size_t k = 0; k < found; ++k) {
      candidates.trial[k] = measured.square[place[k]];
      candidates.strain[k] = points.plastic_strain[place[k]];
      candidates.factor[k] = points.factor[place[k]];
    }
  }
  const std::size_t filled = (found + kReturnGroup - 1) / kReturnGroup * kReturnGroup;
  for (std::size_t k = found; k < filled; ++k) {
    candidates.trial[k] = 0.0;
    candidates.strain[k] = 0.0;
    candidates.factor[k] = 1.0;
  }
#pragma omp simd
  for (std::size_t k = 0; k < filled; ++k) candidates.trial[k] = std::sqrt(candidates.trial[k]);
  return filled;
}

/// Moves results of the candidates back to their places.
inline void spread(std::size_t count, const std::uint32_t* __restrict place, const double* __restrict from,
                   double* __restrict to) {
  if (count == kReturnBlock) {
    std::memcpy(to, from, kReturnBlock * sizeof(double));
  } else {
    for (std::size_t k = 0; k < count; ++k) to[place[k]] = from[k];
  }
}

inline void solve(std::size_t m, const HardeningCurve& curve, double stiffness, bool wants_slope,
                  Candidates& candidates) {
  switch (curve.form) {
    case HardeningForm::power: return solve_power(m, curve, stiffness, wants_slope, candidates);
    case HardeningForm::linear: return solve_linear(m, curve, stiffness, candidates);
    case HardeningForm::voce: return solve_voce(m, curve, stiffness, candidates);
    case HardeningForm::table: return solve_table(m, curve, stiffness, candidates);
  }
}

/// increment = share·deviator. The deviator is formed from differences, so that the mean stress does not round it.
/// The zeros of elastic points are positive, as in a block without plastic ones.
inline void write_increments(const ReturnPoints& points, const double* __restrict share, double* const* increment) {
  const double *xx = points.trial[0], *yy = points.trial[1], *zz = points.trial[2];
  double* __restrict to_xx = increment[0], * __restrict to_yy = increment[1], * __restrict to_zz = increment[2];
#pragma omp simd
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    const double a = xx[i] - yy[i], b = yy[i] - zz[i], c = zz[i] - xx[i], third = share[i] * (1.0 / 3);
    to_xx[i] = third * (a - c) + 0.0;
    to_yy[i] = third * (b - a) + 0.0;
    to_zz[i] = third * (c - b) + 0.0;
  }
  for (int k = 3; k < 6; ++k) {
    const double* from = points.trial[k];
    double* __restrict to = increment[k];
#pragma omp simd
    for (std::size_t i = 0; i < kReturnBlock; ++i) to[i] = share[i] * from[i] + 0.0;
  }
}

/// stress = mean + theta·deviator; it may replace the trial stress.
inline void write_stress(const ReturnPoints& points, const double* __restrict theta, double* const* stress) {
  double mapped[6][kReturnBlock];
  const double *xx = points.trial[0], *yy = points.trial[1], *zz = points.trial[2];
#pragma omp simd
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    const double a = xx[i] - yy[i], b = yy[i] - zz[i], c = zz[i] - xx[i], third = theta[i] * (1.0 / 3);
    const double mean = (xx[i] + yy[i] + zz[i]) * (1.0 / 3);
    const bool elastic = theta[i] == 1.0;
    mapped[0][i] = elastic ? xx[i] : mean + third * (a - c);
    mapped[1][i] = elastic ? yy[i] : mean + third * (b - a);
    mapped[2][i] = elastic ? zz[i] : mean + third * (c - b);
  }
  for (int k = 3; k < 6; ++k) {
    const double* from = points.trial[k];
#pragma omp simd
    for (std::size_t i = 0; i < kReturnBlock; ++i) mapped[k][i] = theta[i] * from[i];
  }
  for (int k = 0; k < 6; ++k) std::memcpy(stress[k], mapped[k], sizeof mapped[k]);
}

inline void copy_block(const double* from, double* to) {
  if (from != to) std::memcpy(to, from, kReturnBlock * sizeof(double));
}

inline void write_elastic(const ReturnPoints& points, const Measured& measured, const ReturnResult& result) {
  if (result.moved == nullptr || *result.moved != 0) {
    for (int k = 0; k < 6; ++k) std::memset(result.increment[k], 0, kReturnBlock * sizeof(double));
    copy_block(points.plastic_strain, result.plastic_strain);
    if (result.moved != nullptr) *result.moved = 0;
  }
  if (result.stress[0] != nullptr) {
    for (int k = 0; k < 6; ++k) copy_block(points.trial[k], result.stress[k]);
  }
  for (std::size_t i = 0; i < kReturnBlock; ++i) {
    if (result.von_mises != nullptr) result.von_mises[i] = std::sqrt(measured.square[i]);
    if (result.theta != nullptr) result.theta[i] = 1.0;
    if (result.theta_bar != nullptr) result.theta_bar[i] = 0.0;
  }
}

/// Points and results of a whole block; called from one place, so that there is one copy of it. Returns how many
/// yielded; refused: the first that is out of range, if any is.
inline std::size_t map_block(const HardeningCurve& curve, double stiffness, const ReturnPoints& points,
                             const ReturnResult& result, std::size_t* refused) {
  Measured measured;
  measure(points, curve.initial, measured);
  *refused = kReturnBlock;
  if (!(measured.total <= kMostSquare && measured.least >= 0)) {
    *refused = first_refused(points, measured);
    if (*refused < kReturnBlock) return 0;
  }
  if (!(measured.most > 0)) {
    write_elastic(points, measured, result);
    return 0;
  }
  Candidates candidates;
  std::uint32_t place[kReturnBlock];
  std::size_t count = 0;
  const std::size_t filled = collect(points, measured, candidates, place, &count);
  solve(filled, curve, stiffness, result.theta_bar != nullptr, candidates);

  double share[kReturnBlock] = {}, flow[kReturnBlock] = {}, theta[kReturnBlock], theta_bar[kReturnBlock] = {};
  for (double& one : theta) one = 1.0;
  double solved_share[kReturnBlock], ratio[kReturnBlock], rest[kReturnBlock], yields = 0;
#pragma omp simd reduction(+ : yields)
  for (std::size_t k = 0; k < filled; ++k) {
    const double q = candidates.trial[k] > 0 ? candidates.trial[k] : 1.0, inverse = 1.0 / q;
    solved_share[k] = 1.5 * candidates.flow[k] * inverse;
    ratio[k] = candidates.flow[k] > 0 ? candidates.stress[k] * inverse : 1.0;
    yields += candidates.flow[k] > 0 ? 1.0 : 0.0;
  }
  spread(count, place, candidates.flow, flow);
  spread(count, place, solved_share, share);
  spread(count, place, ratio, theta);
  if (result.theta_bar != nullptr) {
#pragma omp simd
    for (std::size_t k = 0; k < filled; ++k) {
      const double tangent = stiffness / (stiffness + candidates.slope[k]) - (1.0 - ratio[k]);
      rest[k] = candidates.flow[k] > 0 ? tangent : 0.0;
    }
    spread(count, place, rest, theta_bar);
  }
  if (result.moved != nullptr) *result.moved = 1;
  write_increments(points, share, result.increment);
  if (result.von_mises != nullptr) {
    for (std::size_t i = 0; i < kReturnBlock; ++i) result.von_mises[i] = theta[i] * std::sqrt(measured.square[i]);
  }
  if (result.stress[0] != nullptr) write_stress(points, theta, result.stress);
  for (std::size_t i = 0; i < kReturnBlock; ++i) flow[i] += points.plastic_strain[i];
  std::memcpy(result.plastic_strain, flow, sizeof flow);
  if (result.theta != nullptr) std::memcpy(result.theta, theta, sizeof theta);
  if (result.theta_bar != nullptr) std::memcpy(result.theta_bar, theta_bar, sizeof theta_bar);
  return static_cast<std::size_t>(yields);
}

/// The arrays of ReturnResult one after the other.
constexpr int kResultArrays = 16;
inline double* result_array(const ReturnResult& result, int k) {
  if (k < 6) return result.increment[k];
  if (k < 12) return result.stress[k - 6];
  return k == 12 ? result.plastic_strain : k == 13 ? result.von_mises : k == 14 ? result.theta : result.theta_bar;
}
inline void set_result_array(ReturnResult& result, int k, double* array) {
  (k < 6     ? result.increment[k]
   : k < 12  ? result.stress[k - 6]
   : k == 12 ? result.plastic_strain
   : k == 13 ? result.von_mises
   : k == 14 ? result.theta
             : result.theta_bar) = array;
}

/// The last points, fewer than a block, filled up with zeros.
struct LastBlock {
  double inputs[8][kReturnBlock];
  double outputs[kResultArrays][kReturnBlock];
  std::uint8_t moved = 1;  // all of the outputs are written
  ReturnPoints points;
  ReturnResult result;

  LastBlock() = default;
  LastBlock(std::size_t count, const ReturnPoints& from, const ReturnResult& to) {
    std::memset(inputs, 0, sizeof inputs);
    for (int k = 0; k < 6; ++k) {
      std::memcpy(inputs[k], from.trial[k], count * sizeof(double));
      points.trial[k] = inputs[k];
    }
    std::memcpy(inputs[6], from.plastic_strain, count * sizeof(double));
    std::memcpy(inputs[7], from.factor, count * sizeof(double));
    points.plastic_strain = inputs[6];
    points.factor = inputs[7];
    for (int k = 0; k < kResultArrays; ++k) {
      if (result_array(to, k) != nullptr) set_result_array(result, k, outputs[k]);
    }
    result.moved = &moved;
  }
  LastBlock(const LastBlock&) = delete;
  LastBlock& operator=(const LastBlock&) = delete;

  void give(std::size_t count, const ReturnResult& to) const {
    for (int k = 0; k < kResultArrays; ++k) {
      if (double* array = result_array(to, k)) std::memcpy(array, outputs[k], count * sizeof(double));
    }
    if (to.moved != nullptr) *to.moved = moved;
  }
};

inline ReturnPoints behind(const ReturnPoints& points, std::size_t done, const double* ones) {
  ReturnPoints rest;
  for (int k = 0; k < 6; ++k) rest.trial[k] = points.trial[k] + done;
  rest.plastic_strain = points.plastic_strain + done;
  rest.factor = points.factor != nullptr ? points.factor + done : ones;
  return rest;
}

inline ReturnResult behind(const ReturnResult& result, std::size_t done) {
  ReturnResult rest;
  for (int k = 0; k < kResultArrays; ++k) {
    if (double* array = result_array(result, k)) set_result_array(rest, k, array + done);
  }
  if (result.moved != nullptr) rest.moved = result.moved + done / kReturnBlock;
  return rest;
}

inline void map_points(std::size_t n, const HardeningCurve& curve, double shear_modulus, const ReturnPoints& points,
                       const ReturnResult& result, ReturnReport* report) {
  double ones[kReturnBlock];
  for (double& one : ones) one = 1.0;
  const double stiffness = 3 * shear_modulus;
  *report = {0, n};
  const std::size_t rest = n % kReturnBlock, whole = n - rest;
  auto last = rest != 0 ? LastBlock(rest, behind(points, whole, ones), behind(result, whole)) : LastBlock();
  for (std::size_t done = 0; done < n; done += kReturnBlock) {
    const bool is_last = done == whole;
    std::size_t refused = kReturnBlock;
    report->plastic += map_block(curve, stiffness, is_last ? last.points : behind(points, done, ones),
                                 is_last ? last.result : behind(result, done), &refused);
    if (refused < kReturnBlock) {
      report->refused = done + refused;
      return;
    }
  }
  if (rest != 0) last.give(rest, behind(result, whole));
}

inline double yield_of(const HardeningCurve& curve, double p) {
  switch (curve.form) {
    case HardeningForm::power: break;  // in whole blocks, below
    case HardeningForm::linear: return curve.initial + curve.modulus * p;
    case HardeningForm::voce: return curve.initial - curve.amplitude * expm1_of(-curve.rate * p);
    case HardeningForm::table: return table_value(curve, table_interval(curve, p), p).stress;
  }
  return 0;
}

/// Whole blocks, so that each value comes from the same instructions wherever it stands.
inline void yield_stresses(std::size_t n, const HardeningCurve& curve, const double* plastic_strain,
                           const double* factor, double* result) {
  for (std::size_t done = 0; done < n; done += kReturnBlock) {
    const std::size_t count = n - done < kReturnBlock ? n - done : kReturnBlock;
    double strain[kReturnBlock] = {}, yield[kReturnBlock];
    std::memcpy(strain, plastic_strain + done, count * sizeof(double));
    if (curve.form == HardeningForm::power) {
#pragma omp simd
      for (std::size_t i = 0; i < kReturnBlock; ++i) {
        const double power =
            curve.coefficient * exp_of(curve.exponent * log_of(curve.offset + curve.scale * strain[i]));
        yield[i] = power > curve.onset ? power : curve.onset;
      }
    } else {
      for (std::size_t i = 0; i < kReturnBlock; ++i) yield[i] = yield_of(curve, strain[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      result[done + i] = (factor != nullptr ? factor[done + i] : 1.0) * yield[i];
    }
  }
}

template <class Arch>
constexpr ReturnMappingKernels return_mapping_kernels() {
  return {map_points, yield_stresses};
}

}  // namespace
}  // namespace brinell::simd
