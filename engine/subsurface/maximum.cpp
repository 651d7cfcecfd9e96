#include "subsurface/maximum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brinell::subsurface {

namespace {

/// Weights of the values before, at and after a node in the derivatives there.
struct Differences {
  bool possible = false;
  double before = 0, after = 0;  // distances of the neighbours
  std::array<double, 3> first{0, 0, 0}, second{0, 0, 0};

  Differences() = default;
  Differences(double before_, double after_) : possible(true), before(before_), after(after_) {
    const double both = before + after;
    first = {-after / (before * both), (after - before) / (before * after), before / (after * both)};
    second = {2 / (before * both), -2 / (before * after), 2 / (after * both)};
  }
};

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;
using Cube = std::array<std::array<double, 9>, 3>;

constexpr std::array<double, 3> kHere{0, 1, 0};

double weighted(const Cube& near, const std::array<double, 3>& x, const std::array<double, 3>& y,
                const std::array<double, 3>& z) {
  double sum = 0;
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight = x[i] * y[j] * z[l];
        if (weight != 0) sum += weight * near[l][3 * j + i];  // nodes that are not there have no weight
      }
    }
  }
  return sum;
}

struct Quadratic {
  Vector g{};
  Matrix h{};
};

Quadratic quadratic(const Cube& near, const std::array<Differences, 3>& axes) {
  Quadratic fit;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      std::array<std::array<double, 3>, 3> weights{kHere, kHere, kHere};
      if (!axes[a].possible || !axes[b].possible) continue;
      weights[a] = a == b ? axes[a].second : axes[a].first;
      if (a != b) weights[b] = axes[b].first;
      fit.h[a][b] = fit.h[b][a] = weighted(near, weights[0], weights[1], weights[2]);
      if (a == b) {
        weights[a] = axes[a].first;
        fit.g[a] = weighted(near, weights[0], weights[1], weights[2]);
      }
    }
  }
  return fit;
}

bool within(const Vector& d, const std::array<Differences, 3>& axes) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(d[a] >= -axes[a].before) || !(d[a] <= axes[a].after)) return false;
  }
  return true;
}

/// −H⁻¹ g on the directions that take part; false unless −H is positive definite there (Cholesky).
bool solve(const Quadratic& fit, const std::array<Differences, 3>& axes, Vector& d) {
  Matrix l{};
  Vector y{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!axes[a].possible) {
      l[a][a] = 1;
      continue;
    }
    double pivot = -fit.h[a][a];
    y[a] = fit.g[a];
    for (std::size_t b = 0; b < a; ++b) {
      double sum = axes[b].possible ? -fit.h[a][b] : 0.0;
      for (std::size_t c = 0; c < b; ++c) sum -= l[a][c] * l[b][c];
      l[a][b] = sum / l[b][b];
      pivot -= l[a][b] * l[a][b];
      y[a] -= l[a][b] * y[b];
    }
    if (!(pivot > -1e-6 * fit.h[a][a]) || !(pivot > 0)) return false;  // nearly a ridge: no place along it
    l[a][a] = std::sqrt(pivot);
    y[a] /= l[a][a];
  }
  for (std::size_t a = 3; a-- > 0;) {
    double sum = y[a];
    for (std::size_t b = a + 1; b < 3; ++b) sum -= l[b][a] * d[b];
    d[a] = sum / l[a][a];
  }
  return true;
}

}  // namespace

MaximumSearch::MaximumSearch(const Grid& grid, Boundary boundary, std::span<const double> depths)
    : grid_(grid), boundary_(boundary), depths_(depths.begin(), depths.end()) {}

std::int64_t MaximumSearch::neighbour(std::int64_t index, std::int64_t step, std::int64_t nodes) const {
  const std::int64_t other = index + step;
  if (other >= 0 && other < nodes) return other;
  return boundary_ == Boundary::periodic && nodes >= 3 ? (other + nodes) % nodes : -1;
}

MaximumSearch::Layer MaximumSearch::around(const double* values) const {
  Layer layer;
  for (std::int64_t row = -1; row <= 1; ++row) {
    for (std::int64_t column = -1; column <= 1; ++column) {
      const std::int64_t i = neighbour(best_.i, column, grid_.nx), j = neighbour(best_.j, row, grid_.ny);
      layer[static_cast<std::size_t>(3 * (row + 1) + column + 1)] =
          i < 0 || j < 0 ? std::numeric_limits<double>::quiet_NaN() : values[j * grid_.nx + i];
    }
  }
  return layer;
}

void MaximumSearch::take(const double* values, double largest, const double* before) {
  if (found_ && layer_ == best_.layer + 1) near_[2] = around(values);
  if (found_ ? largest > best_.node_value : largest > -std::numeric_limits<double>::infinity()) {
    found_ = true;
    const std::int64_t index = std::find(values, values + grid_.nodes(), largest) - values;
    best_.node_value = largest;
    best_.i = index % grid_.nx;
    best_.j = index / grid_.nx;
    best_.layer = layer_;
    if (before != nullptr) near_[0] = around(before);
    near_[1] = around(values);
  }
  ++layer_;
}

Maximum MaximumSearch::result() const {
  if (!found_) return {};
  std::array<Differences, 3> axes;
  const auto inside = [&](std::int64_t index, std::int64_t nodes) {
    return neighbour(index, -1, nodes) >= 0 && neighbour(index, 1, nodes) >= 0;
  };
  if (inside(best_.i, grid_.nx)) axes[0] = {grid_.dx, grid_.dx};
  if (inside(best_.j, grid_.ny)) axes[1] = {grid_.dy, grid_.dy};
  const auto layer = static_cast<std::size_t>(best_.layer);
  const double depth = depths_[layer];
  if (layer > 0 && layer + 1 < depths_.size()) axes[2] = {depth - depths_[layer - 1], depths_[layer + 1] - depth};

  const Quadratic fit = quadratic(near_, axes);
  Vector d{};
  if (!solve(fit, axes, d) || !within(d, axes)) {
    for (std::size_t a = 0; a < 3; ++a) d[a] = fit.h[a][a] < 0 ? -fit.g[a] / fit.h[a][a] : 0.0;
  }
  Maximum maximum = best_;
  maximum.value = best_.node_value + 0.5 * (fit.g[0] * d[0] + fit.g[1] * d[1] + fit.g[2] * d[2]);
  maximum.position = {grid_.x(best_.i) + d[0], grid_.y(best_.j) + d[1], depth + d[2]};
  return maximum;
}

}  // namespace brinell::subsurface
