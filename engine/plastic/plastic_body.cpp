#include "plastic/plastic_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plastic/return_mapping.h"
#include "simd/kernel_table.h"
#include "subsurface/depths.h"

namespace brinell::plastic {

namespace {

static_assert(Anderson::kBlock == simd::kReturnBlock);
constexpr std::int64_t kChunk = 32 * static_cast<std::int64_t>(Anderson::kBlock);  // cuboids

Buffer<double> copy_of(const Buffer<double>& field) {
  auto result = Buffer<double>::uninitialised(field.size());
  std::copy(field.begin(), field.end(), result.begin());
  return result;
}

double square(double value) {
  return value * value;
}

}  // namespace

subsurface::Sources sources_of(const TractionRatio& shear) {
  subsurface::Sources sources{subsurface::Traction::pressure};
  if (shear[0] != 0) sources.add(subsurface::Traction::shear_x);
  if (shear[1] != 0) sources.add(subsurface::Traction::shear_y);
  return sources;
}

PlasticBody::PlasticBody(const fft::Backend& backend, const Grid& grid, const Layers& layers,
                         const PlasticMaterial& material, std::size_t spectra_limit)
    : backend_(backend),
      grid_(grid),
      layers_(layers),
      material_(material),
      spectra_limit_(spectra_limit),
      law_(material.hardening),
      shear_modulus_(material.youngs_modulus / (2 * (1 + material.poissons_ratio))),
      displacement_(grid.nodes()) {
  const std::vector<double> depths = subsurface::layer_depths(layers.count, layers.thickness);
  if (!material.hardening.depth_factor.empty()) layer_factor_ = law_.factors_at(depths);
}

std::size_t PlasticBody::stride_of(const Box& box) {
  return (box.cuboids() + kBlock - 1) / kBlock * kBlock;
}

TensorView PlasticBody::view(const Buffer<double>& field) const {
  TensorView tensor{};
  for (std::size_t c = 0; c < kAll; ++c) tensor[c] = field.data() + c * stride_;
  return tensor;
}

TensorArrays PlasticBody::arrays(Buffer<double>& field) const {
  TensorArrays tensor{};
  for (std::size_t c = 0; c < kAll; ++c) tensor[c] = field.data() + c * stride_;
  return tensor;
}

void PlasticBody::list_blocks() {
  blocks_.clear();
  for (std::size_t c = 0; c < kAll; ++c) {
    for (std::size_t block = 0; block < active_.size(); ++block) {
      if (active_[block] != 0) blocks_.push_back(static_cast<std::int64_t>(c * active_.size() + block));
    }
  }
}

/// strain = before + d, where there is an increment; and, until evaluate() knows of an early part, p.
void PlasticBody::combine() {
  const std::size_t count = blocks_.size() / kAll;
  if (count == 0) return;
  accepted_ = residual_is_current_ = displacement_is_current_ = false;
  backend_.arena.for_chunks(static_cast<std::int64_t>(count), 8, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t at = begin; at < end; ++at) {
      const std::size_t first = static_cast<std::size_t>(blocks_[static_cast<std::size_t>(at)]) * kBlock;
      for (std::size_t c = 0; c < kAll; ++c) {
        for (std::size_t n = first; n < first + kBlock; ++n) {
          strain_[c * stride_ + n] = old_[c * stride_ + n] + d_[c * stride_ + n];
        }
      }
      for (std::size_t n = first; n < first + kBlock; ++n) {
        double sum = 0;
        for (std::size_t c = 0; c < kAll; ++c) sum += (c < 3 ? 1 : 2) * square(d_[c * stride_ + n]);
        p_[n] = p_old_[n] + std::sqrt(2.0 / 3 * sum);
      }
    }
  });
}

void PlasticBody::guess(double factor) {
  // Without an increment the strain is what it was when it was accepted.
  const bool same = factor == 0 && accepted_;
  const bool residual = same && residual_is_current_, displacement = same && displacement_is_current_;
  for (const std::int64_t block : blocks_) {
    double* values = d_.data() + static_cast<std::size_t>(block) * kBlock;
    for (std::size_t i = 0; i < kBlock; ++i) values[i] *= factor;
  }
  const bool changed = !blocks_.empty();
  combine();
  if (factor != 0) return;
  if (changed) {
    residual_is_current_ = residual;
    displacement_is_current_ = displacement;
  }
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  std::fill(moved_.begin(), moved_.end(), std::uint8_t{1});
  blocks_.clear();
}

