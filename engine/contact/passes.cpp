#include "contact/passes.h"

#include <algorithm>
#include <cmath>

namespace brinell::contact {

namespace {

/// A stretch of one row: where it begins, and how far its nodes are apart.
struct Stretch {
  double x = 0, y = 0, spacing = 0;

  simd::Line places() const { return {x, spacing}; }
  simd::Line of(const LinearTrend& trend) const { return trend.along(x, y, spacing); }
};

// A row's sums in the plane, y being its place.
PlaneSums in_plane(const simd::LinearSums& row, double y) {
  return {row.one, row.x, row.one * y};
}

PlaneWeights in_plane(const simd::QuadraticSums& row, double y) {
  return {row.one, row.x, row.one * y, row.xx, row.x * y, row.one * y * y};
}

AdvanceTotals in_plane(const simd::AdvanceSums& row, double y) {
  return {in_plane(row.load, y), in_plane(row.gap, y), row.tension};
}

CorrelationTotals in_plane(const simd::CorrelationSums& row, double y) {
  return {in_plane(row.active, y), in_plane(row.z, y), in_plane(row.q, y), in_plane(row.v, y), row.zq, row.vq};
}

DirectionTotals in_plane(const simd::DirectionSums& row, double y) {
  return {in_plane(row.load, y), in_plane(row.free, y)};
}

RefreshTotals in_plane(const simd::RefreshSums& row, double y) {
  return {in_plane(row.load, y), in_plane(row.gap, y), row.displacement};
}

simd::ResidualSums in_plane(const simd::ResidualSums& row, double) {
  return row;
}

simd::SlopeSums in_plane(const simd::SlopeSums& row, double) {
  return row;
}

double in_plane(double row, double) {
  return row;
}

void combine(PlaneSums& total, const PlaneSums& part) {
  total.one += part.one;
  total.x += part.x;
  total.y += part.y;
}

void combine(PlaneWeights& total, const PlaneWeights& part) {
  total.one += part.one;
  total.x += part.x;
  total.y += part.y;
  total.xx += part.xx;
  total.xy += part.xy;
  total.yy += part.yy;
}

void combine(AdvanceTotals& total, const AdvanceTotals& part) {
  combine(total.load, part.load);
  combine(total.gap, part.gap);
  total.tension = std::max(total.tension, part.tension);
}

void combine(DirectionTotals& total, const DirectionTotals& part) {
  combine(total.load, part.load);
  combine(total.free, part.free);
}

void combine(CorrelationTotals& total, const CorrelationTotals& part) {
  combine(total.active, part.active);
  combine(total.z, part.z);
  combine(total.q, part.q);
  combine(total.v, part.v);
  total.zq += part.zq;
  total.vq += part.vq;
}

void combine(RefreshTotals& total, const RefreshTotals& part) {
  combine(total.load, part.load);
  combine(total.gap, part.gap);
  total.displacement = std::max(total.displacement, part.displacement);
}

void combine(simd::ResidualSums& total, const simd::ResidualSums& part) {
  total.active += part.active;
  total.occupied += part.occupied;
  total.changed += part.changed;
  total.complementarity += part.complementarity;
  total.depth = std::max(total.depth, part.depth);
}

void combine(simd::SlopeSums& total, const simd::SlopeSums& part) {
  total.free += part.free;
  total.taken += part.taken;
}

void combine(double& total, double part) {
  total += part;
}

}  // namespace

template <class Real>
Passes<Real>::Passes(const parallel::Arena& arena, const simd::KernelTable& kernels, const PlacedGrid& placed)
    : arena_(arena),
      sets_(kernels.of<Real>()),
      kernels_(&sets_.contact),
      placed_(placed),
      nodes_(static_cast<std::int64_t>(placed.grid.nodes())),
      occupied_((placed.grid.nodes() + kBlock - 1) / kBlock, 1),
      moving_(occupied_.size(), 1) {}

template <class Real>
void Passes<Real>::open_contact() {
  if (contact_.empty()) contact_ = Buffer<std::uint8_t>::uninitialised(static_cast<std::size_t>(nodes_));
  std::fill(contact_.begin(), contact_.end(), std::uint8_t{1});
}

template <class Real>
void Passes<Real>::tilting(bool tilting) {
  tilting_ = tilting;
  kernels_ = tilting ? &sets_.tilting_contact : &sets_.contact;
}

/// Adds kernel(first node, number of nodes, stretch) up over the rows' parts within a block; places matter, and rows
/// with them, only to bodies that may tilt.
template <class Real>
template <class Totals, class Kernel>
void Passes<Real>::over_stretches(std::int64_t first, std::int64_t n, Totals& totals, const Kernel& kernel) const {
  if (!tilting_) {
    combine(totals, in_plane(kernel(first, static_cast<std::size_t>(n), Stretch{}), 0));
    return;
  }
  const Grid& grid = placed_.grid;
  for (const std::int64_t last = first + n; first < last;) {
    const std::int64_t j = first / grid.nx, i = first % grid.nx;
    const std::int64_t length = std::min(grid.nx - i, last - first);
    const Stretch stretch{placed_.x + static_cast<double>(i) * grid.dx, placed_.y + static_cast<double>(j) * grid.dy,
                          grid.dx};
    combine(totals, in_plane(kernel(first, static_cast<std::size_t>(length), stretch), stretch.y));
    first += length;
  }
}

/// Adds body(totals, first node, number of nodes, block) up.
template <class Real>
template <class Totals, class Body>
Totals Passes<Real>::over_blocks(const Body& body) {
  return ordered_sum<Totals>(
      arena_, nodes_, kChunk, [](Totals& total, const Totals& part) { combine(total, part); },
      [&](std::int64_t begin, std::int64_t end) {
        Totals chunk{};
        for (std::int64_t first = begin; first < end; first += kBlock) {
          body(chunk, first, std::min(kBlock, end - first), static_cast<std::size_t>(first / kBlock));
        }
        return chunk;
      });
}

template <class Real>
AdvanceTotals Passes<Real>::advance(double step, double* p, const Real* v, double* g, const Real* q) {
  return over_blocks<AdvanceTotals>([&](AdvanceTotals& totals, std::int64_t first, std::int64_t count, std::size_t) {
    over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      simd::AdvanceSums part;
      kernels_->advance(n, stretch.places(), step, p + i, v + i, g + i, q + i, &part);
      return part;
    });
  });
}

