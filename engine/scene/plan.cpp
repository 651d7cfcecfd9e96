#include "scene/plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "contact/solver.h"
#include "plastic/elastic_plastic.h"
#include "scene/load_history.h"
#include "scene/stress_stage.h"
#include "scene/undeformed_gap.h"

namespace brinell::scene {

namespace {

void refuse_beyond(std::uint64_t limit, double bytes, const Grid& grid, const char* how) {
  if (bytes <= static_cast<double>(limit)) return;
  fail(Status::too_large, "the grid of " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) +
                              " nodes needs " + how + text(bytes) + " bytes; allowed are " + std::to_string(limit));
}

/// Whether the upper body moves between increments.
bool moves_on(const std::vector<Step>& steps) {
  return std::any_of(steps.begin() + 1, steps.end(), [](const Step& step) { return step.moves(); });
}

}  // namespace

Plan::Plan(Engine& engine, const Scene& scene) {
  const Grid& grid = scene.grid();
  // Fields alone, before even the transforms of such a grid are planned.
  constexpr double kFewestFields = 6;
  refuse_beyond(engine.memory_limit(),
                kFewestFields * sizeof(double) * static_cast<double>(grid.nx) * static_cast<double>(grid.ny), grid,
                "at least ");

  const std::uint64_t field = Buffer<double>::padded_bytes(grid.nodes());
  items.push_back({"surface", "undeformed gap", field});
  for (const contact::SolverPart& part :
       contact::Solver::parts(engine.resources().backend, grid, scene.boundary(), scene.solver().mixed_precision)) {
    items.push_back({"contact", part.what, part.bytes});
  }
  if (total_increments(scene.steps()) > 1) items.push_back({"contact", "last solved pressure, to go back to", field});
  const bool moves = moves_on(scene.steps());
  if (moves) items.push_back({"surface", "gap before the upper body moves, to go back to", field});
  if (moves_node_values(scene)) items.push_back({"surface", "heights of the upper body on their way", field});
  for (const PlanItem& item : items) memory_bytes += item.bytes;
  refuse_beyond(engine.memory_limit(), static_cast<double>(memory_bytes), grid, "");

  if (scene.hardens()) {
    const fft::Backend backend = engine.resources().backend;
    plastic::TractionRatio any{};
    for (const Step& step : scene.steps()) {
      for (std::size_t axis = 0; axis < 2; ++axis) any[axis] += std::fabs(step.traction_ratio[axis]);
    }
    const auto of_body = [&](std::size_t limit) {
      return plastic::PlasticBody::bytes(backend, grid, scene.layers(), limit, plastic::sources_of(any));
    };
    std::vector<const char*> bodies;
    for (const Which which : {Which::lower, Which::upper}) {
      if (!scene.hardens(which) || (which == Which::upper && scene.identical())) continue;
      bodies.push_back(which == Which::upper ? "the upper body"
                       : scene.identical()   ? "both bodies"
                                             : "the lower body");
    }
    const std::size_t unknowns = bodies.size() * 6 * grid.nodes() * static_cast<std::size_t>(scene.layers().count);
    items.push_back({"plastic", "gap with the residual displacement", field});
    items.push_back(
        {"plastic", "acceleration, if all cuboids flow", plastic::ElasticPlastic::acceleration_bytes(unknowns)});
    if (moves) {
      const std::size_t cuboids = grid.nodes() * static_cast<std::size_t>(scene.layers().count);
      items.push_back({"plastic", "plastic strain before the upper body moves, to go back to",
                       bodies.size() * plastic::PlasticBody::state_bytes(cuboids)});
    }
    std::uint64_t fixed = 0;
    for (const PlanItem& item : items) fixed += item.bytes;
    const std::uint64_t smallest = fixed + bodies.size() * of_body(0);
    refuse_beyond(engine.memory_limit(), static_cast<double>(smallest), grid, "");
    plastic_spectra_limit = std::min(engine.cache_limit(), engine.memory_limit() - smallest) / (2 * bodies.size());
    for (const char* body : bodies) {
      items.push_back({"plastic", "cuboids of " + std::string(body) + ", if the box takes all layers and nodes",
                       of_body(plastic_spectra_limit)});
    }
    memory_bytes = 0;
    for (const PlanItem& item : items) memory_bytes += item.bytes;
  }

  std::uint64_t least = memory_bytes;
  for (const StressStagePart& part : StressStage::parts(engine, scene, 0)) least += part.bytes;
  refuse_beyond(engine.memory_limit(), static_cast<double>(least), grid, "");
  if (total_increments(scene.steps()) > 1) {
    stress_spectra_limit = std::min(engine.cache_limit(), engine.memory_limit() - least) / 2;
  }
  for (const StressStagePart& part : StressStage::parts(engine, scene, stress_spectra_limit)) {
    items.push_back({"stress", part.what, part.bytes});
    memory_bytes += part.bytes;
  }
}

}  // namespace brinell::scene