bool PlasticBody::has_increment() const {
  return std::any_of(blocks_.begin(), blocks_.end(), [&](std::int64_t block) {
    const double* values = d_.data() + static_cast<std::size_t>(block) * kBlock;
    return std::any_of(values, values + kBlock, [](double value) { return value != 0; });
  });
}

void PlasticBody::add_displacement(double weight, double* displacement) {
  if (region_.empty() || std::none_of(strain_.begin(), strain_.end(), [](double value) { return value != 0; })) {
    return;
  }
  if (surface_ == nullptr) {
    surface_ = std::make_unique<EigenstrainDisplacement>(backend_, grid_, region_.box.nz, layers_.thickness,
                                                         material_.poissons_ratio);
  }
  surface_->deepen(region_.box.nz);
  if (!displacement_is_current_) {
    surface_->displacement(strain(), region_.box, region_.i0, region_.j0, displacement_.data());
    displacement_is_current_ = true;
  }
  for (std::size_t n = 0; n < displacement_.size(); ++n) displacement[n] += weight * displacement_[n];
}

/// The pressure above the box, and the shears that it brings along; false: there is none.
bool PlasticBody::take_tractions(const double* pressure, double unit, const TractionRatio& shear) {
  const Box& box = region_.box;
  bool pressed = false;
  for (std::int64_t j = 0; j < box.ny; ++j) {
    const double* row = pressure + (region_.j0 + j) * grid_.nx + region_.i0;
    for (std::int64_t i = 0; i < box.nx; ++i) {
      pressed = pressed || row[i] > 0;
      pressure_[static_cast<std::size_t>(j * box.nx + i)] = row[i] * unit;
    }
  }
  for (std::size_t axis = 0; axis < shears_.size(); ++axis) {
    if (shear[axis] == 0) {
      shears_[axis] = {};
      continue;
    }
    shears_[axis].resize(pressure_.size());
    std::transform(pressure_.begin(), pressure_.end(), shears_[axis].begin(),
                   [&](double p) { return shear[axis] * p; });
  }
  return pressed;
}

subsurface::Tractions PlasticBody::tractions() const {
  const auto of = [](const Buffer<double>& field) { return field.empty() ? nullptr : field.data(); };
  return {pressure_.data(), of(shears_[0]), of(shears_[1])};
}

/// Into trial_.
void PlasticBody::contact_stress(const double* pressure, double unit, const TractionRatio& shear) {
  const Box& box = region_.box;
  const subsurface::Sources sources = sources_of(shear);
  if (stress_ == nullptr || !(stress_->request().sources == sources)) {
    stress_.reset();  // before the next takes its memory
    subsurface::StressRequest request;
    request.grid = {box.nx, box.ny, grid_.dx, grid_.dy};
    request.poissons_ratio = material_.poissons_ratio;
    request.depths = subsurface::layer_depths(box.nz, layers_.thickness);
    request.components = subsurface::kAllComponents;
    request.sources = sources;
    stress_ = std::make_unique<subsurface::StressField>(backend_, request, spectra_limit_);
  }
  if (!take_tractions(pressure, unit, shear)) {
    std::fill(trial_.begin(), trial_.end(), 0.0);
    return;
  }
  const TensorArrays contact = arrays(trial_);
  subsurface::StressFields fields;
  std::copy(contact.begin(), contact.end(), fields.component.begin());
  stress_->compute(tractions(), fields);
}

YieldError PlasticBody::evaluate(const double* pressure, double unit, const TractionRatio& shear) {
  if (region_.empty()) return {};
  const Box& box = region_.box;
  contact_stress(pressure, unit, shear);
  if (!residual_is_current_) {
    residual_stress(arrays(residual_));
    residual_is_current_ = true;
  }
  YieldError error;
  error.yield = try_stress();

  TrialState state;
  state.count = box.cuboids();
  state.trial = view(trial_);
  state.plastic_strain = p_early_.data();
  if (!layer_factor_.empty()) state.layer_factor = {layer_factor_.data(), static_cast<std::size_t>(box.nz)};
  MappedState result;
  result.increment = arrays(mapped_);
  result.plastic_strain = p_mapped_.data();
  result.moved = moved_.data();
  for (std::size_t block = 0; block < active_.size(); ++block) {
    if (active_[block] != 0) moved_[block] = 1;
  }
  map_to_yield(backend_.arena, backend_.kernels, law_, shear_modulus_, state, result);
  for (const std::int64_t block : blocks_) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t n = first; n < first + kBlock; ++n) mapped_[n] += early_[n];
  }

  bool more = false;
  for (std::size_t block = 0; block < active_.size(); ++block) {
    if (moved_[block] == 0 || active_[block] != 0) continue;
    const double* before = p_old_.data() + block * kBlock;
    if (std::equal(before, before + kBlock, p_mapped_.data() + block * kBlock)) continue;
    active_[block] = 1;
    more = true;
  }
  if (more) list_blocks();
  error.flow = distance_of_flow();
  return error;
}

