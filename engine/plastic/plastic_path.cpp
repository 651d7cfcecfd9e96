// How the flow of one elastic-plastic body is parted within an increment, what that says of the increment's error,
// and the work that it takes: ∫ σ_y dp by Simpson's rule, which is stress times plastic strain and never negative.
#include <array>
#include <cmath>

#include "plastic/flow_path.h"
#include "plastic/plastic_body.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

/// Of the cuboids of the block that begins with `first`.
void PlasticBody::yield_stresses_of_block(std::size_t first, const double* equivalent, double* result) const {
  backend_.kernels.return_mapping.yield_stress(kBlock, law_.curve(), equivalent,
                                               factor_.empty() ? nullptr : factor_.data() + first, result);
}

/// Takes the early part of the flow of the cuboids [begin, end) of one block off their trial stress.
void PlasticBody::part_flow(std::size_t begin, std::size_t end) {
  std::array<double, kBlock> yield;  // NOLINT(cppcoreguidelines-pro-type-member-init): written where read
  yield_stresses_of_block(begin, p_old_.data() + begin, yield.data());
  PointFlow point;
  point.shear_modulus = shear_modulus_;
  for (std::size_t n = begin; n < end; ++n) {
    for (std::size_t c = 0; c < kAll; ++c) {
      const std::size_t at = c * stride_ + n;
      point.stress_before[c] = stress_old_[at];
      point.trial[c] = trial_[at];
      point.increment[c] = d_[at];
    }
    point.yield_stress = yield[n - begin];
    const EarlyFlow early = early_flow(point);
    PointTensor late{};
    for (std::size_t c = 0; c < kAll; ++c) {
      early_[c * stride_ + n] = early.strain[c];
      trial_[c * stride_ + n] -= 2 * shear_modulus_ * early.strain[c];
      late[c] = point.increment[c] - early.strain[c];
    }
    p_early_[n] = p_old_[n] + early.equivalent;
    p_[n] = p_early_[n] + equivalent_strain(late);
  }
}

IncrementError PlasticBody::increment_error() const {
  IncrementError error;
  for (std::size_t n = 0; n < region_.box.cuboids(); ++n) error.cuboids += p_[n] > 0 ? 1 : 0;
  std::array<double, kBlock> yield_before;  // NOLINT(cppcoreguidelines-pro-type-member-init): written where read
  FlowEnds ends;
  ends.shear_modulus = shear_modulus_;
  for (std::size_t at = 0; at < blocks_.size() / kAll; ++at) {
    const std::size_t first = static_cast<std::size_t>(blocks_[at]) * kBlock;
    yield_stresses_of_block(first, p_old_.data() + first, yield_before.data());
    for (std::size_t n = first; n < first + kBlock; ++n) {
      if (!(p_[n] > p_early_[n])) continue;
      for (std::size_t c = 0; c < kAll; ++c) {
        const std::size_t of_c = c * stride_ + n;
        ends.early[c] = early_[of_c];
        ends.late[c] = d_[of_c] - early_[of_c];
        ends.before[c] = stress_old_[of_c];
        ends.after[c] = total_[of_c];
      }
      ends.yield_before = yield_before[n - first];
      ends.yield_after = yield_[n];
      const double one = flow_error(ends);
      error.squares += one * one;
    }
  }
  return error;
}

/// Of the increment [J].
double PlasticBody::plastic_work() const {
  double work = 0;
  for (std::size_t at = 0; at < blocks_.size() / kAll; ++at) {
    const std::size_t first = static_cast<std::size_t>(blocks_[at]) * kBlock;
    std::array<double, kBlock> middle, yield_before, yield_middle;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    for (std::size_t i = 0; i < kBlock; ++i) middle[i] = 0.5 * (p_old_[first + i] + p_[first + i]);
    yield_stresses_of_block(first, p_old_.data() + first, yield_before.data());
    yield_stresses_of_block(first, middle.data(), yield_middle.data());
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double flow = p_[first + i] - p_old_[first + i];
      if (flow > 0) work += flow * (yield_before[i] + 4 * yield_middle[i] + yield_[first + i]) / 6;
    }
  }
  return work * region_.box.dx * region_.box.dy * region_.box.dz;
}

}  // namespace brinell::plastic
