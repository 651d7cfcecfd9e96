#include "scene/stress_stage.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace brinell::scene {

namespace {

constexpr std::int64_t kNodesOfChunk = 4096;
constexpr Which kBodies[] = {Which::lower, Which::upper};

subsurface::Sources sources_of(const Step& step) {
  subsurface::Sources sources{subsurface::Traction::pressure};
  if (step.traction_ratio[0] != 0) sources.add(subsurface::Traction::shear_x);
  if (step.traction_ratio[1] != 0) sources.add(subsurface::Traction::shear_y);
  return sources;
}

std::size_t field_values(const Scene& scene, Field field) {
  return scene.grid().nodes() * scene.subsurface().depths.size() * values_per_node(field);
}

subsurface::StressRequest request_for(const Scene& scene, Which body, subsurface::Sources sources) {
  const Subsurface& wanted = scene.subsurface();
  subsurface::StressRequest request;
  request.grid = scene.grid();
  request.boundary = scene.boundary();
  request.body = body == Which::lower ? subsurface::Body::lower : subsurface::Body::upper;
  request.poissons_ratio = scene.body(body).poissons_ratio;
  request.depths = wanted.depths;
  request.sources = sources;
  for (const Field field : wanted.fields) {
    if (!is_stress(field) || body_of(field) != body) continue;
    if (const auto invariant = invariant_of(field)) {
      request.invariants.add(*invariant);
    } else if (lower_field(field) == Field::stress) {
      request.components = subsurface::kAllComponents;
    } else {
      request.directions = true;
    }
  }
  if (wanted.wants_max_von_mises(body)) request.maxima.add(subsurface::Invariant::von_mises);
  return request;
}

/// The contact's part alone of a body that hardens; the rest follows from the total.
subsurface::StressRequest contact_request_for(const Scene& scene, Which body, subsurface::Sources sources) {
  subsurface::StressRequest request = request_for(scene, body, sources);
  if (!scene.hardens(body)) return request;
  request.components = subsurface::kAllComponents;
  request.invariants = {};
  request.directions = false;
  request.maxima = {};
  return request;
}

LargestVonMises largest(const subsurface::Maximum& maximum) {
  LargestVonMises result;
  result.value = maximum.value;
  if (maximum.value > 0) std::copy(maximum.position.begin(), maximum.position.end(), result.at);
  return result;
}

}  // namespace

StressStage::StressStage(Engine& engine, const Scene& scene, std::size_t spectra_limit)
    : engine_(engine), scene_(scene), spectra_limit_(spectra_limit) {}

std::vector<StressStagePart> StressStage::parts(Engine& engine, const Scene& scene, std::size_t spectra_limit) {
  const Subsurface& wanted = scene.subsurface();
  std::vector<StressStagePart> parts;
  for (const Field field : wanted.fields) {
    if (!is_stress(field)) continue;
    parts.push_back({"field " + name(field) + " on " + std::to_string(wanted.depths.size()) + " layers",
                     Buffer<double>::padded_bytes(field_values(scene, field))});
  }
  const std::size_t surface_field = Buffer<double>::padded_bytes(scene.grid().nodes());
  std::size_t shears = 0;
  for (const Which body : kBodies) {
    if (!wanted.wants(body)) continue;
    std::size_t kept = 0, work = 0;
    std::vector<subsurface::Sources> seen;
    for (const Step& step : scene.steps()) {
      if (std::find(seen.begin(), seen.end(), sources_of(step)) != seen.end()) continue;
      seen.push_back(sources_of(step));
      const auto plan = subsurface::plan_stress(engine.resources().backend,
                                                contact_request_for(scene, body, sources_of(step)), spectra_limit);
      kept = std::max(kept, plan.kept_bytes);
      work = std::max(work, plan.work_bytes);
      shears = std::max<std::size_t>(shears, (step.traction_ratio[0] != 0 ? 1 : 0) + (step.traction_ratio[1] != 0));
    }
    const std::string of_body = body == Which::lower ? " of the lower body" : " of the upper body";
    if (kept > 0) parts.push_back({"coefficients kept for the next increment" + of_body, kept});
    parts.push_back({"transforms, layers under way" + of_body, work});
    if (scene.hardens(body)) {
      parts.push_back({"total and residual stress" + of_body, PlasticFields::bytes(engine, scene)});
    }
  }
  if (!parts.empty()) parts.push_back({shears > 0 ? "pressure and shear" : "pressure", (1 + shears) * surface_field});
  return parts;
}

subsurface::StressField& StressStage::stress_field(Which body, subsurface::Sources sources) {
  BodyStress& one = bodies_[static_cast<std::size_t>(body)];
  if (one.field == nullptr || !(one.sources == sources)) {
    one.field.reset();  // before the next takes its memory
    one.field = std::make_unique<subsurface::StressField>(engine_.resources().backend,
                                                          contact_request_for(scene_, body, sources), spectra_limit_);
    one.sources = sources;
  }
  return *one.field;
}

