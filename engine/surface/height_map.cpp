#include "surface/height_map.h"

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "surface/ordered_sum.h"
#include "surface/surface_checks.h"

namespace brinell::surface {

namespace {

std::string size_text(std::int64_t nx, std::int64_t ny) {
  return std::to_string(nx) + " x " + std::to_string(ny);
}

struct HeightsOfChunk {
  CompensatedSum sum;
  std::int64_t bad_i = -1;  // first height that is not finite
  std::int64_t bad_j = -1;
};

// Heights are taken relative to the first one, so that a flat map has its exact level.
double mean_of_finite(const HeightMap& map, const parallel::Arena& arena) {
  const double reference = map.at(0, 0);
  const auto chunks = gather_rows<HeightsOfChunk>(map.nx, map.ny, arena, [&](HeightsOfChunk& chunk, std::int64_t j) {
    if (chunk.bad_i >= 0) return;
    for (std::int64_t i = 0; i < map.nx; ++i) {
      const double height = map.at(i, j);
      if (!std::isfinite(height)) {
        chunk.bad_i = i;
        chunk.bad_j = j;
        return;
      }
      chunk.sum.add(height - reference);
    }
  });
  CompensatedSum total;
  for (const HeightsOfChunk& chunk : chunks) {
    if (chunk.bad_i >= 0) {
      fail(Status::invalid_argument, "height at node (i, j) = (" + std::to_string(chunk.bad_i) + ", " +
                                         std::to_string(chunk.bad_j) + ") is " +
                                         text(map.at(chunk.bad_i, chunk.bad_j)) + "; heights must be finite");
    }
    total.add(chunk.sum);
  }
  return reference + total.value() / (static_cast<double>(map.nx) * static_cast<double>(map.ny));
}

// Sum of (2i − (n−1))² over i < n.
double sum_of_squares(std::int64_t n) {
  const auto length = static_cast<double>(n);
  return length * (length * length - 1.0) / 3.0;
}

}  // namespace

Trend trend_of(const HeightMap& map, Detrend detrend, const parallel::Arena& arena) {
  if (map.values == nullptr) fail(Status::invalid_argument, "heights: values is null");
  if (map.nx < 1 || map.ny < 1) {
    fail(Status::invalid_argument, "heights have " + size_text(map.nx, map.ny) + " nodes; at least 1 x 1 is needed");
  }
  const double mean = mean_of_finite(map, arena);
  if (detrend == Detrend::none) return {};
  if (detrend == Detrend::mean) return {mean, 0, 0};
  if (detrend != Detrend::plane) {
    fail(Status::invalid_argument, "detrend is " + std::to_string(static_cast<std::int32_t>(detrend)) +
                                       "; allowed are 0 (none), 1 (mean) and 2 (plane)");
  }

  // Centred coordinates are orthogonal on the grid: the plane's three coefficients are three independent sums.
  struct Moments {
    CompensatedSum x;
    CompensatedSum y;
  };
  const auto chunks = gather_rows<Moments>(map.nx, map.ny, arena, [&](Moments& moments, std::int64_t j) {
    const auto y = static_cast<double>(2 * j - (map.ny - 1));
    for (std::int64_t i = 0; i < map.nx; ++i) {
      const double height = map.at(i, j) - mean;
      moments.x.add(height * static_cast<double>(2 * i - (map.nx - 1)));
      moments.y.add(height * y);
    }
  });
  Moments total;
  for (const Moments& moments : chunks) {
    total.x.add(moments.x);
    total.y.add(moments.y);
  }
  Trend trend = {mean, 0, 0};
  if (map.nx > 1) trend.slope_x = total.x.value() / (sum_of_squares(map.nx) * static_cast<double>(map.ny));
  if (map.ny > 1) trend.slope_y = total.y.value() / (sum_of_squares(map.ny) * static_cast<double>(map.nx));
  return trend;
}

void add_to_gap(const HeightMap& map, Detrend detrend, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena) {
  if (map.nx != grid.nx || map.ny != grid.ny) {
    fail(Status::invalid_argument, "heights have " + size_text(map.nx, map.ny) + " nodes, the grid has " +
                                       size_text(grid.nx, grid.ny) + "; they must be the same");
  }
  check_gap(grid, gap);
  const Trend trend = trend_of(map, detrend, arena);
  arena.for_chunks(grid.ny, rows_per_chunk(grid.nx), [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      double* row = gap.data() + j * grid.nx;
      for (std::int64_t i = 0; i < grid.nx; ++i) row[i] -= map.at(i, j) - trend.at(i, j, grid.nx, grid.ny);
    }
  });
}

}  // namespace brinell::surface
