// The gap of the undeformed bodies, with the upper one where the load history has moved it.
//
// What is known by a formula moves to any place. What is known at nodes moves by whole nodes: the heights and the
// roughness of the upper body, and the cuboids of one that hardens. Formulas and heights come back on the other side
// of a periodic boundary; on a free one formulas hold everywhere, and roughness, a sum of waves that fit the grid, is
// periodic by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "parallel/arena.h"
#include "scene/scene.h"

namespace brinell::scene {

/// Where the upper body stands, from where it began [m].
struct Place {
  double x = 0, y = 0;

  friend bool operator==(const Place&, const Place&) = default;
};

/// During step n: the sum of the offsets up to its own. What is whole nodes but for rounding is made whole nodes, so
/// that ways there and back end where they began, to the bit.
Place place_of_upper(const Scene& scene, std::int32_t step);

struct NodeShift {
  std::int64_t i = 0, j = 0;
};

/// Nothing: not whole nodes.
std::optional<NodeShift> whole_nodes(const Place& place, const Grid& grid);

/// Whether any entry has values at nodes that have to move.
bool moves_node_values(const Scene& scene);

/// Throws Status::invalid_scene where the upper body cannot follow its steps.
void check_offsets(const Scene& scene);

/// gap = sum of all entries [m]. Throws Status::invalid_scene where it is not finite.
void sum_surfaces(const Scene& scene, const Place& place, const parallel::Arena& arena, std::span<double> gap);

}  // namespace brinell::scene