std::array<LargestVonMises, 2> StressStage::compute(const double* pressure, double unit, const Step& step,
                                                    FunctionRef<bool()> proceed, PlasticFields* plastic) {
  has_fields_ = false;
  const std::size_t nodes = scene_.grid().nodes();
  std::array<Buffer<double>, subsurface::kTractions> tractions;
  const auto scaled = [&](double factor) {
    auto values = Buffer<double>::uninitialised(nodes);
    std::transform(pressure, pressure + nodes, values.data(), [&](double p) { return p * factor; });
    return values;
  };
  tractions[0] = scaled(unit);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (step.traction_ratio[axis] != 0) tractions[1 + axis] = scaled(step.traction_ratio[axis] * unit);
  }
  for (const Field field : scene_.subsurface().fields) {
    if (!is_stress(field)) continue;
    Buffer<double>& values = fields_[field];
    if (values.empty()) values = Buffer<double>::uninitialised(field_values(scene_, field));
  }

  std::array<LargestVonMises, 2> result;
  for (const Which body : kBodies) {
    if (!scene_.subsurface().wants(body)) continue;
    const auto take = [&](const subsurface::StressLayer& layer) {
      keep(body, layer);
      if (!proceed()) fail(Status::cancelled, "the progress callback asked to stop");
    };
    const subsurface::Tractions given{tractions[0].data(), tractions[1].data(), tractions[2].data()};
    subsurface::StressField& contact = stress_field(body, sources_of(step));
    const subsurface::Maxima maxima = plastic != nullptr && scene_.hardens(body)
                                          ? compute_total(body, contact, given, *plastic, take)
                                          : contact.compute_by_layer(given, take);
    if (scene_.subsurface().wants_max_von_mises(body)) {
      result[static_cast<std::size_t>(body)] =
          largest(maxima[static_cast<std::size_t>(subsurface::Invariant::von_mises)]);
    }
  }
  has_fields_ = true;
  return result;
}

/// Contact and residual stress together, then what the scene asks for, layer by layer.
subsurface::Maxima StressStage::compute_total(Which body, subsurface::StressField& contact,
                                              const subsurface::Tractions& tractions, PlasticFields& plastic,
                                              FunctionRef<void(const subsurface::StressLayer&)> take) {
  const subsurface::StressRequest wanted = request_for(scene_, body, {subsurface::Traction::pressure});
  const std::size_t nodes = scene_.grid().nodes(), all = nodes * wanted.depths.size();
  auto stress = Buffer<double>::uninitialised(6 * all);
  subsurface::StressFields fields;
  for (std::size_t c = 0; c < 6; ++c) fields.component[c] = stress.data() + c * all;
  contact.compute(tractions, fields);
  const Buffer<double>& residual = plastic.residual_stress(body);
  for (std::size_t n = 0; n < stress.size(); ++n) stress[n] += residual[n];

  const subsurface::Invariants invariants = wanted.invariants | wanted.maxima;
  std::array<std::array<Buffer<double>, 2>, subsurface::kInvariants> values;  // of this layer and the one before
  auto directions = Buffer<double>::uninitialised(wanted.directions ? 9 * nodes : 0);
  std::vector<subsurface::MaximumSearch> search(subsurface::kInvariants,
                                                {wanted.grid, wanted.boundary, wanted.depths});
  for (std::size_t layer = 0; layer < wanted.depths.size(); ++layer) {
    subsurface::StressLayer shown{static_cast<std::int64_t>(layer), wanted.depths[layer], {}, {}, {}};
    simd::StressArrays tensors;
    for (std::size_t c = 0; c < 6; ++c) {
      tensors.component[c] = stress.data() + c * all + layer * nodes;
      shown.component[c] = tensors.component[c];
    }
    subsurface::InvariantArrays result;
    for (std::size_t k = 0; k < subsurface::kInvariants; ++k) {
      if (!invariants.has(static_cast<int>(k))) continue;
      Buffer<double>& of_layer = values[k][layer % 2];
      if (of_layer.empty()) of_layer = Buffer<double>::uninitialised(nodes);
      result.invariant[k] = of_layer.data();
      shown.invariant[k] = of_layer.data();
    }
    for (std::size_t k = 0; wanted.directions && k < 9; ++k) {
      result.direction[k] = directions.data() + k * nodes;
      shown.direction[k] = result.direction[k];
    }
    subsurface::fill_invariants(engine_.kernels(), nodes, tensors, result);
    for (std::size_t k = 0; k < subsurface::kInvariants; ++k) {
      if (!wanted.maxima.has(static_cast<int>(k))) continue;
      search[k].take(result.invariant[k], engine_.kernels().subsurface.largest(nodes, result.invariant[k]),
                     layer > 0 ? values[k][(layer + 1) % 2].data() : nullptr);
    }
    take(shown);
  }
  subsurface::Maxima maxima{};
  for (std::size_t k = 0; k < subsurface::kInvariants; ++k) {
    if (wanted.maxima.has(static_cast<int>(k))) maxima[k] = search[k].result();
  }
  return maxima;
}

/// Copies a layer of one body into the fields, components of a node side by side.
void StressStage::keep(Which body, const subsurface::StressLayer& layer) {
  const auto nodes = static_cast<std::int64_t>(scene_.grid().nodes());
  for (auto& entry : fields_) {
    const Field field = entry.first;
    Buffer<double>& values = entry.second;
    if (body_of(field) != body) continue;
    const auto width = static_cast<std::int64_t>(values_per_node(field));
    double* target = values.data() + layer.layer * nodes * width;
    const auto invariant = invariant_of(field);
    engine_.arena().for_chunks(nodes, kNodesOfChunk, [&](std::int64_t begin, std::int64_t end, int) {
      if (invariant) {
        const double* source = layer.invariant[static_cast<std::size_t>(*invariant)];
        std::copy(source + begin, source + end, target + begin);
        return;
      }
      const double* const* sources =
          lower_field(field) == Field::stress ? layer.component.data() : layer.direction.data();
      for (std::int64_t n = begin; n < end; ++n) {
        for (std::int64_t c = 0; c < width; ++c) target[n * width + c] = sources[c][n];
      }
    });
  }
}

}  // namespace brinell::scene
