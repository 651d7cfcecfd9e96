// Error against seconds: one load of a scene solved many times, over tolerances or over grids, by each method.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene_file.h"

namespace brinell::bench {

enum class SweepKind { tolerance, grid };

struct SweepPoint {
  std::string method;  // "textbook", "double", "mixed"
  std::int64_t nx, ny;
  double tolerance;
  double seconds = 0;  // median of process CPU time, warm
  double error = 0;    // relative, of what the sweep is about
  double certificate = 0;
  std::int32_t iterations = 0;
  std::int32_t convolutions = 0;
  bool on_front = false;  // no other point is both faster and more accurate
};

struct Sweep {
  SweepKind kind;
  std::string error_of;  // in words
  std::vector<SweepPoint> points;
};

struct SweepOptions {
  std::size_t step = 0;  // the load: that of this step of the scene, in one increment from zero
  int rounds = 4;
  std::int64_t textbook_nodes = std::int64_t{1024} * 1024;  // larger grids are left to the engine
};

/// The scene's grid, tolerances from 1e-2 to 1e-10. Error: of the pressure, root mean square over the grid, against
/// the solution to 1e-12.
Sweep sweep_tolerances(const cli::SceneFile& scene, const SweepOptions& options);

/// Grids from `coarsest` to `finest` nodes in x over the same lengths. Error: of the approach, against Hertz's theory
/// for a sphere, else against the grid of twice the finest. None for surfaces from files.
std::optional<Sweep> sweep_grids(const cli::SceneFile& scene, const SweepOptions& options, std::int64_t coarsest,
                                 std::int64_t finest);

}  // namespace brinell::bench
