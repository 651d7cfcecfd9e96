#include "contact/solver.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace brinell::contact {

namespace {

// Coarse grids only prepare the start; their own discretisation error is larger than this.
constexpr double kCoarseTolerance = 1e-3;
constexpr std::int32_t kCoarseIterations = 200;
// A target this close to the last one is solved from the last pressure, without coarser grids.
constexpr double kCloseStart = 0.02;
// Forces tried for a prescribed approach with moments; the certificate of one that is only on the way is better by
// this factor than what it misses of the approach.
constexpr int kForces = 100;
constexpr double kTrialCertificate = 0.01;

struct GapSums {
  double least = HUGE_VAL;
  double sum = 0;
};

/// The place itself, or the closest at which nodes on both sides can carry a force.
double within(double first, std::int64_t nodes, double spacing, double place) {
  const double margin = nodes > 1 ? 0.25 * spacing : 0;
  return std::clamp(place, first + margin, first + static_cast<double>(nodes - 1) * spacing - margin);
}

}  // namespace

Solver::Solver(const Resources& resources, const Grid& grid, Boundary boundary, const double* gap,
               bool mixed_precision)
    : resources_(resources),
      grid_{grid.nx, grid.ny, 1.0, grid.dy / grid.dx},
      placed_(PlacedGrid::centred(grid_)),
      boundary_(boundary),
      gap_(gap),
      scale_(1 / grid.dx),
      mixed_precision_(mixed_precision),
      p_(grid.nodes()),
      g_(grid.nodes()) {
  gap_changed();
  origin_ = first_touch_;
  separate();
}

Solver::~Solver() = default;

void Solver::gap_changed() {
  const auto sums = ordered_sum<GapSums>(
      resources_.backend.arena, static_cast<std::int64_t>(grid_.nodes()), 1 << 14,
      [](GapSums& total, const GapSums& part) {
        total.least = std::min(total.least, part.least);
        total.sum += part.sum;
      },
      [&](std::int64_t begin, std::int64_t end) {
        GapSums part;
        for (std::int64_t n = begin; n < end; ++n) {
          part.least = std::min(part.least, gap_[n]);
          part.sum += gap_[n];
        }
        return part;
      });
  first_touch_ = sums.least;
  mean_gap_ = sums.sum / static_cast<double>(grid_.nodes());
}

/// No pressure: the undeformed gap.
void Solver::separate() {
  std::fill(p_.begin(), p_.end(), 0.0);
  for (std::size_t n = 0; n < g_.size(); ++n) g_[n] = scale_ * (gap_[n] - origin_);
  total_ = 0;
  approach_ = first_touch_;
  slope_x_ = slope_y_ = 0;
}

Solver::State Solver::state() const {
  State state{{}, total_, approach_, slope_x_, slope_y_};
  if (total_ > 0) {
    state.pressure = Buffer<double>::uninitialised(p_.size());
    std::copy(p_.begin(), p_.end(), state.pressure.begin());
  }
  return state;
}

void Solver::restore(const State& state) {
  separate();
  approach_ = state.approach;
  slope_x_ = state.slope_x;
  slope_y_ = state.slope_y;
  if (!(state.total > 0)) return;
  std::copy(state.pressure.begin(), state.pressure.end(), p_.begin());
  total_ = state.total;
  full_compliance().apply(p_.data(), g_.data());
  Passes<double>(resources_.backend.arena, resources_.backend.kernels, placed_)
      .refresh(undeformed(gap_), p_.data(), g_.data());
}

const Compliance<double>& Solver::full_compliance() {
  if (compliance_ == nullptr) compliance_ = std::make_unique<Compliance<double>>(resources_, grid_, boundary_);
  return *compliance_;
}

template <class Real>
Level<Real>& Solver::full_level() {
  auto& level = [&]() -> std::unique_ptr<Level<Real>>& {
    if constexpr (std::is_same_v<Real, double>) {
      return in_double_;
    } else {
      return in_single_;
    }
  }();
  if (level == nullptr) {
    level = std::make_unique<Level<Real>>(resources_, full_compliance(), placed_, boundary_, undeformed(gap_),
                                          Fields{p_.data(), g_.data()});
  }
  return *level;
}

