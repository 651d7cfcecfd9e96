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
  PlaneWeights load;
  PlaneSums gap;
  double tension = 0;
};

struct CorrelationTotals {
  PlaneWeights active;
  PlaneSums z, q, v;
  double zq = 0, vq = 0;
};

struct DirectionTotals {
  PlaneSums load;
  PlaneWeights free;
};

struct RefreshTotals {
  PlaneWeights load;
  PlaneSums gap;
  double displacement = 0;
};

template <class Real>
class Passes {
 public:
  Passes(const parallel::Arena& arena, const simd::KernelTable& kernels, const PlacedGrid& placed);

  /// Whether trends have slopes, and sums their moments; no to begin with. If not, both are zero.
  void tilting(bool tilting);

  /// p += step·v, g += step·q everywhere.
  AdvanceTotals advance(double step, double* p, const Real* v, double* g, const Real* q);

  /// The nodes in contact follow from pressure and gap; z = g − approach in contact, else 0.
  simd::ResidualSums residual(const LinearTrend& approach, double noise, double stiffness, const double* p,
                              const double* g, Real* z);

  CorrelationTotals correlate(const Real* z, const Real* v, const Real* q);

  /// The next direction.
  DirectionTotals redirect(double beta, const LinearTrend& trend_v, double scale, const LinearTrend& trend_z,
                           const double* p, const Real* z, Real* v);

  /// Shifts its free part.
  simd::SlopeSums balance(const LinearTrend& shift, const LinearTrend& approach, const double* p, const double* g,
                          Real* v);

  /// Σ v q over the free part.
  double curvature(const double* p, const Real* v, const Real* q);

  /// Every node may carry pressure until the next residual. To be called before all that depends on the contact.
  void open_contact();

  /// Of the pressure in contact where it and the factor are positive.
  PlaneWeights carried(const LinearTrend& factor, const double* p);

  /// Takes tension out, and all that is out of contact, and multiplies by the factor, or by zero where that is
  /// negative.
  void clip(const LinearTrend& factor, double* p);

  /// g: displacement on entry, deformed gap on return.
  RefreshTotals refresh(const UndeformedGap& h, const double* p, double* g);

  void indicator(Real* z);
  void conductance(const Real* z, float* w);

  /// Bytes of one.
  static std::size_t bytes(const Grid& grid) { return Buffer<std::uint8_t>::padded_bytes(grid.nodes()); }

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
  Buffer<std::uint8_t> contact_;        // per node: in contact, as of the last residual pass; empty until needed
  std::vector<std::uint8_t> occupied_;  // per block: has contact or pressure, as of that pass
  std::vector<std::uint8_t> moving_;    // per block: v is not all zero
};

}  // namespace brinell::contact
