#pragma once

#include "simd/influence_kernels.h"
#include "simd/kernels/influence_row.inl"
#include "simd/kernels/influence_stress.inl"

namespace brinell::simd {
namespace {

template <class Arch, int Terms>
void displacement_series(const DisplacementSeries& series, const RowSpan& span, double* row) {
  using Batch = xsimd::batch<double, Arch>;
  const Batch y2(span.y * span.y);
  fill_row<Arch>(span, row, [&](Batch x) {
    const Batch x2 = x * x;
    const Batch root = inverse_root(x2 + y2);
    const Batch inverse = root * root;
    const Batch u = x2 * inverse;
    const auto polynomial = [&](int s) {
      const double* q = series.coefficient + s * (s + 1) / 2;
      Batch value(q[s]);
      for (int k = s - 1; k >= 0; --k) value = value * u + Batch(q[k]);
      return value;
    };
    Batch sum = polynomial(Terms - 1);
    for (int s = Terms - 2; s >= 0; --s) sum = sum * inverse + polynomial(s);
    return sum * root;
  });
}

/// ∫ dt/√(c² + t²) from o − h to o + h with c, h > 0, o >= 0: the log1p of a positive ratio, free of cancellation
/// on both sides of o = h (formula of the paired form).
template <class Batch>
Batch line_potential(Batch c2, Batch o, Batch h) {
  const Batch upper = o + h, lower = o - h;
  const Batch r_upper = xsimd::sqrt(c2 + upper * upper), r_lower = xsimd::sqrt(c2 + lower * lower);
  const Batch beyond = r_lower + xsimd::abs(lower);
  const Batch denominator = xsimd::select(lower < Batch(0.0), c2 / beyond, beyond);
  const Batch sum = r_upper + r_lower;
  return xsimd::log1p((h + h) * (sum + o + o) / (sum * denominator));
}

template <class Arch>
void displacement_along_x(const GaussRule& rule, double a, double b, double scale, const RowSpan& span, double* row) {
  using Batch = xsimd::batch<double, Arch>;
  const Batch y(span.y), half(b), factor(scale * a);
  fill_row<Arch>(span, row, [&](Batch x) {
    Batch sum(0.0);
    for (int k = 0; k < rule.nodes; ++k) {
      const Batch c = x + Batch(a * rule.node[k]);
      sum += Batch(rule.weight[k]) * line_potential(c * c, y, half);
    }
    return sum * factor;
  });
}

template <class Arch>
void displacement_along_y(const GaussRule& rule, double a, double b, double scale, const RowSpan& span, double* row) {
  using Batch = xsimd::batch<double, Arch>;
  const Batch half(a), factor(scale * b);
  fill_row<Arch>(span, row, [&](Batch x) {
    Batch sum(0.0);
    for (int k = 0; k < rule.nodes; ++k) {
      const double c = span.y + b * rule.node[k];
      sum += Batch(rule.weight[k]) * line_potential(Batch(c * c), x, half);
    }
    return sum * factor;
  });
}

template <class Arch>
constexpr InfluenceKernels influence_kernels() {
  return {
      .displacement_series = {displacement_series<Arch, 6>, displacement_series<Arch, 4>,
                              displacement_series<Arch, 3>},
      .displacement_along_x = displacement_along_x<Arch>,
      .displacement_along_y = displacement_along_y<Arch>,
      .stress_closed = {stress_closed<Arch, PressureStress>, stress_closed<Arch, ShearStress>,
                        stress_closed<Arch, ShearYStress>},
      .stress_points = {stress_points<Arch, PressureStress>, stress_points<Arch, ShearStress>,
                        stress_points<Arch, ShearYStress>},
  };
}

}  // namespace
}  // namespace brinell::simd