bool Solver::start_is_close(const Load& load) const {
  if (!(total_ > 0)) return false;
  const double depth = approach_ - first_touch_;
  const double half_x = 0.5 * static_cast<double>(grid_.nx) / scale_;
  const double half_y = 0.5 * static_cast<double>(grid_.ny) * grid_.dy / scale_;
  const double before = load.drive == Drive::force ? total_ : depth;
  const double after = load.drive == Drive::force ? load.target : load.target - first_touch_;
  if (std::fabs(after - before) > kCloseStart * std::fabs(before)) return false;
  if (!load.moments) {
    return std::fabs(load.slope_x - slope_x_) * half_x <= kCloseStart * std::fabs(depth) &&
           std::fabs(load.slope_y - slope_y_) * half_y <= kCloseStart * std::fabs(depth);
  }
  double force_x = 0, force_y = 0;
  for (std::int64_t j = 0; j < grid_.ny; ++j) {
    for (std::int64_t i = 0; i < grid_.nx; ++i) {
      const double p = p_[static_cast<std::size_t>(j * grid_.nx + i)];
      force_x += p * grid_.x(i);
      force_y += p * grid_.y(j);
    }
  }
  return std::fabs(force_x / total_ / scale_ - load.force_x) <= kCloseStart * half_x &&
         std::fabs(force_y / total_ / scale_ - load.force_y) <= kCloseStart * half_y;
}

/// The approach at which the bodies touch under the load's slopes, or come to rest under its moments.
double Solver::first_touch_of(const Load& load) const {
  if (!load.tilts()) return first_touch_;
  if (load.moments) return has_rest() ? origin_ + rest_of(load).approach.constant / scale_ : first_touch_;
  double least = HUGE_VAL;
  for (std::int64_t j = 0; j < grid_.ny; ++j) {
    for (std::int64_t i = 0; i < grid_.nx; ++i) {
      least =
          std::min(least, gap_[j * grid_.nx + i] + (load.slope_x * grid_.x(i) + load.slope_y * grid_.y(j)) / scale_);
    }
  }
  return least;
}

bool Solver::has_rest() const {
  return grid_.nx > 1 && grid_.ny > 1;
}

Rest Solver::rest_of(const Load& load) const {
  return rest_under(resources_.backend.arena, placed_, undeformed(gap_), load.force_x * scale_,
                    load.force_y * scale_);
}

void Solver::check_equilibrium(const Load& load) const {
  if (load.drive == Drive::approach && boundary_ == Boundary::periodic && load.target >= mean_gap_) {
    fail(Status::no_equilibrium,
         "approach = " + text(load.target) +
             " m cannot be reached on a periodic grid: the mean displacement is zero, so that "
             "full contact is at the mean gap, " +
             text(mean_gap_) + " m; prescribe a smaller approach or a force");
  }
  if (!load.moments) return;
  const double last_x = grid_.x(grid_.nx - 1) / scale_, last_y = grid_.y(grid_.ny - 1) / scale_;
  if (std::fabs(load.force_x) > last_x || std::fabs(load.force_y) > last_y) {
    fail(Status::no_equilibrium, "eccentricity = [" + text(load.force_x) + ", " + text(load.force_y) +
                                     "] m: no contact can carry a force that acts beyond the last nodes, at [" +
                                     text(last_x) + ", " + text(last_y) + "] m from the centre");
  }
}

Solution Solver::solve(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer) {
  check_equilibrium(load);
  const bool touches = load.drive == Drive::force ? load.target > 0 : load.target > first_touch_of(load);
  if (!touches) {
    separate();
    if (load.drive == Drive::approach) approach_ = load.target;
    return {true, approach_, 0, 0, 0, {}, 0, 0};
  }
  const bool tilting_approach = load.moments && load.drive == Drive::approach;
  return tilting_approach ? solve_tilting_approach(load, tolerance, max_iterations, observer)
                          : solve_in_precision(load, tolerance, max_iterations, observer);
}

/// In unit lengths.
Load Solver::unit(const Load& load) const {
  Load unit_load = load;
  if (load.drive == Drive::approach) unit_load.target = (load.target - origin_) * scale_;
  unit_load.force_x *= scale_;
  unit_load.force_y *= scale_;
  return unit_load;
}

Solution Solver::in_metres(const LevelResult& result) const {
  return {result.converged,   origin_ + result.approach.constant / scale_,
          -result.approach.x, -result.approach.y,
          result.total,       result.certificate,
          result.iterations,  result.convolutions};
}

Solution Solver::solve_in_precision(const Load& load, double tolerance, std::int32_t max_iterations,
                                    Observer observer) {
  Solution solution = mixed_precision_ ? solve_robustly<float>(load, tolerance, max_iterations, observer)
                                       : solve_robustly<double>(load, tolerance, max_iterations, observer);
  if (load.drive == Drive::approach) solution.approach = load.target;
  total_ = solution.total;
  approach_ = solution.approach;
  slope_x_ = solution.slope_x;
  slope_y_ = solution.slope_y;
  return solution;
}

