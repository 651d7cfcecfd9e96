// A body that hardens moves along its grid: the box of cuboids moves with it.
#pragma once

#include <cstdint>

#include "base/grid.h"
#include "plastic/plastic_body.h"

namespace brinell::plastic {

/// The state of a body that has moved by so many nodes. Cuboids that leave the grid are cut off; throws
/// Status::invalid_scene if there is plastic strain in one of them.
PlasticBody::State moved(const PlasticBody::State& state, std::int64_t nodes_x, std::int64_t nodes_y,
                         const Grid& grid);

}  // namespace brinell::plastic
