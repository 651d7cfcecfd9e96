#pragma once

#include <cstring>

#include "simd/influence_kernels.h"

namespace brinell::simd {
namespace {

/// Calls body(x) for every register of offsets of the span and stores what it returns; the last, partial register
/// is computed whole, so that a coefficient does not depend on its place in the register.
template <class Arch, class Body>
void fill_row(const RowSpan& span, double* row, Body body) {
  using Batch = xsimd::batch<double, Arch>;
  constexpr std::int64_t kLanes = Batch::size;
  alignas(64) double lanes[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) lanes[lane] = static_cast<double>(span.first) + lane;
  Batch index = xsimd::load_aligned<Arch>(lanes);
  const Batch dx(span.dx), step(static_cast<double>(kLanes));
  std::int64_t done = 0;
  for (; done + kLanes <= span.count; done += kLanes, index += step) body(index * dx).store_unaligned(row + done);
  if (done == span.count) return;
  body(index * dx).store_aligned(lanes);
  std::memcpy(row + done, lanes, static_cast<std::size_t>(span.count - done) * sizeof(double));
}

/// 1/√square. AVX-512's estimate of 14 bits and one step of fourth order, ε = 1 − square·h²,
/// h (1 + ε/2 + 3ε²/8 + 5ε³/16), take a third of the time of a division and a square root.
template <class Arch>
xsimd::batch<double, Arch> inverse_root(xsimd::batch<double, Arch> square) {
  using Batch = xsimd::batch<double, Arch>;
#if XSIMD_WITH_AVX512F
  const Batch estimate = _mm512_rsqrt14_pd(square);
  const Batch error = Batch(1.0) - square * estimate * estimate;
  const Batch correction = error * (Batch(0.5) + error * (Batch(0.375) + error * Batch(0.3125)));
  return estimate + estimate * correction;
#else
  return Batch(1.0) / xsimd::sqrt(square);
#endif
}

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
  };
}

}  // namespace
}  // namespace brinell::simd