/// A start far from the solution may stall: it is begun again from separated bodies. A load so small that a few nodes
/// far apart carry it is invisible to coarser grids: it is begun from rigid bodies at rest.
template <class Real>
Solution Solver::solve_robustly(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer) {
  const bool started_warm = total_ > 0;
  Solution solution = solve_nested<Real>(load, tolerance, max_iterations, observer);
  const auto stalled = [&] { return !solution.converged && solution.iterations < max_iterations; };
  if (stalled() && started_warm) {
    separate();
    solution = solve_nested<Real>(load, tolerance, max_iterations, observer).after(solution);
  }
  if (!stalled() || !load.moments || !has_rest()) return solution;
  const Rest rest = rest_of(load);
  std::fill(p_.begin(), p_.end(), 0.0);
  for (std::size_t k = 0; k < rest.nodes.size(); ++k) {
    p_[static_cast<std::size_t>(rest.nodes[k])] += load.target * rest.shares[k];
  }
  return in_metres(full_level<Real>().solve(unit(load), tolerance, max_iterations, observer)).after(solution);
}

/// The approach is measured at the centre, the force acts elsewhere, so that the problem with both prescribed is not
/// a minimum of any energy. Its force is the root of approach(force) = prescribed, each state starting from the last:
/// the secant of the logarithms of force and depth at the force's place, which grows with the force like a power,
/// kept between forces known to be too small and too large. What is missed of the approach, relative to that depth,
/// counts as imbalance.
Solution Solver::solve_tilting_approach(const Load& load, double tolerance, std::int32_t max_iterations,
                                        Observer observer) {
  const auto at_force = [&](const Solution& solution) {
    return solution.approach - solution.slope_x * load.force_x - solution.slope_y * load.force_y;
  };
  LinearTrend rest{(first_touch_ - origin_) * scale_, 0, 0};
  if (has_rest()) rest = rest_of(load).approach;
  const double touch = origin_ + rest.at(load.force_x * scale_, load.force_y * scale_) / scale_;
  Load trial = load;
  trial.drive = Drive::force;
  const double estimate =
      scale_ * (load.target - origin_ - rest.constant / scale_) * std::sqrt(static_cast<double>(grid_.nodes()));
  trial.target = total_ > 0 ? total_ : estimate;
  double too_small = 0, too_large = HUGE_VAL;
  double last_force = 0, last_approach = 0;
  double trial_tolerance = kCoarseTolerance;
  Solution solution;
  std::int32_t iterations = 0, convolutions = 0;
  for (int n = 0; n < kForces; ++n) {
    trial_tolerance = std::max(tolerance, trial_tolerance);
    const double force = trial.target;
    solution = solve_in_precision(trial, trial_tolerance, max_iterations, observer);
    iterations += solution.iterations;
    convolutions += solution.convolutions;
    const bool solved = solution.converged;
    const double depth = at_force(solution) - touch;
    const double missing = load.target - solution.approach;
    solution.certificate.balance = std::max(solution.certificate.balance, std::fabs(missing) / depth);
    solution.converged = solution.certificate.worst() <= tolerance;
    if (solution.converged || !solved || !(depth > 0)) break;

    (missing > 0 ? too_small : too_large) = force;
    double exponent = 1.25;  // between a flat punch and a sphere
    const double depth_before = depth + last_approach - solution.approach;
    if (last_force > 0 && depth_before > 0 && depth_before != depth) {
      exponent = std::clamp(std::log(force / last_force) / std::log(depth / depth_before), 0.1, 2.0);
    }
    last_force = force;
    last_approach = solution.approach;
    if (std::fabs(missing) > 0.5 * tolerance * depth) {
      const double growth = std::clamp(1 + missing / depth, 0.1, 10.0);
      trial.target = force * std::pow(growth, exponent);
    }
    if (!(trial.target > too_small && trial.target < too_large)) {
      trial.target = too_large == HUGE_VAL ? 2 * too_small
                     : too_small == 0      ? too_large / 4
                                           : std::sqrt(too_small * too_large);
    }
    trial_tolerance = std::min(trial_tolerance, kTrialCertificate * std::fabs(missing) / depth);
  }
  solution.iterations = iterations;
  solution.convolutions = convolutions;
  return solution;
}

