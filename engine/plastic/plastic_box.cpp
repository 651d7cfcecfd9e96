// The box of one elastic-plastic body: which cuboids it takes for a contact, when it grows and which way, and what
// moves with it.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "plastic/plastic_body.h"

namespace brinell::plastic {

namespace {

// A box is made for a contact of this many times the half width.
constexpr double kRoom = 1.25;
// Half width and depth of the box that a smooth contact needs, in half widths of the contact.
constexpr double kLateral = 1.5;
constexpr double kDepth = 2.1;
// Nodes in contact stay this far from the sides of the box, flow at least as many cuboids.
constexpr std::int64_t kShells = 2;
// Flow of this part of the largest plastic strain does not count at a side: laws without a yield stress flow
// everywhere.
constexpr double kNegligible = 1e-5;
// Where flow has reached a side, all move by this part of the box: coefficients of a box take longer to generate than
// those of a few smaller ones would save.
constexpr double kGrowth = 0.17;
constexpr std::int64_t kLeastGrowth = 3;

}  // namespace

bool PlasticBody::cover(const contact::Box& contact) {
  if (contact.nx == 0) return false;
  const auto within = [](std::int64_t first, std::int64_t count, std::int64_t box_first, std::int64_t box_count,
                         std::int64_t nodes) {
    return box_first <= std::max<std::int64_t>(0, first - kShells) &&
           box_first + box_count >= std::min(nodes, first + count + kShells);
  };
  if (!region_.empty() && within(contact.i0, contact.nx, region_.i0, region_.box.nx, grid_.nx) &&
      within(contact.j0, contact.ny, region_.j0, region_.box.ny, grid_.ny)) {
    return false;
  }
  const auto side = [](std::int64_t first, std::int64_t count, std::int64_t old_first, std::int64_t old_count,
                       std::int64_t nodes) {
    const double half = 0.5 * static_cast<double>(count);
    const auto margin = static_cast<std::int64_t>(std::ceil((kRoom * kLateral - 1) * half)) + kShells;
    std::int64_t begin = std::max<std::int64_t>(0, first - margin), end = std::min(nodes, first + count + margin);
    if (old_count > 0) {
      begin = std::min(begin, old_first);
      end = std::max(end, old_first + old_count);
    }
    return std::pair{begin, end - begin};
  };
  Region next;
  next.box = {0, 0, 0, grid_.dx, grid_.dy, layers_.thickness};
  std::tie(next.i0, next.box.nx) = side(contact.i0, contact.nx, region_.i0, region_.box.nx, grid_.nx);
  std::tie(next.j0, next.box.ny) = side(contact.j0, contact.ny, region_.j0, region_.box.ny, grid_.ny);
  const double half =
      0.5 * std::max(static_cast<double>(contact.nx) * grid_.dx, static_cast<double>(contact.ny) * grid_.dy);
  const double depth = std::ceil(kRoom * kDepth * half / layers_.thickness) + kShells;
  next.box.nz = depth < static_cast<double>(layers_.count) ? static_cast<std::int64_t>(depth) : layers_.count;
  if (!layer_factor_.empty()) next.box.nz = layers_.count;  // a soft layer may flow by itself
  next.box.nz = std::max(next.box.nz, region_.box.nz);
  move_to(next);
  return true;
}

bool PlasticBody::make_room_for_flow() {
  if (region_.empty()) return false;
  const Box& box = region_.box;
  const auto near_side = [&](std::size_t n) {
    const auto at = static_cast<std::int64_t>(n);
    const std::int64_t i = at % box.nx, j = at / box.nx % box.ny, k = at / (box.nx * box.ny);
    return (i < kShells && region_.i0 > 0) || (j < kShells && region_.j0 > 0) ||
           (i >= box.nx - kShells && region_.i0 + box.nx < grid_.nx) ||
           (j >= box.ny - kShells && region_.j0 + box.ny < grid_.ny) ||
           (k >= box.nz - kShells && box.nz < layers_.count);
  };
  const double negligible = kNegligible * *std::max_element(p_mapped_.begin(), p_mapped_.end());
  bool reached = false;
  for (std::size_t at = 0; at < blocks_.size() / kAll && !reached; ++at) {
    const std::size_t first = static_cast<std::size_t>(blocks_[at]) * kBlock;
    for (std::size_t n = first; n < std::min(first + kBlock, box.cuboids()) && !reached; ++n) {
      reached = flows(n) && std::max(p_mapped_[n], p_[n]) > negligible && near_side(n);
    }
  }
  if (!reached) return false;
  const auto more = [](std::int64_t size) {
    return std::max(kLeastGrowth, static_cast<std::int64_t>(kGrowth * static_cast<double>(size)));
  };
  Region next = region_;
  const auto widen = [&](std::int64_t& first, std::int64_t& count, std::int64_t nodes) {
    const std::int64_t by = more(count), end = std::min(nodes, first + count + by);
    first = std::max<std::int64_t>(0, first - by);
    count = end - first;
  };
  widen(next.i0, next.box.nx, grid_.nx);
  widen(next.j0, next.box.ny, grid_.ny);
  next.box.nz = std::min(layers_.count, box.nz + 2 * more(box.nz));
  if (next == region_) return false;
  move_to(next);
  return true;
}

bool PlasticBody::flow_is_cut_off() const {
  const Box& box = region_.box;
  if (region_.empty()) return false;
  const double negligible = kNegligible * *std::max_element(p_.begin(), p_.end());
  for (std::size_t n = 0; n < box.cuboids(); ++n) {
    if (!(p_[n] > negligible)) continue;
    const auto at = static_cast<std::int64_t>(n);
    const std::int64_t i = region_.i0 + at % box.nx, j = region_.j0 + at / box.nx % box.ny;
    if (i == 0 || j == 0 || i == grid_.nx - 1 || j == grid_.ny - 1) return true;
    if (at / (box.nx * box.ny) == layers_.count - 1) return true;
  }
  return false;
}

/// Copies what is known into a box that holds the present one.
void PlasticBody::move_to(const Region& next) {
  const Region before = region_;
  const std::size_t stride_before = stride_;
  region_ = next;
  response_.reset();
  stress_.reset();
  const Box& box = region_.box;
  stride_ = stride_of(box);
  const auto moved_field = [&](const Buffer<double>& field, std::size_t components) {
    Buffer<double> result(components * stride_);
    if (before.empty()) return result;
    for (std::size_t c = 0; c < components; ++c) {
      for (std::int64_t k = 0; k < before.box.nz; ++k) {
        for (std::int64_t j = 0; j < before.box.ny; ++j) {
          const std::int64_t to = (k * box.ny + j + before.j0 - region_.j0) * box.nx + before.i0 - region_.i0;
          std::copy_n(
              field.data() + c * stride_before + static_cast<std::size_t>((k * before.box.ny + j) * before.box.nx),
              before.box.nx, result.data() + c * stride_ + static_cast<std::size_t>(to));
        }
      }
    }
    return result;
  };
  old_ = moved_field(old_, kAll);
  d_ = moved_field(d_, kAll);
  stress_old_ = moved_field(stress_old_, kAll);
  p_old_ = moved_field(p_old_, 1);
  for (Buffer<double>* field : {&strain_, &mapped_, &residual_, &total_, &trial_, &early_})
    *field = Buffer<double>(kAll * stride_);
  for (Buffer<double>* field : {&p_, &p_mapped_, &p_early_, &von_mises_, &yield_}) *field = Buffer<double>(stride_);
  std::copy(old_.begin(), old_.end(), strain_.begin());
  std::copy(p_old_.begin(), p_old_.end(), p_.begin());
  std::copy(p_old_.begin(), p_old_.end(), p_mapped_.begin());
  std::copy(p_old_.begin(), p_old_.end(), p_early_.begin());
  pressure_ = Buffer<double>(static_cast<std::size_t>(box.nx * box.ny));
  if (!layer_factor_.empty()) {
    factor_ = Buffer<double>(stride_);
    for (std::size_t n = 0; n < box.cuboids(); ++n) {
      factor_[n] = layer_factor_[n / static_cast<std::size_t>(box.nx * box.ny)];
    }
    std::fill(factor_.begin() + box.cuboids(), factor_.end(), 1.0);
  }
  accepted_ = residual_is_current_ = displacement_is_current_ = false;
  moved_.assign(stride_ / kBlock, 1);
  active_.assign(stride_ / kBlock, 0);
  for (std::size_t block = 0; block < active_.size(); ++block) {
    for (std::size_t c = 0; c < kAll && active_[block] == 0; ++c) {
      const double* values = d_.data() + c * stride_ + block * kBlock;
      active_[block] = std::any_of(values, values + kBlock, [](double value) { return value != 0; }) ? 1 : 0;
    }
  }
  list_blocks();
  combine();
}

}  // namespace brinell::plastic
