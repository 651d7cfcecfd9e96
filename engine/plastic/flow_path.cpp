#include "plastic/flow_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace brinell::plastic {

namespace {

double contracted(const PointTensor& a, const PointTensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

PointTensor deviator(PointTensor stress) {
  const double mean = (stress[0] + stress[1] + stress[2]) / 3;
  for (std::size_t c = 0; c < 3; ++c) stress[c] -= mean;
  return stress;
}

double von_mises(const PointTensor& deviator) {
  return std::sqrt(1.5 * contracted(deviator, deviator));
}

/// 1 − θ
double early_share(double x) {
  constexpr double small = 1e-2;  // the series' next term is x³/720
  return x < small ? 0.5 - x / 12 : 1 / x - 1 / std::expm1(x);
}

}  // namespace

double equivalent_strain(const PointTensor& strain) {
  return std::sqrt(2.0 / 3 * contracted(strain, strain));
}

EarlyFlow early_flow(const PointFlow& point) {
  EarlyFlow early;
  const double length = equivalent_strain(point.increment);
  if (!(length > 0)) return early;
  const PointTensor trial = deviator(point.trial), before = deviator(point.stress_before);
  const double excess = von_mises(trial) - point.yield_stress;
  if (!(excess > 0)) return early;

  PointTensor way{};
  for (std::size_t c = 0; c < way.size(); ++c) way[c] = trial[c] - before[c];
  const double square = 1.5 * contracted(way, way), mixed = 1.5 * contracted(way, before);
  const double below = 1.5 * contracted(before, before) - point.yield_stress * point.yield_stress;
  const double discriminant = mixed * mixed - square * below;
  const double onset =
      square > 0 && discriminant > 0 ? std::clamp((std::sqrt(discriminant) - mixed) / square, 0.0, 1.0) : 0;
  PointTensor direction{};
  for (std::size_t c = 0; c < way.size(); ++c) direction[c] = before[c] + onset * way[c];
  const double size = von_mises(direction);
  if (!(size > 0)) return early;

  const double cosine = contracted(direction, point.increment) / (size * length);
  const double thrice_mu = 3 * point.shear_modulus;
  early.equivalent = early_share(thrice_mu * length / point.yield_stress) * std::max(cosine, 0.0) *
                     std::min(length, excess / thrice_mu);
  for (std::size_t c = 0; c < way.size(); ++c) early.strain[c] = 1.5 * early.equivalent * direction[c] / size;
  return early;
}

double flow_error(const FlowEnds& ends) {
  const double early = equivalent_strain(ends.early), late = equivalent_strain(ends.late);
  PointTensor turned{}, change{};
  for (std::size_t c = 0; c < change.size(); ++c) {
    turned[c] = ends.early[c] - early / late * ends.late[c];
    change[c] = ends.after[c] - ends.before[c];
  }
  const double to_stress = 3 * ends.shear_modulus / ends.yield_after;
  const double flow = to_stress * (early + late);
  const double elastic = std::max(0.0, 1 - von_mises(deviator(ends.before)) / ends.yield_before);
  const double share = elastic / (elastic + flow);
  const double bent = 0.5 * flow * share * (1 - share) * von_mises(deviator(change)) / ends.yield_after;
  return std::max(to_stress * equivalent_strain(turned), bent);
}

}  // namespace brinell::plastic
