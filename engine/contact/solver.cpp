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

struct GapSums {
  double least = HUGE_VAL;
  double sum = 0;
};

}  // namespace

Solver::Solver(const Resources& resources, const Grid& grid, Boundary boundary, const double* gap,
               bool mixed_precision)
    : resources_(resources),
      grid_{grid.nx, grid.ny, 1.0, grid.dy / grid.dx},
      boundary_(boundary),
      gap_(gap),
      scale_(1 / grid.dx),
      mixed_precision_(mixed_precision),
      p_(grid.nodes()),
      g_(grid.nodes()) {
  const auto sums = ordered_sum<GapSums>(
      resources.backend.arena, static_cast<std::int64_t>(grid.nodes()), 1 << 14,
      [](GapSums& total, const GapSums& part) {
        total.least = std::min(total.least, part.least);
        total.sum += part.sum;
      },
      [&](std::int64_t begin, std::int64_t end) {
        GapSums part;
        for (std::int64_t n = begin; n < end; ++n) {
          part.least = std::min(part.least, gap[n]);
          part.sum += gap[n];
        }
        return part;
      });
  first_touch_ = sums.least;
  mean_gap_ = sums.sum / static_cast<double>(grid.nodes());
  separate();
}

Solver::~Solver() = default;

/// No pressure: the undeformed gap.
void Solver::separate() {
  std::fill(p_.begin(), p_.end(), 0.0);
  for (std::size_t n = 0; n < g_.size(); ++n) g_[n] = scale_ * (gap_[n] - first_touch_);
  total_ = 0;
  approach_ = first_touch_;
}

Solver::State Solver::state() const {
  State state{{}, total_, approach_};
  if (total_ > 0) {
    state.pressure = Buffer<double>::uninitialised(p_.size());
    std::copy(p_.begin(), p_.end(), state.pressure.begin());
  }
  return state;
}

void Solver::restore(const State& state) {
  separate();
  if (!(state.total > 0)) {
    approach_ = state.approach;
    return;
  }
  std::copy(state.pressure.begin(), state.pressure.end(), p_.begin());
  total_ = state.total;
  approach_ = state.approach;
  full_compliance().apply(p_.data(), g_.data());
  Passes<double>(resources_.backend.arena, resources_.backend.kernels, grid_.nodes())
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
    level = std::make_unique<Level<Real>>(resources_, full_compliance(), grid_, boundary_, undeformed(gap_),
                                          Fields{p_.data(), g_.data()});
  }
  return *level;
}

bool Solver::start_is_close(Drive drive, double target) const {
  if (!(total_ > 0)) return false;
  const double before = drive == Drive::force ? total_ : approach_ - first_touch_;
  const double after = drive == Drive::force ? target : target - first_touch_;
  return std::fabs(after - before) <= kCloseStart * std::fabs(before);
}

Solution Solver::solve(Drive drive, double target, double tolerance, std::int32_t max_iterations, Observer observer) {
  const bool touches = drive == Drive::force ? target > 0 : target > first_touch_;
  if (!touches) {
    separate();
    if (drive == Drive::approach) approach_ = target;
    return {true, approach_, 0, {}, 0, 0};
  }
  if (drive == Drive::approach && boundary_ == Boundary::periodic && target >= mean_gap_) {
    fail(Status::no_equilibrium,
         "approach = " + text(target) +
             " m cannot be reached on a periodic grid: the mean displacement is zero, so that "
             "full contact is at the mean gap, " +
             text(mean_gap_) + " m; prescribe a smaller approach or a force");
  }
  Solution solution = mixed_precision_ ? solve_nested<float>(drive, target, tolerance, max_iterations, observer)
                                       : solve_nested<double>(drive, target, tolerance, max_iterations, observer);
  if (drive == Drive::approach) solution.approach = target;
  total_ = solution.total;
  approach_ = solution.approach;
  return solution;
}