template <class Real>
simd::ResidualSums Passes<Real>::residual(const LinearTrend& approach, double noise, double stiffness,
                                          const double* p, const double* g, Real* z) {
  return over_blocks<simd::ResidualSums>([&](simd::ResidualSums& totals, std::int64_t first, std::int64_t count,
                                             std::size_t block) {
    const double before = totals.occupied;
    over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      simd::ResidualSums part;
      kernels_->residual(n, stretch.of(approach), noise, stiffness, p + i, g + i, contact_.data() + i, z + i, &part);
      return part;
    });
    occupied_[block] = totals.occupied > before ? 1 : 0;
  });
}

template <class Real>
CorrelationTotals Passes<Real>::correlate(const Real* z, const Real* v, const Real* q) {
  return over_blocks<CorrelationTotals>(
      [&](CorrelationTotals& totals, std::int64_t first, std::int64_t count, std::size_t block) {
        if (occupied_[block] == 0) return;
        over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
          simd::CorrelationSums part;
          kernels_->correlate(n, stretch.places(), contact_.data() + i, z + i, v + i, q + i, &part);
          return part;
        });
      });
}

template <class Real>
DirectionTotals Passes<Real>::redirect(double beta, const LinearTrend& trend_v, double scale,
                                       const LinearTrend& trend_z, const double* p, const Real* z, Real* v) {
  return over_blocks<DirectionTotals>(
      [&](DirectionTotals& totals, std::int64_t first, std::int64_t count, std::size_t block) {
        if (occupied_[block] != 0) {
          moving_[block] = 1;
          over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
            simd::DirectionSums part;
            kernels_->redirect(n, stretch.places(), beta, stretch.of(trend_v), scale, stretch.of(trend_z),
                               contact_.data() + i, p + i, z + i, v + i, &part);
            return part;
          });
        } else if (moving_[block] != 0) {
          std::fill_n(v + first, count, Real(0));
          moving_[block] = 0;
        }
      });
}

template <class Real>
simd::SlopeSums Passes<Real>::balance(const LinearTrend& shift, const LinearTrend& approach, const double* p,
                                      const double* g, Real* v) {
  return over_blocks<simd::SlopeSums>([&](simd::SlopeSums& totals, std::int64_t first, std::int64_t count,
                                          std::size_t block) {
    if (occupied_[block] == 0) return;
    over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      return kernels_->balance(n, stretch.of(shift), stretch.of(approach), contact_.data() + i, p + i, g + i, v + i);
    });
  });
}

template <class Real>
double Passes<Real>::curvature(const double* p, const Real* v, const Real* q) {
  return over_blocks<double>([&](double& total, std::int64_t first, std::int64_t count, std::size_t block) {
    if (occupied_[block] == 0) return;
    total += kernels_->curvature(static_cast<std::size_t>(count), contact_.data() + first, p + first, v + first,
                                 q + first);
  });
}

template <class Real>
PlaneWeights Passes<Real>::carried(const LinearTrend& factor, const double* p) {
  return over_blocks<PlaneWeights>([&](PlaneWeights& totals, std::int64_t first, std::int64_t count, std::size_t) {
    over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      return kernels_->carried(n, stretch.places(), stretch.of(factor), contact_.data() + i, p + i);
    });
  });
}

template <class Real>
void Passes<Real>::clip(const LinearTrend& factor, double* p) {
  over_blocks<double>([&](double& none, std::int64_t first, std::int64_t count, std::size_t) {
    over_stretches(first, count, none, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      kernels_->clip(n, stretch.of(factor), contact_.data() + i, p + i);
      return 0.0;
    });
  });
}

template <class Real>
RefreshTotals Passes<Real>::refresh(const UndeformedGap& h, const double* p, double* g) {
  return over_blocks<RefreshTotals>([&](RefreshTotals& totals, std::int64_t first, std::int64_t count, std::size_t) {
    over_stretches(first, count, totals, [&](std::int64_t i, std::size_t n, const Stretch& stretch) {
      simd::RefreshSums part;
      kernels_->refresh(n, stretch.places(), h.scale, h.origin, h.values + i, p + i, g + i, &part);
      return part;
    });
  });
}

template <class Real>
void Passes<Real>::indicator(Real* z) {
  arena_.for_chunks(nodes_, kChunk, [&](std::int64_t begin, std::int64_t end, int) {
    kernels_->indicator(static_cast<std::size_t>(end - begin), contact_.data() + begin, z + begin);
  });
}

template <class Real>
void Passes<Real>::conductance(const Real* z, float* w) {
  arena_.for_chunks(nodes_, kChunk, [&](std::int64_t begin, std::int64_t end, int) {
    kernels_->conductance(static_cast<std::size_t>(end - begin), contact_.data() + begin, z + begin, w + begin);
  });
}

template class Passes<double>;
template class Passes<float>;

}  // namespace brinell::contact
