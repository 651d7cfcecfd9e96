// Where rigid bodies come to rest under a force that acts at a point: on three nodes around it. It is the limit of
// small loads, and tells whether bodies that are free to tilt touch at all.
#pragma once

#include <array>
#include <cstdint>

#include "contact/problem.h"
#include "contact/trend.h"
#include "parallel/arena.h"

namespace brinell::contact {

struct Rest {
  LinearTrend approach;               // the plane through the three nodes; no node lies below it
  std::array<std::int64_t, 3> nodes;  // that carry the force
  std::array<double, 3> shares{};     // of the force
};

/// Of all planes that lie nowhere above the gap, the highest at (force_x, force_y), which lies within the nodes. At
/// least 2 × 2 nodes.
Rest rest_under(const parallel::Arena& arena, const PlacedGrid& placed, const UndeformedGap& gap, double force_x,
                double force_y);

}  // namespace brinell::contact
