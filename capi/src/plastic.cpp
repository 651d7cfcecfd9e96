#include <brinell.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "handles.h"
#include "hardening.h"
#include "plastic/return_mapping.h"
#include "structs.h"

namespace brinell::capi {

namespace {

plastic::HardeningLaw to_law(const brn_hardening& h) {
  switch (h.law) {
    case BRN_HARDENING_SWIFT: return plastic::Swift{h.B, h.C, h.n, h.strain_scale};
    case BRN_HARDENING_LINEAR: return plastic::LinearHardening{h.yield_stress, h.hardening_modulus};
    case BRN_HARDENING_PERFECT: return plastic::PerfectPlasticity{h.yield_stress};
    case BRN_HARDENING_VOCE: return plastic::Voce{h.yield_stress, h.saturation_stress, h.rate};
    case BRN_HARDENING_RAMBERG_OSGOOD: return plastic::RambergOsgood{h.K, h.m, h.yield_stress};
    case BRN_HARDENING_TABLE: {
      if (h.point_count > 0) {
        require(h.plastic_strain, "plastic_strain");
        require(h.stress, "stress");
      }
      return plastic::HardeningTable{{h.plastic_strain, h.plastic_strain + h.point_count},
                                     {h.stress, h.stress + h.point_count}};
    }
    default:
      fail(Status::invalid_argument,
           "law = " + std::to_string(h.law) + ": allowed are BRN_HARDENING_SWIFT (1) to BRN_HARDENING_TABLE (6)");
  }
}

}  // namespace

plastic::Hardening to_hardening(const brn_hardening* user, const char* name) {
  const auto h = read(user, name, brn_hardening_init, &brn_hardening::law, &brn_hardening::B, &brn_hardening::C,
                      &brn_hardening::n, &brn_hardening::strain_scale, &brn_hardening::yield_stress,
                      &brn_hardening::hardening_modulus, &brn_hardening::saturation_stress, &brn_hardening::rate,
                      &brn_hardening::K, &brn_hardening::m, &brn_hardening::plastic_strain, &brn_hardening::stress,
                      &brn_hardening::point_count, &brn_hardening::depths, &brn_hardening::depth_factors,
                      &brn_hardening::depth_count);
  plastic::Hardening hardening{to_law(h), {}};
  if (h.depth_count > 0) {
    require(h.depths, "depths");
    require(h.depth_factors, "depth_factors");
  }
  for (std::size_t k = 0; k < h.depth_count; ++k) hardening.depth_factor.push_back({h.depths[k], h.depth_factors[k]});
  return hardening;
}

}  // namespace brinell::capi

using namespace brinell;
using namespace brinell::capi;

namespace {

std::string indexed(const char* name, std::size_t k) {
  return std::string(name) + "[" + std::to_string(k) + "]";
}

plastic::TrialState to_state(const brn_return_points& p) {
  plastic::TrialState state;
  state.count = p.count;
  for (std::size_t c = 0; c < 6 && p.count > 0; ++c) require(p.trial[c], indexed("trial", c).c_str());
  if (p.count > 0) require(p.plastic_strain, "plastic_strain");
  std::copy(p.trial, p.trial + 6, state.trial.begin());
  state.plastic_strain = p.plastic_strain;
  return state;
}

plastic::MappedState to_mapped(const brn_return_result& r, std::size_t count) {
  plastic::MappedState mapped;
  for (std::size_t c = 0; c < 6 && count > 0; ++c) require(r.increment[c], indexed("increment", c).c_str());
  if (count > 0) require(r.plastic_strain, "plastic_strain");
  const auto given = std::count_if(r.stress, r.stress + 6, [](const double* array) { return array != nullptr; });
  if (given != 0 && given != 6) {
    fail(Status::invalid_argument,
         "stress: " + std::to_string(given) + " of 6 arrays are given; allowed are all or none");
  }
  if (r.capacity < count) {
    fail(Status::short_buffer, "capacity = " + std::to_string(r.capacity) +
                                   " doubles in each array of result; needed are " + std::to_string(count));
  }
  std::copy(r.increment, r.increment + 6, mapped.increment.begin());
  std::copy(r.stress, r.stress + 6, mapped.stress.begin());
  mapped.plastic_strain = r.plastic_strain;
  mapped.von_mises = r.von_mises;
  mapped.theta = r.theta;
  mapped.theta_bar = r.theta_bar;
  return mapped;
}

/// Of the layers; none where the law is the same at every depth.
std::vector<double> layer_factors(const plastic::YieldCurve& law, bool with_depth, const brn_return_points& p) {
  if (!with_depth) return {};
  if (p.layer_count == 0) {
    fail(Status::invalid_argument,
         "layer_count = 0: the hardening depends on the depth, so that layer_depths are "
         "needed");
  }
  require(p.layer_depths, "layer_depths");
  return law.factors_at({p.layer_depths, p.layer_count});
}

}  // namespace

extern "C" {

brn_status brn_scene_set_hardening(brn_scene* scene, int32_t which, const brn_hardening* hardening) {
  return guarded_use(scene, "scene", [&] {
    if (which != BRN_LOWER && which != BRN_UPPER) {
      fail(Status::invalid_argument, "which = " + std::to_string(which) + ": allowed are 0 (lower) and 1 (upper)");
    }
    std::optional<plastic::Hardening> law;
    if (hardening != nullptr &&
        read(hardening, "hardening", brn_hardening_init, &brn_hardening::law).law != BRN_HARDENING_NONE) {
      law = to_hardening(hardening, "hardening");
    }
    scene->scene.set_hardening(static_cast<scene::Which>(which), law);
  });
}

brn_status brn_scene_set_layers(brn_scene* scene, int64_t layers, double thickness) {
  return guarded_use(scene, "scene", [&] { scene->scene.set_layers({layers, thickness}); });
}

brn_status brn_scene_set_identical(brn_scene* scene, int32_t identical) {
  return guarded_use(scene, "scene", [&] {
    if (identical != 0 && identical != 1) {
      fail(Status::invalid_argument, "identical = " + std::to_string(identical) + ": allowed are 0 and 1");
    }
    scene->scene.set_identical(identical != 0);
  });
}

brn_status brn_return_map_batch(brn_engine* engine, const brn_hardening* hardening, const brn_return_points* points,
                                const brn_return_result* result, int64_t* plastic_count) {
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(engine, "engine");
    const plastic::Hardening described = to_hardening(hardening, "hardening");
    const plastic::YieldCurve law(described);
    const auto p =
        read(points, "points", brn_return_points_init, &brn_return_points::count, &brn_return_points::shear_modulus,
             &brn_return_points::trial, &brn_return_points::plastic_strain, &brn_return_points::layer_depths,
             &brn_return_points::layer_count);
    const auto r =
        read(result, "result", brn_return_result_init, &brn_return_result::capacity, &brn_return_result::increment,
             &brn_return_result::plastic_strain, &brn_return_result::von_mises, &brn_return_result::stress,
             &brn_return_result::theta, &brn_return_result::theta_bar);
    plastic::TrialState state = to_state(p);
    const plastic::MappedState mapped = to_mapped(r, p.count);
    const std::vector<double> factors = layer_factors(law, !described.depth_factor.empty(), p);
    state.layer_factor = factors;
    const std::int64_t yielded =
        plastic::map_to_yield(engine->engine.arena(), engine->engine.kernels(), law, p.shear_modulus, state, mapped);
    if (plastic_count != nullptr) *plastic_count = yielded;
  });
}
}