template <class Real>
Solution Solver::solve_nested(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer) {
  const parallel::Arena& arena = resources_.backend.arena;
  const Load unit_load = unit(load);
  const Box whole = Box::whole(grid_);
  std::vector<CoarserGrid> coarser;
  if (!start_is_close(load)) coarser = coarser_grids(placed_, boundary_, {gap_, grid_.nodes()}, arena);
  if (coarser.empty()) {
    return in_metres(full_level<Real>().solve(unit_load, tolerance, max_iterations, observer));
  }

  // The coarsest grid starts from the present pressure.
  Buffer<double> p;
  for (std::size_t level = 0; level < coarser.size(); ++level) {
    const Grid& grid = coarser[level].placed.grid;
    auto restricted = Buffer<double>::uninitialised(grid.nodes());
    restrict_to(level == 0 ? grid_ : coarser[level - 1].placed.grid, level == 0 ? p_.data() : p.data(), grid,
                restricted.data(), arena);
    p = std::move(restricted);
  }

  const double unit_area = grid_.cell_area();
  Box box = Box::whole(coarser.back().placed.grid);
  Buffer<double> g(p.size());
  Buffer<double> gap = gather(coarser.back().placed.grid, box, coarser.back().gap.data());
  for (std::size_t level = coarser.size(); level-- > 0;) {
    const PlacedGrid part = box.of(coarser[level].placed);
    Load level_load = unit_load;
    if (load.drive == Drive::force) level_load.target *= unit_area / part.grid.cell_area();
    level_load.force_x = within(part.x, part.grid.nx, part.grid.dx, unit_load.force_x);
    level_load.force_y = within(part.y, part.grid.ny, part.grid.dy, unit_load.force_y);
    const Compliance<double> compliance(resources_, part.grid, boundary_);
    Level<Real> solver(resources_, compliance, part, boundary_, undeformed(gap.data()), {p.data(), g.data()});
    if (level + 1 < coarser.size()) solver.correct_start(level_load);
    solver.solve(level_load, std::max(kCoarseTolerance, tolerance), kCoarseIterations, observer);

    const Grid& finer = level > 0 ? coarser[level - 1].placed.grid : grid_;
    const double* finer_gap = level > 0 ? coarser[level - 1].gap.data() : gap_;
    const Box next = candidate_box(contact_box(box, p.data()), finer, boundary_);
    const bool in_place = level == 0 && next == whole;
    const std::size_t nodes = in_place ? 0 : static_cast<std::size_t>(next.nx * next.ny);
    auto next_p = Buffer<double>::uninitialised(nodes);
    auto next_g = Buffer<double>::uninitialised(nodes);
    prolong_pressure(box, p.data(), next, in_place ? p_.data() : next_p.data(), arena);
    prolong_displacement(box, g.data(), undeformed(gap.data()), next, in_place ? g_.data() : next_g.data(), arena);
    if (!in_place) gap = gather(finer, next, finer_gap);
    p = std::move(next_p);
    g = std::move(next_g);
    box = next;
  }

  if (box == whole) {
    coarser.clear();
    p = {};
    g = {};
    gap = {};
    full_level<Real>().correct_start(unit_load);
    return in_metres(full_level<Real>().solve(unit_load, tolerance, max_iterations, observer));
  }

  // Only the box is solved, then certified on the whole grid.
  const PlacedGrid part = box.of(placed_);
  const Compliance<double> compliance(resources_, part.grid, boundary_);
  Level<Real> window(resources_, compliance, part, boundary_, undeformed(gap.data()), {p.data(), g.data()});
  window.correct_start(unit_load);
  const LevelResult inside = window.solve(unit_load, tolerance, max_iterations, observer);
  std::fill(p_.begin(), p_.end(), 0.0);
  for (std::int64_t j = 0; j < box.ny; ++j) {
    std::copy_n(p.data() + j * box.nx, box.nx, p_.data() + (box.j0 + j) * grid_.nx + box.i0);
  }
  Passes<double> passes(arena, resources_.backend.kernels, placed_);
  const Certified certified =
      certify(arena, full_compliance(), passes, placed_, undeformed(gap_), p_.data(), g_.data(), unit_load);
  const bool holds = certified.certificate.worst() <= tolerance;
  if (inside.converged && !holds) {  // something outside the box came into contact
    LevelResult again = full_level<Real>().solve(unit_load, tolerance, max_iterations, observer);
    again.iterations += inside.iterations;
    again.convolutions += inside.convolutions + 1;
    return in_metres(again);
  }
  return in_metres({inside.converged && holds, certified.approach, certified.total, certified.certificate,
                    inside.iterations, inside.convolutions + 1});
}

std::vector<SolverPart> Solver::parts(const fft::Backend& backend, const Grid& grid, Boundary boundary,
                                      bool mixed_precision) {
  const std::size_t level =
      mixed_precision ? Level<float>::bytes(backend, grid, boundary) : Level<double>::bytes(backend, grid, boundary);
  return {{"pressure and deformed gap", 2 * Buffer<double>::padded_bytes(grid.nodes())},
          {"compliance: influence coefficients and transform", Compliance<double>::bytes(backend, grid, boundary)},
          {"directions and preconditioner", level},
          {"gaps of the coarser grids", coarser_grids_bytes(grid, boundary)}};
}

}  // namespace brinell::contact
