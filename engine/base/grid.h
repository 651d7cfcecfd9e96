// The regular grid of nodes on which every surface field lives.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brinell {

enum class Boundary : std::int32_t { free = 0, periodic = 1 };

/// nx × ny nodes; node (i, j) lies at ((i − (nx−1)/2)·dx, (j − (ny−1)/2)·dy). Fields are row-major, y outer and
/// x inner: index = j·nx + i.
struct Grid {
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  double dx = 0;  // [m]
  double dy = 0;  // [m]

  std::size_t nodes() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  double cell_area() const { return dx * dy; }
  double x(std::int64_t i) const { return (static_cast<double>(i) - 0.5 * static_cast<double>(nx - 1)) * dx; }
  double y(std::int64_t j) const { return (static_cast<double>(j) - 0.5 * static_cast<double>(ny - 1)) * dy; }

  friend bool operator==(const Grid&, const Grid&) = default;
};

}  // namespace brinell
