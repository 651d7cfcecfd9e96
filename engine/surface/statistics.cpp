#include "surface/statistics.h"

#include <algorithm>
#include <cmath>

#include "surface/ordered_sum.h"
#include "surface/surface_checks.h"

namespace brinell::surface {

namespace {

struct Moments {
  CompensatedSum absolute;
  CompensatedSum second;
  CompensatedSum third;
  CompensatedSum fourth;
  CompensatedSum differences_x;  // sum of squares
  CompensatedSum differences_y;
  double highest = 0;
  double lowest = 0;

  void add(const Moments& other) {
    absolute.add(other.absolute);
    second.add(other.second);
    third.add(other.third);
    fourth.add(other.fourth);
    differences_x.add(other.differences_x);
    differences_y.add(other.differences_y);
    highest = std::max(highest, other.highest);
    lowest = std::min(lowest, other.lowest);
  }
};

}  // namespace

HeightStatistics height_statistics(const HeightMap& map, double dx, double dy, Detrend detrend, Boundary boundary,
                                   const parallel::Arena& arena) {
  check_grid({map.nx, map.ny, dx, dy});
  // Heights are always taken about their mean; without detrending that is all that is taken out.
  const Trend trend = trend_of(map, detrend == Detrend::none ? Detrend::mean : detrend, arena);
  const std::int64_t nx = map.nx;
  const std::int64_t ny = map.ny;
  const bool wraps = boundary == Boundary::periodic;
  const std::int64_t pairs_x = wraps && nx > 1 ? nx : nx - 1;  // a row's pairs of neighbours
  const std::int64_t pairs_y = wraps && ny > 1 ? ny : ny - 1;  // a column's

  const auto chunks = gather_rows<Moments>(nx, ny, arena, [&](Moments& moments, std::int64_t j) {
    const auto z = [&](std::int64_t i, std::int64_t row) { return map.at(i, row) - trend.at(i, row, nx, ny); };
    for (std::int64_t i = 0; i < nx; ++i) {
      const double height = z(i, j);
      const double square = height * height;
      moments.absolute.add(std::fabs(height));
      moments.second.add(square);
      moments.third.add(square * height);
      moments.fourth.add(square * square);
      moments.highest = std::max(moments.highest, height);
      moments.lowest = std::min(moments.lowest, height);
      if (i < pairs_x) {
        const double difference = z(i + 1 < nx ? i + 1 : 0, j) - height;
        moments.differences_x.add(difference * difference);
      }
      if (j < pairs_y) {
        const double difference = z(i, j + 1 < ny ? j + 1 : 0) - height;
        moments.differences_y.add(difference * difference);
      }
    }
  });
  Moments total;
  for (const Moments& moments : chunks) total.add(moments);

  const double nodes = static_cast<double>(nx) * static_cast<double>(ny);
  HeightStatistics statistics;
  statistics.sa = total.absolute.value() / nodes;
  const double variance = total.second.value() / nodes;
  statistics.sq = std::sqrt(variance);
  if (variance > 0) {
    statistics.ssk = total.third.value() / nodes / (variance * statistics.sq);
    statistics.sku = total.fourth.value() / nodes / (variance * variance);
  }
  statistics.sp = total.highest;
  statistics.sv = 0.0 - total.lowest;  // never −0
  statistics.sz = total.highest - total.lowest;
  double slope_square = 0;
  if (pairs_x > 0) {
    slope_square +=
        total.differences_x.value() / (static_cast<double>(pairs_x) * static_cast<double>(ny)) / (dx * dx);
  }
  if (pairs_y > 0) {
    slope_square +=
        total.differences_y.value() / (static_cast<double>(pairs_y) * static_cast<double>(nx)) / (dy * dy);
  }
  statistics.sdq = std::sqrt(slope_square);
  return statistics;
}

}  // namespace brinell::surface
