// Measured or computed heights [m] on the nodes of a grid, and the level or plane that is taken out of them.
// Heights are positive upwards out of their body: a peak reduces the gap.
#pragma once

#include <cstdint>
#include <span>

#include "base/grid.h"
#include "parallel/arena.h"

namespace brinell::surface {

/// A caller's heights, borrowed: node (i, j) is values[i·stride_x + j·stride_y]. Strides count elements and may be
/// negative, so that a map is mirrored or transposed without a copy.
struct HeightMap {
  const double* values = nullptr;
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  std::int64_t stride_x = 1;
  std::int64_t stride_y = 0;

  double at(std::int64_t i, std::int64_t j) const { return values[i * stride_x + j * stride_y]; }

  static HeightMap contiguous(const double* values, std::int64_t nx, std::int64_t ny) {
    return {values, nx, ny, 1, nx};
  }
};

enum class Detrend : std::int32_t { none = 0, mean = 1, plane = 2 };

/// level + slope_x·(2i − (nx−1)) + slope_y·(2j − (ny−1)): what detrending takes out, in metres and metres per half
/// a spacing, about the grid's centre.
struct Trend {
  double level = 0;
  double slope_x = 0;
  double slope_y = 0;

  double at(std::int64_t i, std::int64_t j, std::int64_t nx, std::int64_t ny) const {
    return level + slope_x * static_cast<double>(2 * i - (nx - 1)) + slope_y * static_cast<double>(2 * j - (ny - 1));
  }
};

/// Zero, the mean, or the least-squares plane. Refuses null, empty and non-finite maps; a height that is not finite
/// is named with its index (i, j).
Trend trend_of(const HeightMap& map, Detrend detrend, const parallel::Arena& arena);

/// gap −= heights − trend. The map must have the grid's nodes.
void add_to_gap(const HeightMap& map, Detrend detrend, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena);

}  // namespace brinell::surface
