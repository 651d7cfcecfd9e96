// The vector work of the solver: threads over chunks of blocks, sums combined in the order of the chunks, and blocks
// without contact skipped. See simd/contact_kernels.h for what each pass does to a block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/buffer.h"
#include "contact/problem.h"
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

template <class Real>
class Passes {
 public:
  Passes(const parallel::Arena& arena, const simd::KernelTable& kernels, std::size_t nodes);

  /// p += step·v, g += step·q everywhere.
  simd::AdvanceSums advance(double step, double* p, const Real* v, double* g, const Real* q);

  /// Nodes out of contact with g < approach enter with the pressure seed; z = g − approach in contact, else 0.
  simd::ResidualSums residual(double approach, double seed, double* p, const double* g, Real* z);

  simd::DirectionSums correlate(const double* p, const Real* z, const Real* v, const Real* q);

  /// The next direction; returns its slope Σ v (g − approach).
  double redirect(double beta, double mean_v, double mean_z, double approach, const double* p, const double* g,
                  const Real* z, Real* v);

  double dot(const Real* a, const Real* b);

  /// Takes tension out and multiplies by factor; returns Σ p.
  double clip(double factor, double* p);

  /// g: displacement on entry, deformed gap on return.
  simd::RefreshSums refresh(const UndeformedGap& h, const double* p, double* g);

  void indicator(const double* p, Real* z);
  void conductance(const double* p, const Real* z, float* w);

  /// Σ z over nodes in contact.
  double sum(const double* p, const Real* z);

  /// p = max(p − (z − mean_z), 0) in contact; returns Σ p.
  double correct(double mean_z, double* p, const Real* z);

 private:
  template <class Sums, class Combine, class Body>
  Sums over_blocks(const Combine& combine, const Body& body);

  static constexpr std::int64_t kBlock = 512;  // nodes; two pages of doubles, and a multiple of every register
  static constexpr std::int64_t kChunk = 16 * kBlock;

  const parallel::Arena& arena_;
  const simd::ContactKernels<Real>& kernels_;
  std::int64_t nodes_;
  std::vector<std::uint8_t> in_contact_;  // per block: has active nodes, as of the last residual pass
  std::vector<std::uint8_t> moving_;      // per block: v is not all zero
};

}  // namespace brinell::contact
