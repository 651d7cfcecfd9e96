#include "work_precision/measured.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "measure/clock.h"
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
  constexpr double kLongTurn = 1;  // which caches hardly shorten: the first counts
  constexpr double kLongTime = 5;  // of all turns of a candidate: then they end
  struct Turns {
    std::vector<Result> results;             // of the first turn, one a point
    std::vector<std::vector<double>> times;  // of each point
    int counted = 0;
    double spent = 0;
  };
  std::vector<Turns> all(entries.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      Turns& turns = all[e];
      if (turns.counted == rounds || turns.spent > kLongTime) continue;
      const double start = seconds(Clock::cpu);
      std::vector<Result> results = entries[e].candidate->turn();
      const double taken = seconds(Clock::cpu) - start;
      turns.times.resize(results.size());
      if (round > 0 || taken > kLongTurn) {
        for (std::size_t k = 0; k < results.size(); ++k) turns.times[k].push_back(results[k].seconds);
        ++turns.counted;
        turns.spent += taken;
      }
      if (round == 0) turns.results = std::move(results);
    }
  }
  std::vector<SweepPoint> points;
  for (const Quantity& quantity : quantities) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      for (std::size_t k = 0; k < all[e].results.size(); ++k) {
        const Result& result = all[e].results[k];
        if (!result.converged) continue;
        SweepPoint point = entries[e].points[k];
        point.quantity = quantity.name;
        point.seconds = median(all[e].times[k]);
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
