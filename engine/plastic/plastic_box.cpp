// The box of one elastic-plastic body: which cuboids it takes for a contact, when it grows and which way, and what
// moves with it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fft/lane_tree.h"
#include "plastic/plastic_body.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

namespace {

// Nodes in contact and flow stay so many cuboids from the sides of the box.
constexpr std::int64_t kShells = 2;
// Flow of this part of the largest plastic strain does not count at a side: laws without a yield stress flow
// everywhere.
constexpr double kNegligible = 1e-5;
// A side that is reached moves by at least this part of the box. More would cost each iteration more than fewer
// boxes, each with new coefficients, save.
constexpr double kGrowth = 0.05;
constexpr std::int64_t kFirstLayers = 8;
// Below a contact yielding can begin down to so many half widths of it.
constexpr double kDepth = 2.1;

std::int64_t more(std::int64_t size) {
  return static_cast<std::int64_t>(std::ceil(kGrowth * static_cast<double>(size)));
}

/// What transforms are fast for takes as many cuboids as it holds: eight times 2^a 3^b 5^c.
std::int64_t roomy(std::int64_t count) {
  std::int64_t eights = (count + 7) / 8;
  while (!fft::is_tree_length(eights)) ++eights;
  return 8 * eights;
}

void cleared(Buffer<double>& field, std::size_t size) {
  field.resize(size);
  std::fill(field.begin(), field.end(), 0.0);
}

struct Side {
  std::int64_t first, count;
};

/// Room for begin … end − 1 and what the side holds, as even as the grid allows.
Side side_for(std::int64_t begin, std::int64_t end, const Side& old, std::int64_t nodes) {
  begin = std::max<std::int64_t>(0, begin);
  end = std::min(nodes, end);
  if (old.count > 0) {
    begin = std::min(begin, old.first);
    end = std::max(end, old.first + old.count);
  }
  const std::int64_t count = std::min(nodes, roomy(end - begin));
  const std::int64_t first = begin - (count - (end - begin)) / 2;
  return {std::clamp<std::int64_t>(first, 0, nodes - count), count};
}

}  // namespace

Buffer<double> placed_in(const Region& next, const Region& before, const Buffer<double>& field,
                         std::size_t components) {
  const std::size_t from_stride = PlasticBody::stride_of(before.box), to_stride = PlasticBody::stride_of(next.box);
  Buffer<double> result(components * to_stride);
  const std::int64_t i0 = std::max(before.i0, next.i0), j0 = std::max(before.j0, next.j0);
  const std::int64_t i1 = std::min(before.i0 + before.box.nx, next.i0 + next.box.nx);
  const std::int64_t j1 = std::min(before.j0 + before.box.ny, next.j0 + next.box.ny);
  if (i1 <= i0) return result;
  const auto at = [&](const Region& region, std::int64_t j, std::int64_t k) {
    return static_cast<std::size_t>((k * region.box.ny + j - region.j0) * region.box.nx + i0 - region.i0);
  };
  for (std::size_t c = 0; c < components; ++c) {
    for (std::int64_t k = 0; k < std::min(before.box.nz, next.box.nz); ++k) {
      for (std::int64_t j = j0; j < j1; ++j) {
        std::copy_n(field.data() + c * from_stride + at(before, j, k), i1 - i0,
                    result.data() + c * to_stride + at(next, j, k));
      }
    }
  }
  return result;
}

bool PlasticBody::cover(const contact::Box& contact) {
  if (contact.nx == 0) return false;
  const auto within = [](std::int64_t first, std::int64_t count, const Side& box, std::int64_t nodes) {
    return box.first <= std::max<std::int64_t>(0, first - kShells) &&
           box.first + box.count >= std::min(nodes, first + count + kShells);
  };
  const Side x{region_.i0, region_.box.nx}, y{region_.j0, region_.box.ny};
  if (!region_.empty() && within(contact.i0, contact.nx, x, grid_.nx) &&
      within(contact.j0, contact.ny, y, grid_.ny)) {
    return false;
  }
  const auto side = [](std::int64_t first, std::int64_t count, const Side& old, std::int64_t nodes) {
    const std::int64_t margin = kShells + more(count);
    return side_for(first - margin, first + count + margin, old, nodes);
  };
  const Side of_x = side(contact.i0, contact.nx, x, grid_.nx), of_y = side(contact.j0, contact.ny, y, grid_.ny);
  Region next{of_x.first, of_y.first, {of_x.count, of_y.count, 0, grid_.dx, grid_.dy, layers_.thickness}};
  next.box.nz = std::max(region_.box.nz, std::min(kFirstLayers, layers_.count));
  if (!layer_factor_.empty()) next.box.nz = layers_.count;  // a soft layer may flow by itself
  move_to(next);
  return true;
}