std::unique_ptr<EigenstrainResponse> PlasticBody::response(const Box& box) const {
  if (response_ != nullptr) return std::make_unique<EigenstrainResponse>(*response_, box);
  return std::make_unique<EigenstrainResponse>(backend_, box, shear_modulus_, material_.poissons_ratio);
}

void PlasticBody::residual_stress(const TensorArrays& result) {
  const Box& box = region_.box;
  if (std::none_of(strain_.begin(), strain_.end(), [](double value) { return value != 0; })) {
    for (double* component : result) std::fill_n(component, box.cuboids(), 0.0);
    return;
  }
  if (response_ == nullptr) response_ = response(box);
  response_->resize(box);
  response_->stress(strain(), result);
}

/// Total and trial stress from the residual stress and the contact's, which is in trial_; YieldError::yield.
double PlasticBody::try_stress() {
  const std::size_t cuboids = region_.box.cuboids();
  const auto chunks = (static_cast<std::int64_t>(cuboids) + kChunk - 1) / kChunk;
  std::vector<double> worst(static_cast<std::size_t>(chunks));
  const double twice_mu = 2 * shear_modulus_;
  backend_.arena.for_chunks(static_cast<std::int64_t>(cuboids), kChunk, [&](std::int64_t from, std::int64_t to, int) {
    const auto begin = static_cast<std::size_t>(from), end = static_cast<std::size_t>(to);
    simd::StressArrays stress;
    for (std::size_t c = 0; c < kAll; ++c) {
      double* total = total_.data() + c * stride_;
      const double* residual = residual_.data() + c * stride_;
      double* tried = trial_.data() + c * stride_;
      const double* increment = d_.data() + c * stride_;
      for (std::size_t n = begin; n < end; ++n) {
        total[n] = residual[n] + tried[n];
        tried[n] = total[n] + twice_mu * increment[n];
      }
      stress.component[c] = total + begin;
    }
    for (std::size_t first = begin; first < end; first += kBlock) {
      if (active_[first / kBlock] != 0) part_flow(first, std::min(first + kBlock, end));
    }
    backend_.kernels.subsurface.von_mises(end - begin, stress, von_mises_.data() + begin);
    backend_.kernels.return_mapping.yield_stress(end - begin, law_.curve(), p_.data() + begin,
                                                 factor_.empty() ? nullptr : factor_.data() + begin,
                                                 yield_.data() + begin);
    double most = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const double excess = von_mises_[n] - yield_[n];
      const double error = (p_[n] > p_old_[n] ? std::fabs(excess) : excess) / yield_[n];
      most = std::max(most, error);
    }
    worst[begin / static_cast<std::size_t>(kChunk)] = most;
  });
  return *std::max_element(worst.begin(), worst.end());
}

/// YieldError::flow.
double PlasticBody::distance_of_flow() const {
  double most = 0;
  const std::size_t count = blocks_.size() / kAll;
  for (std::size_t at = 0; at < count; ++at) {
    const std::size_t first = static_cast<std::size_t>(blocks_[at]) * kBlock;
    for (std::size_t n = first; n < std::min(first + kBlock, region_.box.cuboids()); ++n) {
      double sum = 0;
      for (std::size_t c = 0; c < kAll; ++c) {
        sum += (c < 3 ? 1 : 2) * square(mapped_[c * stride_ + n] - d_[c * stride_ + n]);
      }
      most = std::max(most, sum / square(yield_[n]));
    }
  }
  return 2 * shear_modulus_ * std::sqrt(1.5 * most);
}

AndersonPart PlasticBody::unknowns() {
  return {d_.data(), mapped_.data(), d_.size(), blocks_};
}

