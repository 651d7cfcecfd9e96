// Refusals shared by everything that writes a gap: each message names the argument, its value and what is allowed.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/grid.h"

namespace brinell::surface {

[[noreturn]] inline void refuse(std::string_view argument, double value, std::string_view allowed) {
  fail(Status::invalid_argument,
       std::string(argument) + " is " + text(value) + "; it must be " + std::string(allowed));
}

inline void check_grid(const Grid& grid) {
  if (grid.nx < 1 || grid.ny < 1) {
    fail(Status::invalid_argument, "grid has nx = " + std::to_string(grid.nx) + ", ny = " + std::to_string(grid.ny) +
                                       " nodes; at least 1 x 1 is needed");
  }
  if (!(grid.dx > 0) || !std::isfinite(grid.dx)) refuse("grid spacing dx", grid.dx, "positive and finite [m]");
  if (!(grid.dy > 0) || !std::isfinite(grid.dy)) refuse("grid spacing dy", grid.dy, "positive and finite [m]");
}

inline void check_gap(const Grid& grid, std::span<const double> gap) {
  check_grid(grid);
  if (gap.size() != grid.nodes()) {
    fail(Status::invalid_argument, "gap has " + std::to_string(gap.size()) + " elements; the grid has " +
                                       std::to_string(grid.nodes()) + " nodes");
  }
}

}  // namespace brinell::surface
