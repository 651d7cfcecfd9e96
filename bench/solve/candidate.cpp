#include "solve/candidate.h"

#include <algorithm>
#include <memory>

#include "contact/solver.h"
#include "fft/plan_cache.h"
#include "measure/worker.h"
#include "simd/kernel_table.h"
#include "solve/textbook.h"

namespace brinell::bench {

namespace {

constexpr std::int32_t kMostIterations = 5000;
constexpr double kTargetTolerance = 1e-9;  // of the solution whose approach is prescribed

/// What solvers need and keep.
struct Engine {
  Engine(simd::Isa isa, int threads) : arena(threads), resources{{arena, simd::kernels(isa), plans}, spectra} {}

  parallel::Arena arena;
  fft::PlanCache plans;
  influence::SpectrumCache spectra{std::size_t{8} << 30};
  contact::Resources resources;
};

contact::Drive drive_of(const SolveScene& scene) {
  return scene.by_approach ? contact::Drive::approach : contact::Drive::force;
}

double contact_fraction(const double* pressure, std::size_t nodes) {
  const auto active = std::count_if(pressure, pressure + nodes, [](double p) { return p > 0; });
  return static_cast<double>(active) / static_cast<double>(nodes);
}

std::function<SolveSample()> prepare_textbook(const SolveCase& which, const SolveInput& input, Clock clock) {
  const Grid grid = which.scene->grid(which.nodes);
  const auto solver = std::make_shared<Textbook>(grid, which.scene->boundary, input.gap);
  return [=] {
    const double start = seconds(clock);
    const TextbookSolution solution =
        solver->solve(drive_of(*which.scene), input.target, which.tolerance, kMostIterations);
    const double end = seconds(clock);
    return SolveSample{end - start,         solution.certificate.worst(),
                       solution.approach,   contact_fraction(solver->pressure().data(), grid.nodes()),
                       solution.iterations, solution.convolutions,
                       solution.converged};
  };
}

}  // namespace

const char* name(SolveMethod method) {
  switch (method) {
    case SolveMethod::textbook: return "textbook";
    case SolveMethod::in_double: return "double";
    case SolveMethod::mixed: return "mixed";
  }
  return "";
}

SolveInputs::SolveInputs(std::int64_t largest_nodes)
    : memory_(static_cast<double*>(
          shared_memory((1 + static_cast<std::size_t>(largest_nodes * largest_nodes)) * sizeof(double)))) {}

SolveInput SolveInputs::make(const SolveScene& scene, std::int64_t nodes) {
  double* gap = memory_ + 1;
  run_apart([&] {
    Engine engine(simd::supported().back(), 1);
    const Grid grid = scene.grid(nodes);
    scene.fill_gap(grid, {gap, grid.nodes()}, engine.arena);
    *memory_ = scene.mean_pressure * static_cast<double>(grid.nodes());
    if (scene.by_approach) {
      contact::Solver solver(engine.resources, grid, scene.boundary, gap, false);
      *memory_ = solver
                     .solve({contact::Drive::force, *memory_}, kTargetTolerance, kMostIterations,
                            [](const contact::Report&) { return true; })
                     .approach;
    }
  });
  return {gap, *memory_};
}

std::function<SolveSample()> prepare(const SolveCase& which, const SolveInput& input, Clock clock) {
  if (which.method == SolveMethod::textbook) return prepare_textbook(which, input, clock);
  const auto engine = std::make_shared<Engine>(which.isa, which.threads);
  return [=] {
    const Grid grid = which.scene->grid(which.nodes);
    const double start = seconds(clock);
    contact::Solver solver(engine->resources, grid, which.scene->boundary, input.gap,
                           which.method == SolveMethod::mixed);
    const contact::Solution solution = solver.solve({drive_of(*which.scene), input.target}, which.tolerance,
                                                    kMostIterations, [](const contact::Report&) { return true; });
    const double end = seconds(clock);
    return SolveSample{end - start,         solution.certificate.worst(),
                       solution.approach,   contact_fraction(solver.pressure().data(), grid.nodes()),
                       solution.iterations, solution.convolutions,
                       solution.converged};
  };
}

}  // namespace brinell::bench
