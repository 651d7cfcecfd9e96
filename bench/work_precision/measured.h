// Candidates run in turn, and what their results are worth: time against error.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "work_precision/candidates.h"
#include "work_precision/sweep.h"

namespace brinell::bench {

/// A candidate and its points, one for each of its tolerances, without what is measured.
struct Entry {
  std::unique_ptr<Candidate> candidate;
  std::vector<SweepPoint> points;
};

struct Quantity {
  std::string name;
  std::function<double(const Result&)> error;
};

/// A point for each quantity, entry and tolerance, quantity by quantity; none for what did not converge.
std::vector<SweepPoint> measured(std::vector<Entry>& entries, int rounds, const std::vector<Quantity>& quantities);

std::string as_label(double value);

/// The scene on so many nodes in x, over the same lengths and depths.
cli::SceneFile at_nodes(cli::SceneFile scene, std::int64_t nx);

}  // namespace brinell::bench