template <class Real>
Solution Solver::solve_nested(Drive drive, double target, double tolerance, std::int32_t max_iterations,
                              Observer observer) {
  const parallel::Arena& arena = resources_.backend.arena;
  const double unit_target = drive == Drive::approach ? (target - first_touch_) * scale_ : target;
  const auto to_solution = [&](const LevelResult& result) {
    return Solution{result.converged,  first_touch_ + result.approach / scale_,
                    result.total,      result.certificate,
                    result.iterations, result.convolutions};
  };
  const Box whole = Box::whole(grid_);
  std::vector<CoarserGrid> coarser;
  if (!start_is_close(drive, target)) coarser = coarser_grids(grid_, boundary_, {gap_, grid_.nodes()}, arena);
  if (coarser.empty()) {
    return to_solution(full_level<Real>().solve(drive, unit_target, tolerance, max_iterations, observer));
  }

  // The coarsest grid starts from the present pressure.
  Buffer<double> p;
  for (std::size_t level = 0; level < coarser.size(); ++level) {
    auto restricted = Buffer<double>::uninitialised(coarser[level].grid.nodes());
    restrict_to(level == 0 ? grid_ : coarser[level - 1].grid, level == 0 ? p_.data() : p.data(), coarser[level].grid,
                restricted.data(), arena);
    p = std::move(restricted);
  }

  const double unit_area = grid_.cell_area();
  Box box = Box::whole(coarser.back().grid);
  Buffer<double> g(p.size());
  Buffer<double> gap = gather(coarser.back().grid, box, coarser.back().gap.data());
  for (std::size_t level = coarser.size(); level-- > 0;) {
    const Grid& grid = coarser[level].grid;
    const Grid part{box.nx, box.ny, grid.dx, grid.dy};
    const double level_target = drive == Drive::force ? unit_target * unit_area / grid.cell_area() : unit_target;
    const Compliance<double> compliance(resources_, part, boundary_);
    Level<Real> solver(resources_, compliance, part, boundary_, undeformed(gap.data()), {p.data(), g.data()});
    if (level + 1 < coarser.size()) solver.correct_start(drive, level_target);
    solver.solve(drive, level_target, std::max(kCoarseTolerance, tolerance), kCoarseIterations, observer);

    const Grid& finer = level > 0 ? coarser[level - 1].grid : grid_;
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
    full_level<Real>().correct_start(drive, unit_target);
    return to_solution(full_level<Real>().solve(drive, unit_target, tolerance, max_iterations, observer));
  }

  // Only the box is solved, then certified on the whole grid.
  const Grid part{box.nx, box.ny, grid_.dx, grid_.dy};
  const Compliance<double> compliance(resources_, part, boundary_);
  Level<Real> window(resources_, compliance, part, boundary_, undeformed(gap.data()), {p.data(), g.data()});
  window.correct_start(drive, unit_target);
  const LevelResult inside = window.solve(drive, unit_target, tolerance, max_iterations, observer);
  std::fill(p_.begin(), p_.end(), 0.0);
  for (std::int64_t j = 0; j < box.ny; ++j) {
    std::copy_n(p.data() + j * box.nx, box.nx, p_.data() + (box.j0 + j) * grid_.nx + box.i0);
  }
  Passes<double> passes(arena, resources_.backend.kernels, grid_.nodes());
  const Certified certified = certify(arena, full_compliance(), passes, grid_.nodes(), undeformed(gap_), p_.data(),
                                      g_.data(), drive, unit_target);
  const bool holds = certified.certificate.worst() <= tolerance;
  if (inside.converged && !holds) {  // something outside the box came into contact
    LevelResult again = full_level<Real>().solve(drive, unit_target, tolerance, max_iterations, observer);
    again.iterations += inside.iterations;
    again.convolutions += inside.convolutions + 1;
    return to_solution(again);
  }
  return to_solution({inside.converged && holds, certified.approach, certified.total, certified.certificate,
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
