// Error against seconds: a scene solved many times, over tolerances, grids or increments, by each method.
//
// Elastic scenes: one load of the scene from zero, beside the textbook. Scenes that harden: the load history up to
// and with one step; there is no textbook.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene_file.h"

namespace brinell::bench {

enum class SweepKind { tolerance, grid, increments };

struct SweepPoint {
  std::string method;    // "textbook", "double", "mixed", or how increments are chosen
  std::string quantity;  // whose error it is
  std::string label;     // what is swept
  std::int64_t nx = 0, ny = 0;
  double tolerance = 0;
  std::int32_t increments = 1;  // solved, in all steps
  double seconds = 0;           // median of process CPU time, warm
  double error = 0;             // relative
  double certificate = 0;       // of the last increment
  std::int32_t iterations = 0;  // in all increments, as convolutions
  std::int32_t convolutions = 0;
  bool on_front = false;  // no other point is both faster and more accurate in this quantity
};

struct Sweep {
  SweepKind kind;
  std::string reference;  // what errors are against, in words
  std::vector<SweepPoint> points;
};

struct SweepOptions {
  std::size_t step = 0;  // elastic: its load alone, in one increment; hardening: the last step of the history
  int rounds = 4;
  std::int64_t nodes = 0;           // in x, of the sweeps over tolerance and increments; 0: the scene's
  std::vector<std::int64_t> grids;  // nodes in x, rising
  std::int64_t reference_grid = 0;  // nodes in x; 0: twice the finest
  std::vector<std::int32_t> increments{3, 4, 6, 8, 12, 16, 24, 32, 48};  // of the last step
  std::int64_t textbook_nodes = std::int64_t{1024} * 1024;               // larger grids are left to the engine
};

/// Tolerances from 1e-2 to 1e-10. Error: of the pressure, root mean square over the grid, against the solution to
/// 1e-12.
Sweep elastic_tolerances(const cli::SceneFile& scene, const SweepOptions& options);

/// Error: of the approach, of the tilt where the force acts beside the centre; against Hertz's theory for a sphere,
/// else against the reference grid. None for surfaces from files.
std::optional<Sweep> elastic_grids(const cli::SceneFile& scene, const SweepOptions& options);

/// Bodies that harden. Errors: of the approach, the largest pressure and the largest equivalent plastic strain after
/// the last increment; over tolerances from 1e-2 to 1e-8 against 1e-10,
Sweep plastic_tolerances(const cli::SceneFile& scene, const SweepOptions& options);
/// over grids against the reference grid,
Sweep plastic_grids(const cli::SceneFile& scene, const SweepOptions& options);
/// over increments against the most, two and four times as many, extrapolated by their own order.
Sweep plastic_increments(const cli::SceneFile& scene, const SweepOptions& options);

}  // namespace brinell::bench
