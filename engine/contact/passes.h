// The vector work of the solver: threads over chunks of blocks, sums combined in the order of the chunks, and blocks
// without contact skipped. See simd/contact_kernels.h for what each pass does to a block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/buffer.h"
#include "contact/problem.h"
#include "contact/trend.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::contact {

/// Σ over chunks of the part that `body` returns, in the order of the chunks.
template <class Sums, class Combine, class Body>
Sums ordered_sum(const parallel::Arena& arena, std::int64_t n, std::int64_t chunk, const Combine& combine,
                 const Body& body) {
  std::vector<Sums> parts(static_cast<std::size_t>((n + chunk - 1) / chunk));
  arena.for_chunks(n, chunk, [&](std::int64_t begin, std::int64_t end, int) {
    parts[static_cast<std::size_t>(begin / chunk)] = body(begin, end);
  });
  Sums total{};
  for (const Sums& part : parts) combine(total, part);
  return total;
}

struct AdvanceTotals {
  double active = 0;
  PlaneWeights load;
  PlaneSums gap;
  double tension = 0;
};

struct DirectionTotals {
  PlaneWeights active;
  PlaneSums z, q, v;
  double zq = 0, vq = 0;
};

struct RefreshTotals {
  double active = 0;
  PlaneWeights load;
  PlaneSums gap;
  double displacement = 0;
  double energy = 0;
};

template <class Real>
class Passes {
 public:
  Passes(const parallel::Arena& arena, const simd::KernelTable& kernels, const PlacedGrid& placed);

  /// Whether trends have slopes, and sums their moments; no to begin with. If not, both are zero.
  void tilting(bool tilting);

  /// p += step·v, g += step·q everywhere.
  AdvanceTotals advance(double step, double* p, const Real* v, double* g, const Real* q);

  /// Nodes out of contact with g < approach − noise enter with the pressure seed; z = g − approach in contact, else
  /// 0.
  simd::ResidualSums residual(const LinearTrend& approach, double noise, double seed, double* p, const double* g,
                              Real* z);

  DirectionTotals correlate(const double* p, const Real* z, const Real* v, const Real* q);

  /// The next direction; returns its slope Σ v (g − approach).
  double redirect(double beta, const LinearTrend& trend_v, const LinearTrend& trend_z, const LinearTrend& approach,
                  const double* p, const double* g, const Real* z, Real* v);

  double dot(const Real* a, const Real* b);

  /// Of the pressure where it and the factor are positive.
  PlaneWeights carried(const LinearTrend& factor, const double* p);

  /// Takes tension out and multiplies by the factor, or by zero where that is negative.
  void clip(const LinearTrend& factor, double* p);

  /// g: displacement on entry, deformed gap on return.
  RefreshTotals refresh(const UndeformedGap& h, const double* p, double* g);

  void indicator(const double* p, Real* z);
  void conductance(const double* p, const Real* z, float* w);

  /// p = max(p − (z − trend_z), 0) in contact.
  void correct(const LinearTrend& trend_z, double* p, const Real* z);

 private:
  template <class Totals, class Kernel>
  void over_stretches(std::int64_t first, std::int64_t n, Totals& totals, const Kernel& kernel) const;
  template <class Totals, class Body>
  Totals over_blocks(const Body& body);

  static constexpr std::int64_t kBlock = simd::kLongestStretch;  // two pages of doubles, a multiple of every register
  static constexpr std::int64_t kChunk = 16 * kBlock;

  const parallel::Arena& arena_;
  const simd::RealKernels<Real>& sets_;
  const simd::ContactKernels<Real>* kernels_;
  PlacedGrid placed_;
  bool tilting_ = false;
  std::int64_t nodes_;
  std::vector<std::uint8_t> in_contact_;  // per block: has active nodes, as of the last residual pass
  std::vector<std::uint8_t> moving_;      // per block: v is not all zero
};

}  // namespace brinell::contact
