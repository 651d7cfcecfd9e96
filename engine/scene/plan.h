// What a run will do and hold, known before anything is allocated.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/engine.h"
#include "scene/scene.h"

namespace brinell::scene {

struct PlanItem {
  const char* stage;  // "surface", "contact", "plastic", "stress"
  std::string what;
  std::uint64_t bytes;
};

struct Plan {
  std::vector<PlanItem> items;
  std::uint64_t memory_bytes = 0;           // of all items
  std::uint64_t plastic_spectra_limit = 0;  // bytes of coefficients of the stress that a body that hardens may keep
  std::uint64_t stress_spectra_limit = 0;   // bytes of influence coefficients that the stress of each body may keep

  /// Throws Status::too_large if the scene needs more than the engine allows.
  Plan(Engine& engine, const Scene& scene);
};

}  // namespace brinell::scene
