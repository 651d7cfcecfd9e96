// Influence coefficients, many offsets at a time. Every kernel writes `count` coefficients of one row, those of the
// offsets x = i·dx, i = first, first + 1, …, at one y; the formulas stand in engine/influence.
#pragma once

#include <cstdint>

namespace brinell::simd {

inline constexpr int kMaxGaussNodes = 8;

struct GaussRule {
  int nodes = 0;
  double node[kMaxGaussNodes] = {};    // on [−1, 1]
  double weight[kMaxGaussNodes] = {};  // sum 2
};

/// Offsets of one row.
struct RowSpan {
  double dx = 0;
  double y = 0;
  std::int64_t first = 0;
  std::int64_t count = 0;
};

inline constexpr int kSeriesTerms = 6;

/// Far field of a cell: Σ_s r^(−1−2s) Σ_k coefficient[s(s+1)/2 + k] (x²/r²)^k.
struct DisplacementSeries {
  double coefficient[kSeriesTerms * (kSeriesTerms + 1) / 2] = {};
};

/// Stress below a cell |x| <= a, |y| <= b, at one depth z >= 0 of a material with 1 − 2ν = compressibility.
struct StressCell {
  double a = 0, b = 0, z = 0;
  double compressibility = 1;
};

/// Where the six components xx yy zz yz xz xy of a row go; null: not wanted, not computed.
struct StressRows {
  double* component[6] = {};
};

struct InfluenceKernels {
  /// All six terms of the series, its first four, its first three.
  void (*displacement_series[3])(const DisplacementSeries& series, const RowSpan& span, double* row);

  /// scale·∬1/r over the cell |x| <= a, |y| <= b: quadrature along x (along y) of the integral along y (along x).
  /// Offsets are not negative; the distance along the direction of quadrature is at least 4 cells.
  void (*displacement_along_x)(const GaussRule& rule, double a, double b, double scale, const RowSpan& span,
                               double* row);
  void (*displacement_along_y)(const GaussRule& rule, double a, double b, double scale, const RowSpan& span,
                               double* row);

  /// Stress per unit pressure, shear along x, shear along y: by the corner sums of the closed form, and by product
  /// quadrature of the point forces.
  void (*stress_closed[3])(const StressCell& cell, const RowSpan& span, const StressRows& rows);
  void (*stress_points[3])(const StressCell& cell, const GaussRule& rule_x, const GaussRule& rule_y,
                           const RowSpan& span, const StressRows& rows);
};

}  // namespace brinell::simd
