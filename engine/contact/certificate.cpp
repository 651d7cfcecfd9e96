#include "contact/certificate.h"

#include <algorithm>
#include <cmath>

namespace brinell::contact {

namespace {

struct PressureSums {
  double total = 0;
  double complementarity = 0;
};

/// What is no number proves nothing, and would be passed over by comparisons: it counts as infinite.
double proof(double part) {
  return std::isnan(part) ? HUGE_VAL : part;
}

}  // namespace

double Certificate::worst() const {
  return std::max({penetration, complementarity, tension, balance});
}

Certificate certificate_of(const Evidence& evidence, Drive drive, double target) {
  for (const double part : {evidence.approach, evidence.total, evidence.displacement, evidence.min_gap,
                            evidence.complementarity, evidence.tension_displacement, target}) {
    if (!std::isfinite(part)) return {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
  }
  Certificate certificate;
  const double depth = std::max(0.0, evidence.approach - evidence.min_gap);
  if (evidence.displacement > 0) {
    certificate.penetration = depth / evidence.displacement;
    certificate.complementarity = proof(evidence.complementarity / (evidence.total * evidence.displacement));
    certificate.tension = evidence.tension_displacement / evidence.displacement;
  } else {
    certificate.penetration = depth > 0 ? 1 : 0;
  }
  if (drive == Drive::force) certificate.balance = proof(std::fabs(evidence.total - target) / target);
  return certificate;
}

Certified certify(const parallel::Arena& arena, const Compliance<double>& compliance, Passes<double>& passes,
                  std::size_t nodes, const UndeformedGap& gap, const double* p, double* g, Drive drive,
                  double target) {
  compliance.apply(p, g);
  const simd::RefreshSums fresh = passes.refresh(gap, p, g);
  const double approach = drive == Drive::force && fresh.load > 0 ? fresh.gap / fresh.load : target;
  const auto sums = ordered_sum<PressureSums>(
      arena, static_cast<std::int64_t>(nodes), 1 << 14,
      [](PressureSums& total, const PressureSums& part) {
        total.total += part.total;
        total.complementarity += part.complementarity;
      },
      [&](std::int64_t begin, std::int64_t end) {
        PressureSums part;
        for (std::int64_t n = begin; n < end; ++n) {
          part.total += p[n];
          part.complementarity += std::fabs(p[n] * (g[n] - approach));
        }
        return part;
      });
  return {approach, sums.total,
          certificate_of({approach, sums.total, fresh.displacement, fresh.min_gap, sums.complementarity, 0}, drive,
                         target)};
}

}  // namespace brinell::contact
