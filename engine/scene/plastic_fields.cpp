#include "scene/plastic_fields.h"

#include <algorithm>

namespace brinell::scene {

namespace {

plastic::Box whole_box(const Scene& scene) {
  const Grid& grid = scene.grid();
  return {grid.nx, grid.ny, scene.layers().count, grid.dx, grid.dy, scene.layers().thickness};
}

/// Components of a node side by side.
Buffer<double> interleaved(const Buffer<double>& components, std::size_t count) {
  auto result = Buffer<double>::uninitialised(components.size());
  const std::size_t width = components.size() / count;
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t n = 0; n < count; ++n) result[n * width + c] = components[c * count + n];
  }
  return result;
}

}  // namespace

plastic::PlasticBody& PlasticFields::body(Which which) const {
  return *pair_.body(pair_.identical() ? 0 : static_cast<int>(which));
}

/// From the body's box to all nodes and layers.
Buffer<double> PlasticFields::spread(const plastic::PlasticBody& body, const double* values) const {
  const plastic::Box whole = whole_box(scene_);
  Buffer<double> result(whole.cuboids());
  const plastic::Region& region = body.region();
  for (std::int64_t k = 0; k < region.box.nz; ++k) {
    for (std::int64_t j = 0; j < region.box.ny; ++j) {
      std::copy_n(values + (k * region.box.ny + j) * region.box.nx, region.box.nx,
                  result.data() + (k * whole.ny + region.j0 + j) * whole.nx + region.i0);
    }
  }
  return result;
}

const Buffer<double>& PlasticFields::residual_stress(Which which) {
  const plastic::PlasticBody& one = body(which);
  const plastic::Box box = whole_box(scene_);
  Buffer<double>& result = residual_[which];
  if (result.empty()) result = Buffer<double>::uninitialised(6 * box.cuboids());
  plastic::TensorArrays target{};
  for (std::size_t c = 0; c < 6; ++c) {
    target[c] = result.data() + c * box.cuboids();
    const Buffer<double> strain = spread(one, one.strain()[c]);
    std::copy(strain.begin(), strain.end(), target[c]);
  }
  if (std::none_of(result.begin(), result.end(), [](double value) { return value != 0; })) return result;
  auto& response = response_[pair_.identical() ? 0 : static_cast<std::size_t>(which)];
  if (response == nullptr) response = one.response(box);
  response->stress({target[0], target[1], target[2], target[3], target[4], target[5]}, target);
  return result;
}

const Buffer<double>& PlasticFields::field(Field field) {
  const auto found = made_.find(field);
  if (found != made_.end()) return found->second;
  plastic::PlasticBody& one = body(body_of(field));
  const std::size_t count = whole_box(scene_).cuboids();
  Buffer<double> values;
  const auto of_lower =
      static_cast<Field>(static_cast<std::int32_t>(field) - (body_of(field) == Which::upper ? kUpperField : 0));
  switch (of_lower) {
    case Field::residual_displacement:
      values = Buffer<double>(scene_.grid().nodes());
      one.add_displacement(1, values.data());
      break;
    case Field::equivalent_plastic_strain: values = spread(one, one.equivalent().data()); break;
    case Field::plastic_strain: {
      Buffer<double> components = Buffer<double>::uninitialised(6 * count);
      for (std::size_t c = 0; c < 6; ++c) {
        const Buffer<double> component = spread(one, one.strain()[c]);
        std::copy(component.begin(), component.end(), components.data() + c * count);
      }
      values = interleaved(components, count);
      break;
    }
    default: values = interleaved(residual_stress(body_of(field)), count); break;
  }
  return made_[field] = std::move(values);
}

std::size_t PlasticFields::bytes(Engine& engine, const Scene& scene) {
  const plastic::Box box = whole_box(scene);
  const auto response = plastic::EigenstrainResponse::bytes(engine.resources().backend, box);
  constexpr std::size_t kFields = 2 * 6 + 1;  // total and residual stress, one on its way
  return response.spectra + response.work + response.generation +
         kFields * Buffer<double>::padded_bytes(box.cuboids());
}

}  // namespace brinell::scene
