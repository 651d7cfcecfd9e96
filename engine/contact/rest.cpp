#include "contact/rest.h"

#include <algorithm>
#include <cmath>

#include "contact/passes.h"

namespace brinell::contact {

namespace {

constexpr std::int64_t kRowsPerTask = 16;
constexpr int kMostExchanges = 1000;
// Depth below the plane, relative to the values that it lies between, that is round-off.
constexpr double kRoundOff = 1e-14;

struct Lowest {
  double depth = 0;
  std::int64_t node = -1;
};

class Search {
 public:
  Search(const parallel::Arena& arena, const PlacedGrid& placed, const UndeformedGap& gap, double force_x,
         double force_y)
      : arena_(arena), placed_(placed), gap_(gap), force_x_(force_x), force_y_(force_y) {}

  /// Exchanges one of three nodes around the force for the one that lies deepest below their plane, until none does:
  /// the plane falls at the force's place each time.
  Rest find() {
    Rest rest;
    start(rest);
    for (int n = 0; n < kMostExchanges; ++n) {
      rest.approach = plane_through(rest.nodes);
      const Lowest lowest = below(rest.approach);
      if (lowest.node < 0) break;
      std::array<std::int64_t, 3> best = rest.nodes;
      double most = -HUGE_VAL;
      for (std::size_t k = 0; k < 3; ++k) {
        std::array<std::int64_t, 3> nodes = rest.nodes;
        nodes[k] = lowest.node;
        const std::array<double, 3> shares = shares_of(nodes);
        const double least = *std::min_element(shares.begin(), shares.end());
        if (least > most) {
          most = least;
          best = nodes;
        }
      }
      if (best == rest.nodes) break;
      rest.nodes = best;
    }
    rest.shares = shares_of(rest.nodes);
    for (double& share : rest.shares) share = std::max(share, 0.0);
    return rest;
  }

 private:
  double x(std::int64_t node) const {
    return placed_.x + static_cast<double>(node % placed_.grid.nx) * placed_.grid.dx;
  }
  double y(std::int64_t node) const {
    const std::int64_t row = node / placed_.grid.nx;
    return placed_.y + static_cast<double>(row) * placed_.grid.dy;
  }
  double height(std::int64_t node) const { return gap_.scale * (gap_.values[node] - gap_.origin); }

  /// Three corners of the grid around the force.
  void start(Rest& rest) const {
    const std::int64_t nx = placed_.grid.nx, last = static_cast<std::int64_t>(placed_.grid.nodes()) - 1;
    double most = -HUGE_VAL;
    for (const auto& corners :
         {std::array<std::int64_t, 3>{0, nx - 1, last - (nx - 1)}, {nx - 1, last - (nx - 1), last}}) {
      const std::array<double, 3> shares = shares_of(corners);
      const double least = *std::min_element(shares.begin(), shares.end());
      if (least > most) {
        most = least;
        rest.nodes = corners;
      }
    }
  }

  /// Barycentric coordinates of the force's place; not a number where the nodes lie on a line.
  std::array<double, 3> shares_of(const std::array<std::int64_t, 3>& nodes) const {
    const auto twice_area = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
    std::array<double, 3> shares{};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t a = nodes[(k + 1) % 3], b = nodes[(k + 2) % 3];
      shares[k] = twice_area(x(a) - force_x_, y(a) - force_y_, x(b) - force_x_, y(b) - force_y_);
      sum += shares[k];
    }
    for (double& share : shares) share = sum != 0 ? share / sum : -HUGE_VAL;
    return shares;
  }

  LinearTrend plane_through(const std::array<std::int64_t, 3>& nodes) const {
    const auto [a, b, c] = nodes;
    const double bx = x(b) - x(a), by = y(b) - y(a), cx = x(c) - x(a), cy = y(c) - y(a);
    const double hb = height(b) - height(a), hc = height(c) - height(a);
    const double area = bx * cy - by * cx;
    LinearTrend plane;
    plane.x = (hb * cy - hc * by) / area;
    plane.y = (hc * bx - hb * cx) / area;
    plane.constant = height(a) - plane.x * x(a) - plane.y * y(a);
    return plane;
  }

  Lowest below(const LinearTrend& plane) const {
    const Grid& grid = placed_.grid;
    return ordered_sum<Lowest>(
        arena_, grid.ny, kRowsPerTask,
        [](Lowest& total, const Lowest& part) {
          if (part.depth > total.depth) total = part;
        },
        [&](std::int64_t begin, std::int64_t end) {
          Lowest part;
          for (std::int64_t j = begin; j < end; ++j) {
            const simd::Line along = plane.along(placed_.x, placed_.y + static_cast<double>(j) * grid.dy, grid.dx);
            for (std::int64_t i = 0; i < grid.nx; ++i) {
              const double h = height(j * grid.nx + i);
              const double level = along.value + along.slope * static_cast<double>(i);
              const double depth =
                  level - h - kRoundOff * (std::fabs(level) + std::fabs(h) + std::fabs(plane.constant));
              if (depth > part.depth) part = {depth, j * grid.nx + i};
            }
          }
          return part;
        });
  }

  const parallel::Arena& arena_;
  PlacedGrid placed_;
  UndeformedGap gap_;
  double force_x_, force_y_;
};

}  // namespace

Rest rest_under(const parallel::Arena& arena, const PlacedGrid& placed, const UndeformedGap& gap, double force_x,
                double force_y) {
  return Search(arena, placed, gap, force_x, force_y).find();
}

}  // namespace brinell::contact
