// The authority for return mapping: laws written as in their definitions and a return by bisection, point by point in
// long double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "plastic/hardening.h"

namespace brinell::support {

using Real = long double;
using LongTensor = std::array<Real, 6>;  // xx yy zz yz xz xy

inline Real yield_of(const plastic::Swift& law, Real p) {
  return law.B * std::pow(law.C + law.strain_scale * p, static_cast<Real>(law.n));
}
inline Real yield_of(const plastic::LinearHardening& law, Real p) {
  return law.yield_stress + law.hardening_modulus * p;
}
inline Real yield_of(const plastic::PerfectPlasticity& law, Real) {
  return law.yield_stress;
}
inline Real yield_of(const plastic::Voce& law, Real p) {
  return law.yield_stress - (static_cast<Real>(law.saturation_stress) - law.yield_stress) * std::expm1(-law.rate * p);
}
inline Real yield_of(const plastic::RambergOsgood& law, Real p) {
  return std::max<Real>(law.yield_stress, law.K * std::pow(p, 1 / static_cast<Real>(law.m)));
}
/// Hermite's basis, with the slopes of Fritsch & Butland.
inline Real yield_of(const plastic::HardeningTable& law, Real p) {
  const auto& x = law.plastic_strain;
  const auto& y = law.stress;
  const std::size_t last = x.size() - 1;
  if (p >= x[last]) return y[last];
  std::size_t k = 0;
  while (x[k + 1] <= p) ++k;
  const auto width = [&](std::size_t i) { return static_cast<Real>(x[i + 1]) - x[i]; };
  const auto chord = [&](std::size_t i) { return (static_cast<Real>(y[i + 1]) - y[i]) / width(i); };
  const auto end = [&](std::size_t near, std::size_t far) {
    const Real parabola =
        ((2 * width(near) + width(far)) * chord(near) - width(near) * chord(far)) / (width(near) + width(far));
    return std::clamp<Real>(parabola, 0, 3 * chord(near));
  };
  const auto slope = [&](std::size_t i) -> Real {
    if (last == 1) return chord(0);
    if (i == 0) return end(0, 1);
    if (i == last) return end(last - 1, last - 2);
    if (chord(i - 1) == 0 || chord(i) == 0) return 0;
    const Real a = 2 * width(i) + width(i - 1), b = width(i) + 2 * width(i - 1);
    return (a + b) / (a / chord(i - 1) + b / chord(i));
  };
  const Real h = width(k), t = (p - x[k]) / h, u = 1 - t;
  return (1 + 2 * t) * u * u * y[k] + t * u * u * h * slope(k) + t * t * (3 - 2 * t) * y[k + 1] -
         t * t * u * h * slope(k + 1);
}

inline Real yield_of(const plastic::HardeningLaw& law, Real p) {
  return std::visit([p](const auto& one) { return yield_of(one, p); }, law);
}

inline LongTensor deviator_of(const LongTensor& stress) {
  const Real mean = (stress[0] + stress[1] + stress[2]) / 3;
  return {stress[0] - mean, stress[1] - mean, stress[2] - mean, stress[3], stress[4], stress[5]};
}

/// a:b of two symmetric tensors.
inline Real contract(const LongTensor& a, const LongTensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

inline Real von_mises_of(const LongTensor& stress) {
  const LongTensor s = deviator_of(stress);
  return std::sqrt(1.5L * contract(s, s));
}

/// The increment of equivalent plastic strain: the root of factor·yield(p + flow) + 3 mu flow = q.
inline Real flow_of(const plastic::HardeningLaw& law, Real factor, Real shear_modulus, Real q, Real p) {
  if (q <= factor * yield_of(law, p)) return 0;
  Real low = 0, high = q / (3 * shear_modulus);
  while (true) {
    const Real middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return middle;
    if (high - low <= 4 * std::numeric_limits<Real>::epsilon() * low) return middle;
    (factor * yield_of(law, p + middle) + 3 * shear_modulus * middle > q ? high : low) = middle;
  }
}

inline LongTensor increment_of(const plastic::HardeningLaw& law, Real factor, Real shear_modulus,
                               const LongTensor& trial, Real p) {
  const Real q = von_mises_of(trial), flow = flow_of(law, factor, shear_modulus, q, p);
  LongTensor increment = deviator_of(trial);
  for (Real& component : increment) component *= q > 0 ? 1.5L * flow / q : 0;
  return increment;
}

}  // namespace brinell::support
