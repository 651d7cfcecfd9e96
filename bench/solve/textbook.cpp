#include "solve/textbook.h"

#include <algorithm>
#include <cmath>

#include "influence/displacement.h"
#include "influence/spectra.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::bench {

Textbook::Textbook(const Grid& grid, Boundary boundary, const double* gap)
    : nodes_(grid.nodes()),
      unit_(grid.dx),
      compliance_(grid.nx, grid.ny, boundary),
      gap_(nodes_),
      p_(nodes_),
      g_(nodes_),
      r_(nodes_),
      t_(nodes_),
      q_(nodes_),
      u_(nodes_) {
  set_gap(gap);
  const Grid unit{grid.nx, grid.ny, 1, grid.dy / grid.dx};
  if (boundary == Boundary::periodic) {
    compliance_.set_symbol(
        [&](std::int64_t kx, std::int64_t ky) { return influence::displacement_symbol(unit, kx, ky); });
  } else {
    // Its memory serves no other purpose yet.
    influence::Displacement(unit.dx, unit.dy)
        .fill(parallel::Arena(1), simd::best_kernels(), unit.nx, unit.ny, g_.data());
    compliance_.set_kernel(g_.data());
  }
}

void Textbook::set_gap(const double* gap) {
  for (std::size_t i = 0; i < nodes_; ++i) gap_[i] = gap[i] / unit_;
}

TextbookSolution Textbook::solve(contact::Drive drive, double target, double tolerance, std::int32_t max_iterations,
                                 const std::function<void(const TextbookSolution&)>& observe) {
  const std::size_t n = nodes_;
  const bool by_force = drive == contact::Drive::force;
  if (!by_force) target /= unit_;
  TextbookSolution result;
  double approach = 0;
  const double uniform = target / static_cast<double>(n);
  const double stiffness = 1 / std::sqrt(static_cast<double>(n));  // its order of magnitude is enough
  for (std::size_t i = 0; i < n; ++i) p_[i] = by_force ? uniform : stiffness * std::max(0.0, target - gap_[i]);
  std::fill(t_.begin(), t_.end(), 0.0);
  double g_old = 1, delta = 0, step = 0;

  while (true) {
    compliance_.apply(p_.data(), u_.data());
    ++result.convolutions;
    for (std::size_t i = 0; i < n; ++i) g_[i] = gap_[i] + u_[i];

    double active = 0, sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] > 0) {
        active += 1;
        sum += g_[i];
      }
    }
    approach = by_force ? sum / active : target;
    for (std::size_t i = 0; i < n; ++i) r_[i] = g_[i] - approach;

    double total = 0, least = HUGE_VAL, largest = 0, work = 0;
    for (std::size_t i = 0; i < n; ++i) total += p_[i];
    for (std::size_t i = 0; i < n; ++i) least = std::min(least, r_[i]);
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, std::fabs(u_[i]));
    for (std::size_t i = 0; i < n; ++i) work += p_[i] * std::fabs(r_[i]);
    result.certificate.penetration = std::max(0.0, -least) / largest;
    result.certificate.complementarity = work / (total * largest);
    result.certificate.balance = by_force ? std::fabs(total - target) / target : 0;
    result.approach = approach * unit_;
    result.converged = result.certificate.worst() <= tolerance;
    if (observe) observe(result);
    const bool lost = !std::isfinite(step);
    if (result.converged || lost || result.iterations >= max_iterations) return result;

    double g_new = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] > 0) g_new += r_[i] * r_[i];
    }
    for (std::size_t i = 0; i < n; ++i) t_[i] = p_[i] > 0 ? r_[i] + delta * (g_new / g_old) * t_[i] : 0;
    g_old = g_new;

    compliance_.apply(t_.data(), q_.data());
    ++result.convolutions;
    if (by_force) {
      double mean = 0;
      for (std::size_t i = 0; i < n; ++i) {
        if (p_[i] > 0) mean += q_[i];
      }
      mean /= active;
      for (std::size_t i = 0; i < n; ++i) q_[i] -= mean;
    }
    double slope = 0, curvature = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] > 0) slope += r_[i] * t_[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] > 0) curvature += q_[i] * t_[i];
    }
    step = slope / curvature;

    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] > 0) p_[i] -= step * t_[i];
    }
    for (std::size_t i = 0; i < n; ++i) p_[i] = std::max(p_[i], 0.0);
    delta = 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (p_[i] == 0 && r_[i] < 0) {
        p_[i] -= step * r_[i];
        delta = 0;
      }
    }
    if (by_force) {
      total = 0;
      for (std::size_t i = 0; i < n; ++i) total += p_[i];
      const double factor = target / total;
      for (std::size_t i = 0; i < n; ++i) p_[i] *= factor;
    }
    ++result.iterations;
  }
}

}  // namespace brinell::bench