void PlasticBody::confine() {
  const std::size_t count = blocks_.size() / kAll;
  for (std::size_t at = 0; at < count; ++at) {
    const std::size_t first = static_cast<std::size_t>(blocks_[at]) * kBlock;
    for (std::size_t n = first; n < first + kBlock; ++n) {
      if (p_mapped_[n] > p_old_[n]) continue;
      for (std::size_t c = 0; c < kAll; ++c) d_[c * stride_ + n] = 0;
    }
  }
  combine();
}

double PlasticBody::accept() {
  const double work = plastic_work();
  for (const std::int64_t block : blocks_) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    std::copy_n(strain_.begin() + first, kBlock, old_.begin() + first);
  }
  std::copy(total_.begin(), total_.end(), stress_old_.begin());
  for (Buffer<double>* before : {&p_old_, &p_mapped_, &p_early_}) std::copy(p_.begin(), p_.end(), before->begin());
  std::fill(moved_.begin(), moved_.end(), std::uint8_t{1});
  accepted_ = true;
  return work;
}

LargestPlasticStrain PlasticBody::largest() const {
  LargestPlasticStrain result;
  const Box& box = region_.box;
  std::size_t at = 0;
  for (std::size_t n = 0; n < box.cuboids(); ++n) {
    if (!(p_[n] > 0)) continue;
    ++result.cuboids;
    if (p_[n] > result.value) {
      result.value = p_[n];
      at = n;
    }
  }
  if (result.cuboids == 0) return result;
  const auto n = static_cast<std::int64_t>(at);
  const std::int64_t layer = n / (box.nx * box.ny);
  result.at = {grid_.x(region_.i0 + n % box.nx), grid_.y(region_.j0 + n / box.nx % box.ny),
               (static_cast<double>(layer) + 0.5) * box.dz};
  return result;
}

PlasticBody::State PlasticBody::state() const {
  return {region_, copy_of(old_), copy_of(d_), copy_of(stress_old_), copy_of(p_old_)};
}

void PlasticBody::restore(const State& state) {
  if (state.region.empty()) {
    region_ = {};
    stride_ = 0;
    blocks_.clear();
    active_.clear();
    return;
  }
  old_ = copy_of(state.strain);
  d_ = copy_of(state.increment);
  stress_old_ = copy_of(state.stress);
  p_old_ = copy_of(state.equivalent);
  const bool same = region_.box == state.region.box;  // wherever it lies
  std::unique_ptr<subsurface::StressField> stress = std::move(stress_);
  region_ = state.region;
  stride_ = old_.size() / kAll;
  move_to(Region(region_));
  if (!same) return;
  stress_ = std::move(stress);
}

std::size_t PlasticBody::bytes(const fft::Backend& backend, const Grid& grid, const Layers& layers,
                               std::size_t spectra_limit, subsurface::Sources sources) {
  const Box box{grid.nx, grid.ny, layers.count, grid.dx, grid.dy, layers.thickness};
  subsurface::StressRequest request;
  request.grid = grid;
  request.depths = subsurface::layer_depths(layers.count, layers.thickness);
  request.components = subsurface::kAllComponents;
  request.sources = sources;
  const subsurface::StressPlan stress = subsurface::plan_stress(backend, request, spectra_limit);
  request.components = {};
  request.invariants = {subsurface::Invariant::von_mises};
  const std::size_t below = subsurface::plan_stress(backend, request, 0).work_bytes;
  const EigenstrainResponse::Bytes response = EigenstrainResponse::bytes(backend, box);
  const EigenstrainResponse::Bytes surface =
      EigenstrainDisplacement::bytes(backend, grid, layers.count, layers.thickness);
  const std::size_t shears = static_cast<std::size_t>(sources.has(subsurface::Traction::shear_x)) +
                             static_cast<std::size_t>(sources.has(subsurface::Traction::shear_y));
  constexpr std::size_t kFields = 2 * 9 * kAll + 7;  // while the box grows, some twice; and the state to go back to
  return stress.kept_bytes + stress.work_bytes + below + response.spectra + response.work + response.potentials +
         surface.spectra + surface.work + std::max(response.generation, surface.generation) +
         kFields * Buffer<double>::padded_bytes(box.cuboids()) +
         (3 + shears) * Buffer<double>::padded_bytes(grid.nodes());
}

}  // namespace brinell::plastic
