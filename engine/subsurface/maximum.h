// The largest value of a field that comes layer by layer, with its place between the nodes.
//
// The fit: around the largest node (the first in the order layer, row, column) the quadratic
//
//   f(d) = f_0 + g·d + d·H d/2
//
// has the node's finite differences for gradient g and Hessian H, mixed derivatives included, from the 3 × 3 × 3
// nodes around it; unequal depths have their own weights. Its maximum lies at d = −H⁻¹ g, f = f_0 + g·d/2: third
// order in the spacings. A direction without neighbours on both sides (a border of the grid, the first or last layer,
// a single node) takes no part. If H is not negative definite, or d leads beyond the neighbours, each direction has
// its own parabola instead. On a periodic boundary neighbours wrap around.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/grid.h"

namespace brinell::subsurface {

struct Maximum {
  double value = 0;                  // of the fit
  std::array<double, 3> position{};  // x, y, z [m] of the fit
  double node_value = 0;             // of the largest node
  std::int64_t i = 0, j = 0, layer = 0;
};

class MaximumSearch {
 public:
  MaximumSearch(const Grid& grid, Boundary boundary, std::span<const double> depths);

  /// The next layer, one after the other from the first: nx·ny values, the largest among them (−infinity: none), and
  /// the values of the layer before, read only where a maximum lies (null for the first layer).
  void take(const double* values, double largest, const double* before);

  /// After the last layer. All zero if no node had a value other than NaN or −infinity.
  Maximum result() const;

 private:
  using Layer = std::array<double, 9>;  // [3·(row + 1) + column + 1] around the largest node

  Layer around(const double* values) const;
  std::int64_t neighbour(std::int64_t index, std::int64_t step, std::int64_t nodes) const;

  Grid grid_;
  Boundary boundary_;
  std::vector<double> depths_;
  std::int64_t layer_ = 0;  // that comes next
  bool found_ = false;
  Maximum best_;
  std::array<Layer, 3> near_{};  // layers above, at and below the largest node
};

}  // namespace brinell::subsurface
