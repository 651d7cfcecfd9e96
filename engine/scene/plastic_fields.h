// Fields of the bodies that harden, on all nodes and layers of the scene, made when they are asked for: plastic
// strain lies in a box that is mostly smaller, and the residual stress outside that box interests nobody but a reader
// of fields.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>

#include "base/buffer.h"
#include "plastic/elastic_plastic.h"
#include "scene/engine.h"
#include "scene/field.h"
#include "scene/scene.h"

namespace brinell::scene {

class PlasticFields {
 public:
  /// All outlive this.
  PlasticFields(Engine& engine, const Scene& scene, plastic::ElasticPlastic& pair)
      : engine_(engine), scene_(scene), pair_(pair) {}

  /// What was made belongs to an earlier state.
  void forget() { made_.clear(); }

  /// Values as brn_run_get_field gives them.
  const Buffer<double>& field(Field field);

  /// Six fields of all nodes and layers, one after the other [Pa].
  const Buffer<double>& residual_stress(Which body);

  /// The most that the residual stress of one body takes.
  static std::size_t bytes(Engine& engine, const Scene& scene);

 private:
  plastic::PlasticBody& body(Which which) const;
  Buffer<double> spread(const plastic::PlasticBody& body, const double* values) const;

  Engine& engine_;
  const Scene& scene_;
  plastic::ElasticPlastic& pair_;
  std::array<std::unique_ptr<plastic::EigenstrainResponse>, 2> response_;  // of the whole grid; null until needed
  std::map<Field, Buffer<double>> made_;
  std::map<Which, Buffer<double>> residual_;
};

}  // namespace brinell::scene
