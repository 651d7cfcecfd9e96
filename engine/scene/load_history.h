// The increments of a scene: where each step's legs begin and end.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/problem.h"
#include "scene/scene.h"

namespace brinell::scene {

/// Which increment of which step, both counted from zero.
struct Position {
  std::int32_t step = 0;
  std::int32_t increment = 0;
};

/// The state that a step sets out from.
struct Origin {
  double force = 0;     // [N]
  double approach = 0;  // [m]
};

std::int32_t total_increments(const std::vector<Step>& steps);

/// Position of the n-th increment of the whole history, 0 <= n < total_increments.
Position position_of(const std::vector<Step>& steps, std::int32_t n);

/// What an increment prescribes: a force [N] or an approach [m]. Steps go from their origin to their target in equal
/// parts; the last part is the target itself, to the bit. Where the force acts, or the slopes, are the step's
/// throughout.
contact::Load load_of(const Step& step, std::int32_t increment, const Origin& origin, const Grid& grid);

}  // namespace brinell::scene
