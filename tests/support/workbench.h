// What a contact test works with: an engine's resources on a small scale, gaps, and a solved contact with every
// quantity in SI units and E* = 1 Pa.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "contact/solver.h"
#include "fft/plan_cache.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "surface/roughness.h"
#include "surface/shapes.h"

namespace brinell::support {

/// Like an engine: threads, kernels, plans and spectra that live as long as its solvers.
struct Workbench {
  explicit Workbench(int threads = 1, const simd::KernelTable& kernels = simd::best_kernels())
      : arena(threads), spectra(std::size_t{1} << 30), resources{{arena, kernels, plans}, spectra} {}

  parallel::Arena arena;
  fft::PlanCache plans;
  influence::SpectrumCache spectra;
  contact::Resources resources;
};

inline std::vector<double> gap_of(const surface::Shape& shape, const Grid& grid, surface::Centre centre = {}) {
  std::vector<double> gap(grid.nodes());
  surface::add_to_gap(shape, centre, grid, gap, parallel::Arena(1));
  return gap;
}

inline std::vector<double> gap_of(const surface::Roughness& roughness, const Grid& grid) {
  std::vector<double> gap(grid.nodes());
  surface::add_to_gap(roughness, {}, grid, gap, parallel::Arena(1));
  return gap;
}

/// Waves down to four spacings, rolled off at an eighth of the side.
inline surface::Roughness self_affine(const Grid& grid, std::uint64_t seed) {
  const double side = std::max(static_cast<double>(grid.nx) * grid.dx, static_cast<double>(grid.ny) * grid.dy);
  surface::Roughness roughness;
  roughness.hurst = 0.8;
  roughness.rms_slope = 0.1;
  roughness.short_cutoff = 4 * std::max(grid.dx, grid.dy);
  roughness.rolloff = std::max(side / 8, roughness.short_cutoff);
  roughness.seed = seed;
  return roughness;
}

/// Independent uniform numbers in [0, height).
inline std::vector<double> random_gap(const Grid& grid, double height, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> gap(grid.nodes());
  for (double& value : gap) value = height * (static_cast<double>(random()) * 0x1p-32);
  return gap;
}

struct Pressed {
  contact::Solution solution;
  std::vector<double> pressure;      // [E*]
  std::vector<double> deformed_gap;  // approach not taken off [m]

  double largest() const {
    double most = 0;
    for (const double p : pressure) most = std::max(most, p);
    return most;
  }
  std::int64_t nodes_in_contact() const {
    std::int64_t count = 0;
    for (const double p : pressure) count += p > 0 ? 1 : 0;
    return count;
  }
};

struct Request {
  Request() = default;
  Request(contact::Drive drive, double target, double certificate = 1e-10, std::int32_t iterations = 500)
      : Request(contact::Load{drive, target}, certificate, iterations) {}
  Request(const contact::Load& wanted, double certificate = 1e-10, std::int32_t iterations = 500)
      : load(wanted), tolerance(certificate), max_iterations(iterations) {}

  contact::Load load;  // Σ p [E*], or approach [m]
  double tolerance = 1e-10;
  std::int32_t max_iterations = 500;
};

inline Pressed state_of(const contact::Solver& solver, const contact::Solution& solution, double dx) {
  Pressed pressed{solution, {}, {}};
  pressed.pressure.assign(solver.pressure().begin(), solver.pressure().end());
  for (const double g : solver.deformed_gap()) pressed.deformed_gap.push_back(solver.first_touch() + g * dx);
  return pressed;
}

inline contact::Solution solve(contact::Solver& solver, const Request& request) {
  return solver.solve(request.load, request.tolerance, request.max_iterations,
                      [](const contact::Report&) { return true; });
}

inline Pressed press(const Workbench& bench, const Grid& grid, Boundary boundary, const std::vector<double>& gap,
                     const Request& request, bool mixed_precision = false) {
  contact::Solver solver(bench.resources, grid, boundary, gap.data(), mixed_precision);
  const contact::Solution solution = solve(solver, request);
  return state_of(solver, solution, grid.dx);
}

/// Largest |a − b|; NaN if any is.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    const double difference = std::fabs(a[n] - b[n]);
    if (!(difference <= largest)) largest = difference;
  }
  return largest;
}

}  // namespace brinell::support
