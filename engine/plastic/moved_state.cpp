#include "plastic/moved_state.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace brinell::plastic {

namespace {

/// Of one side of a box: where the part lies that stays on the grid, from the box's first cuboid.
struct Kept {
  std::int64_t begin = 0, end = 0;  // cuboids
  std::int64_t first = 0;           // node above `begin`, after the move

  Kept(std::int64_t old_first, std::int64_t count, std::int64_t by, std::int64_t nodes) {
    begin = std::clamp<std::int64_t>(-(old_first + by), 0, count);
    end = std::clamp<std::int64_t>(nodes - (old_first + by), begin, count);
    first = old_first + by + begin;
  }
  std::int64_t count() const { return end - begin; }
  bool holds(std::int64_t n) const { return n >= begin && n < end; }
};

}  // namespace

PlasticBody::State moved(const PlasticBody::State& state, std::int64_t nodes_x, std::int64_t nodes_y,
                         const Grid& grid) {
  // All of it: another member does not compile here.
  const auto& [region, strain, increment, stress, equivalent] = state;
  if (region.empty()) return {};
  const Box& box = region.box;
  const Kept x(region.i0, box.nx, nodes_x, grid.nx), y(region.j0, box.ny, nodes_y, grid.ny);
  for (std::int64_t row = 0; row < box.nz * box.ny; ++row) {
    for (std::int64_t i = 0; i < box.nx; ++i) {
      if (x.holds(i) && y.holds(row % box.ny)) continue;
      if (!(equivalent[static_cast<std::size_t>(row * box.nx + i)] > 0)) continue;
      fail(Status::invalid_scene, "offset: the upper body moves by " + std::to_string(nodes_x) + " x " +
                                      std::to_string(nodes_y) + " nodes, which takes plastic strain of it beyond " +
                                      "the grid's side, where nothing is known; move it less far or give the grid " +
                                      "more nodes");
    }
  }
  PlasticBody::State result;
  if (x.count() == 0 || y.count() == 0) return result;
  result.region = {x.first, y.first, {x.count(), y.count(), box.nz, box.dx, box.dy, box.dz}};
  const Region whole{region.i0 + nodes_x, region.j0 + nodes_y, box};
  result.strain = placed_in(result.region, whole, strain, 6);
  result.increment = placed_in(result.region, whole, increment, 6);
  result.stress = placed_in(result.region, whole, stress, 6);
  result.equivalent = placed_in(result.region, whole, equivalent, 1);
  return result;
}

}  // namespace brinell::plastic
