// The contacts that solvers are compared on, on n × n nodes over a square of unit side.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contact/problem.h"
#include "parallel/arena.h"

namespace brinell::bench {

constexpr double kPunchRadius = 0.5 / 1.4;  // of the scene "punch"

struct SolveScene {
  std::string name;
  std::string words;
  Boundary boundary;
  double mean_pressure;  // [E*]
  bool by_approach;      // the approach that this mean pressure makes is prescribed instead

  Grid grid(std::int64_t n) const { return {n, n, 1.0 / static_cast<double>(n), 1.0 / static_cast<double>(n)}; }
  void fill_gap(const Grid& grid, std::span<double> gap, const parallel::Arena& arena) const;
};

const std::vector<SolveScene>& solve_scenes();

/// Throws std::invalid_argument that names the scene and those there are.
const SolveScene& solve_scene(const std::string& name);

}  // namespace brinell::bench
