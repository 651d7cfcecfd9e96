#include "fft/lane_tree.h"

#include <cmath>
#include <numbers>

namespace brinell::fft {

std::vector<std::int32_t> tree_radices(std::int64_t n) {
  int twos = 0;
  std::vector<std::int32_t> odd;
  for (; n % 2 == 0; n /= 2) ++twos;
  for (; n % 5 == 0; n /= 5) odd.push_back(5);
  for (; n % 3 == 0; n /= 3) odd.push_back(3);
  // As many eights as leave no single two; an eight at both ends, where the fused steps are.
  int fours = 0;
  if (twos % 3 == 1 && twos >= 4) fours = 2;
  if (twos % 3 == 2) fours = 1;
  int eights = (twos - 2 * fours) / 3;
  std::vector<std::int32_t> middle(odd);
  middle.insert(middle.end(), static_cast<std::size_t>(fours), 4);
  if (twos == 1) middle.push_back(2);
  std::vector<std::int32_t> radices;
  if (eights > 1) {
    radices.push_back(8);
    --eights;
  }
  radices.insert(radices.end(), middle.begin(), middle.end());
  radices.insert(radices.end(), static_cast<std::size_t>(eights), 8);
  return radices;
}

bool is_tree_length(std::int64_t n) {
  if (n < 1) return false;
  for (const std::int32_t radix : tree_radices(n)) n /= radix;
  return n == 1;
}

double tree_cost(std::int64_t n) {
  double cost = 3;
  for (const std::int32_t radix : tree_radices(n)) {
    switch (radix) {
      case 2: cost += 2.5; break;
      case 3: cost += 3.5; break;
      case 4: cost += 3.5; break;
      case 5: cost += 5; break;
      default: cost += 5;
    }
  }
  return cost * static_cast<double>(n);
}

template <class Real>
void unit_root(std::int64_t numerator, std::int64_t denominator, Real& re, Real& im) {
  const long double turn = static_cast<long double>(numerator % denominator) / static_cast<long double>(denominator);
  re = static_cast<Real>(std::cos(2 * std::numbers::pi_v<long double> * turn));
  im = static_cast<Real>(-std::sin(2 * std::numbers::pi_v<long double> * turn));
}

template <class Real>
LaneTree<Real>::LaneTree(std::int64_t length, std::int64_t numerator, std::int64_t denominator)
    : length_(length), radices_(tree_radices(length)), leaves_{numerator}, leaf_denominator_(denominator) {
  for (const std::int32_t radix : radices_) {
    const std::int64_t finer = leaf_denominator_ * radix;
    Buffer<Real> twiddles(leaves_.size() * 2 * static_cast<std::size_t>(radix - 1));
    std::vector<std::int64_t> next;
    std::size_t place = 0;
    for (const std::int64_t node : leaves_) {
      for (std::int64_t s = 1; s < radix; ++s, place += 2) {
        unit_root(s * node, finer, twiddles[place], twiddles[place + 1]);
      }
      for (std::int64_t t = 0; t < radix; ++t) next.push_back(node + t * leaf_denominator_);
    }
    twiddles_.push_back(std::move(twiddles));
    leaves_ = std::move(next);
    leaf_denominator_ = finer;
  }
}

template <class Real>
simd::TransformTree<Real> LaneTree<Real>::view() const {
  simd::TransformTree<Real> tree{};
  tree.length = length_;
  tree.stages = static_cast<std::int32_t>(radices_.size());
  for (std::size_t stage = 0; stage < radices_.size(); ++stage) {
    tree.radix[stage] = radices_[stage];
    tree.twiddles[stage] = twiddles_[stage].data();
  }
  return tree;
}

template void unit_root<double>(std::int64_t, std::int64_t, double&, double&);
template void unit_root<float>(std::int64_t, std::int64_t, float&, float&);
template class LaneTree<double>;
template class LaneTree<float>;

}  // namespace brinell::fft
