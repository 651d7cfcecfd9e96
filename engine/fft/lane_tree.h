// Tables of the lane transform's trees, and the lengths that suit it.
#pragma once

#include <cstdint>
#include <vector>

#include "base/buffer.h"
#include "simd/transform_kernels.h"

namespace brinell::fft {

/// Radices of the stages for length n >= 1, first to last; their product is n if n is 2^a 3^b 5^c, and a divisor of n
/// otherwise.
std::vector<std::int32_t> tree_radices(std::int64_t n);

/// Whether n >= 1 is 2^a 3^b 5^c.
bool is_tree_length(std::int64_t n);

/// Cost of a transform, in additions and moves of a complex vector.
double tree_cost(std::int64_t n);

/// A tree with its tables.
template <class Real>
class LaneTree {
 public:
  /// Root θ = numerator/denominator of a turn.
  LaneTree(std::int64_t length, std::int64_t numerator, std::int64_t denominator);

  simd::TransformTree<Real> view() const;

  /// Position p evaluates at θ = leaf_numerators()[p] / leaf_denominator().
  const std::vector<std::int64_t>& leaf_numerators() const { return leaves_; }
  std::int64_t leaf_denominator() const { return leaf_denominator_; }

 private:
  std::int64_t length_;
  std::vector<std::int32_t> radices_;
  std::vector<Buffer<Real>> twiddles_;  // of each stage
  std::vector<std::int64_t> leaves_;
  std::int64_t leaf_denominator_;
};

/// cos and −sin of 2π·numerator/denominator, rounded once.
template <class Real>
void unit_root(std::int64_t numerator, std::int64_t denominator, Real& re, Real& im);

}  // namespace brinell::fft