bool PlasticBody::make_room_for_flow() {
  if (region_.empty()) return false;
  const Box& box = region_.box;
  const double negligible = kNegligible * *std::max_element(p_mapped_.begin(), p_mapped_.end());
  std::array<std::int64_t, 3> first{box.nx, box.ny, box.nz}, end{};
  for (std::size_t at = 0; at < blocks_.size() / kAll; ++at) {
    const std::size_t begin = static_cast<std::size_t>(blocks_[at]) * kBlock;
    for (std::size_t n = begin; n < std::min(begin + kBlock, box.cuboids()); ++n) {
      if (!flows(n) || !(std::max(p_mapped_[n], p_[n]) > negligible)) continue;
      const auto place = static_cast<std::int64_t>(n);
      const std::int64_t index[3] = {place % box.nx, place / box.nx % box.ny, place / (box.nx * box.ny)};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::min(first[axis], index[axis]);
        end[axis] = std::max(end[axis], index[axis] + 1);
      }
    }
  }
  if (end[2] == 0) return false;
  const auto widened = [](std::int64_t flow, std::int64_t flow_end, const Side& old, std::int64_t nodes) {
    const std::int64_t by = kShells + more(old.count);
    return side_for(old.first + (flow < kShells ? flow - by : 0),
                    old.first + (flow_end > old.count - kShells ? flow_end + by : 0), old, nodes);
  };
  const Side x = widened(first[0], end[0], {region_.i0, box.nx}, grid_.nx);
  const Side y = widened(first[1], end[1], {region_.j0, box.ny}, grid_.ny);
  Region next{x.first, y.first, {x.count, y.count, box.nz, box.dx, box.dy, box.dz}};
  if (end[2] > box.nz - kShells) next.box.nz = layers_for(end[2] + kShells + more(box.nz));
  if (next == region_) return false;
  move_to(next);
  return true;
}

/// The residual stress below the box is taken to be at most that of its last layer. Depths are sampled: at a depth
/// the stress does not change over less than the depth.
bool PlasticBody::make_room_below(const contact::Box& contact, const double* pressure, double unit,
                                  const TractionRatio& shear) {
  if (region_.empty() || contact.nx == 0) return false;
  const Box box = region_.box;
  const double half =
      0.5 * std::max(static_cast<double>(contact.nx) * grid_.dx, static_cast<double>(contact.ny) * grid_.dy);
  subsurface::StressRequest request;
  std::vector<std::int64_t> layers;
  for (std::int64_t k = box.nz; k < layers_.count; k += std::max<std::int64_t>(1, k / 6)) {
    const double depth = (static_cast<double>(k) + 0.5) * layers_.thickness;
    if (depth > kDepth * half) break;
    layers.push_back(k);
    request.depths.push_back(depth);
  }
  if (layers.empty()) return false;
  request.grid = {box.nx, box.ny, grid_.dx, grid_.dy};
  request.poissons_ratio = material_.poissons_ratio;
  request.invariants = {subsurface::Invariant::von_mises};
  request.sources = sources_of(shear);
  subsurface::StressField stress(backend_, request);
  take_tractions(pressure, unit, shear);
  const auto columns = static_cast<std::size_t>(box.nx * box.ny);
  const std::size_t last = columns * static_cast<std::size_t>(box.nz - 1);
  Buffer<double> residual(columns);
  simd::StressArrays of_last;
  for (std::size_t c = 0; c < kAll; ++c) of_last.component[c] = residual_.data() + c * stride_ + last;
  backend_.kernels.subsurface.von_mises(columns, of_last, residual.data());
  const double yield = law_.yield_stress(kNegligible * *std::max_element(p_.begin(), p_.end()));
  std::int64_t deepest = 0;
  stress.compute_by_layer(tractions(), [&](const subsurface::StressLayer& layer) {
    const double* contact_stress = layer.invariant[static_cast<std::size_t>(subsurface::Invariant::von_mises)];
    for (std::size_t n = 0; n < columns; ++n) {
      if (!(contact_stress[n] + residual[n] > yield)) continue;
      deepest = layers[static_cast<std::size_t>(layer.layer)];
      break;
    }
  });
  if (deepest == 0) return false;
  Region next = region_;
  next.box.nz = layers_for(deepest + 1 + kShells);
  move_to(next);
  return true;
}

/// So many layers or some more, as the transforms like it.
std::int64_t PlasticBody::layers_for(std::int64_t count) const {
  while (!fft::is_tree_length(count)) ++count;
  return std::min(count, layers_.count);
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
  region_ = next;
  stress_.reset();
  const Box& box = region_.box;
  stride_ = stride_of(box);
  old_ = placed_in(region_, before, old_, kAll);
  d_ = placed_in(region_, before, d_, kAll);
  stress_old_ = placed_in(region_, before, stress_old_, kAll);
  p_old_ = placed_in(region_, before, p_old_, 1);
  for (Buffer<double>* field : {&strain_, &mapped_, &residual_, &total_, &trial_, &early_})
    cleared(*field, kAll * stride_);
  for (Buffer<double>* field : {&p_, &p_mapped_, &p_early_, &von_mises_, &yield_}) cleared(*field, stride_);
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
