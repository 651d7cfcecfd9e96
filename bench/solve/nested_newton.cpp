#include "solve/nested_newton.h"

#include <algorithm>
#include <cmath>

namespace brinell::bench {

namespace {

constexpr int kSteps = 20;
constexpr double kDifference =
    0.01;  // of the slope that a displacement of force / (E* side) makes over half the side

}  // namespace

NestedNewton::NestedNewton(const Grid& grid, const double* gap)
    : grid_(grid), gap_(gap, gap + grid.nodes()), tilted_(grid.nodes()), centric_(grid, Boundary::free, gap) {}

/// F at a slope, relative to the force and half the grid.
double NestedNewton::miss(double slope, double target, double x0, double tolerance, std::int32_t max_iterations,
                          NestedSolution& result) {
  const auto nx = static_cast<std::size_t>(grid_.nx);
  const auto x = [&](std::size_t n) { return grid_.x(static_cast<std::int64_t>(n % nx)); };
  for (std::size_t n = 0; n < gap_.size(); ++n) tilted_[n] = gap_[n] + slope * x(n);
  centric_.set_gap(tilted_.data());
  const TextbookSolution solution = centric_.solve(contact::Drive::force, target, tolerance, max_iterations);
  ++result.solutions;
  result.iterations += solution.iterations;
  result.convolutions += solution.convolutions;
  result.certificate = solution.certificate;
  result.converged = solution.converged;
  double moment = 0;
  for (std::size_t n = 0; n < gap_.size(); ++n) moment += centric_.pressure()[n] * x(n);
  return (target * x0 - moment) / (target * 0.5 * static_cast<double>(grid_.nx) * grid_.dx);
}

NestedSolution NestedNewton::solve(double target, double x0, double tolerance, std::int32_t max_iterations) {
  const double side = grid_.dx * static_cast<double>(grid_.nx);
  const double difference = kDifference * (target * grid_.cell_area() / side) / (0.5 * side);
  NestedSolution result;
  while (true) {
    const double here = miss(result.slope, target, x0, tolerance, max_iterations, result);
    result.certificate.balance = std::max(result.certificate.balance, std::fabs(here));
    const bool solved = result.converged;
    result.converged = solved && std::fabs(here) <= tolerance;
    if (result.converged || !solved || result.steps == kSteps) return result;
    const double there = miss(result.slope + difference, target, x0, tolerance, max_iterations, result);
    result.slope -= here * difference / (there - here);
    ++result.steps;
  }
}

}  // namespace brinell::bench
