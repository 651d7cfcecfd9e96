#include "contact/certificate.h"

#include <algorithm>
#include <cmath>

namespace brinell::contact {

namespace {

struct Errors {
  double depth = 0;
  double complementarity = 0;
};

double half_side(std::int64_t nodes, double spacing) {
  return 0.5 * static_cast<double>(nodes) * spacing;
}

constexpr std::int64_t kRowsPerTask = 16;

/// What is no number proves nothing, and would be passed over by comparisons: it counts as infinite.
double proof(double part) {
  return std::isnan(part) ? HUGE_VAL : part;
}

}  // namespace

double Certificate::worst() const {
  return std::max({penetration, complementarity, tension, balance});
}

Certificate certificate_of(const Evidence& evidence, const Load& load, const Grid& grid) {
  for (const double part : {evidence.pressure.one, evidence.pressure.x, evidence.pressure.y, evidence.displacement,
                            evidence.depth, evidence.complementarity, evidence.tension_displacement, load.target}) {
    if (!std::isfinite(part)) return {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
  }
  Certificate certificate;
  if (evidence.displacement > 0) {
    certificate.penetration = evidence.depth / evidence.displacement;
    certificate.complementarity = proof(evidence.complementarity / (evidence.pressure.one * evidence.displacement));
    certificate.tension = evidence.tension_displacement / evidence.displacement;
  } else {
    certificate.penetration = evidence.depth > 0 ? 1 : 0;
  }
  if (load.drive == Drive::force) {
    certificate.balance = proof(std::fabs(evidence.pressure.one - load.target) / load.target);
  }
  if (load.moments) {
    const double moment_x = evidence.pressure.x - load.target * load.force_x;
    const double moment_y = evidence.pressure.y - load.target * load.force_y;
    certificate.balance =
        std::max({certificate.balance, std::fabs(moment_x) / (load.target * half_side(grid.nx, grid.dx)),
                  std::fabs(moment_y) / (load.target * half_side(grid.ny, grid.dy))});
  }
  return certificate;
}

Freedom freedom_of(const Load& load) {
  if (load.moments) return Freedom::linear;
  return load.drive == Drive::force ? Freedom::constant : Freedom::none;
}

LinearTrend prescribed_approach(const Load& load) {
  if (load.moments) return {};
  return {load.drive == Drive::approach ? load.target : 0, -load.slope_x, -load.slope_y};
}

Certified certify(const parallel::Arena& arena, const Compliance<double>& compliance, Passes<double>& passes,
                  const PlacedGrid& placed, const UndeformedGap& gap, const double* p, double* g, const Load& load) {
  const Grid& grid = placed.grid;
  compliance.apply(p, g);
  passes.tilting(load.tilts());
  const RefreshTotals fresh = passes.refresh(gap, p, g);
  LinearTrend approach = prescribed_approach(load);
  if (fresh.load.one > 0) approach = fit(freedom_of(load), fresh.load, fresh.gap, approach, kOnePoint);
  const auto errors = ordered_sum<Errors>(
      arena, grid.ny, kRowsPerTask,
      [](Errors& total, const Errors& part) {
        total.depth = std::max(total.depth, part.depth);
        total.complementarity += part.complementarity;
      },
      [&](std::int64_t begin, std::int64_t end) {
        Errors part;
        for (std::int64_t j = begin; j < end; ++j) {
          const simd::Line along = approach.along(placed.x, placed.y + static_cast<double>(j) * grid.dy, grid.dx);
          for (std::int64_t i = 0; i < grid.nx; ++i) {
            const std::int64_t n = j * grid.nx + i;
            const double r = g[n] - (along.value + along.slope * static_cast<double>(i));
            part.depth = std::max(part.depth, -r);
            part.complementarity += std::fabs(p[n] * r);
          }
        }
        return part;
      });
  const PlaneSums pressure{fresh.load.one, fresh.load.x, fresh.load.y};
  return {approach, pressure.one,
          certificate_of({pressure, fresh.displacement, errors.depth, errors.complementarity, 0}, load, grid)};
}

}  // namespace brinell::contact
