#include "work_precision/measured.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "measure/statistics.h"

namespace brinell::bench {

namespace {

/// A difference of a hundredth is none.
void mark_front(std::vector<SweepPoint>& points) {
  const auto no_worse = [](double a, double b) { return a <= 1.01 * b; };
  const auto better = [](double a, double b) { return 1.01 * a < b; };
  for (SweepPoint& point : points) {
    point.on_front = std::none_of(points.begin(), points.end(), [&](const SweepPoint& other) {
      return other.quantity == point.quantity && no_worse(other.seconds, point.seconds) &&
             no_worse(other.error, point.error) &&
             (better(other.seconds, point.seconds) || better(other.error, point.error));
    });
  }
}

}  // namespace

std::vector<SweepPoint> measured(std::vector<Entry>& entries, int rounds, const std::vector<Quantity>& quantities) {
  constexpr double kLongTime = 5;  // of a candidate: then its turns end
  std::vector<std::vector<Result>> results(entries.size());
  std::vector<std::vector<std::vector<double>>> times(entries.size());  // of entry and point, one for each turn
  for (int round = 0; round <= rounds; ++round) {                       // the first fills caches
    for (std::size_t e = 0; e < entries.size(); ++e) {
      double spent = 0;
      for (const auto& of_point : times[e]) {
        for (const double seconds : of_point) spent += seconds;
      }
      if (round > 1 && spent > kLongTime) continue;
      std::vector<Result> turn = entries[e].candidate->turn();
      times[e].resize(turn.size());
      if (round == 0) {
        results[e] = std::move(turn);
        continue;
      }
      for (std::size_t k = 0; k < turn.size(); ++k) times[e][k].push_back(turn[k].seconds);
    }
  }
  std::vector<SweepPoint> points;
  for (const Quantity& quantity : quantities) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      for (std::size_t k = 0; k < results[e].size(); ++k) {
        const Result& result = results[e][k];
        SweepPoint point = entries[e].points[k];
        point.quantity = quantity.name;
        point.seconds = median(times[e][k]);
        point.error = quantity.error(result);
        point.certificate = result.certificate;
        point.increments = result.increments;
        point.iterations = result.iterations;
        point.convolutions = result.convolutions;
        points.push_back(point);
      }
    }
  }
  mark_front(points);
  return points;
}

std::string as_label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

cli::SceneFile at_nodes(cli::SceneFile scene, std::int64_t nx) {
  const auto nodes = *scene.grid.nodes;
  const auto spacing = *scene.grid.spacing;
  const double factor = static_cast<double>(nodes[0]) / static_cast<double>(nx);
  const auto scaled = [&](std::int64_t count) {
    return std::max<std::int64_t>(1, std::lround(static_cast<double>(count) / factor));
  };
  scene.grid.nodes = {nx, scaled(nodes[1])};
  scene.grid.spacing = {spacing[0] * factor, spacing[1] * factor};
  if (scene.grid.layers > 0) {
    const double depth = static_cast<double>(scene.grid.layers) * scene.grid.layer_thickness;
    scene.grid.layers = scaled(scene.grid.layers);
    scene.grid.layer_thickness = depth / static_cast<double>(scene.grid.layers);
  }
  return scene;
}

}  // namespace brinell::bench
