// bm_solve/<scene>/<method>/<n>/<instruction set>/<precision>/<threads>: one solve of n × n nodes to 1e-6, warm.
// bm_iteration/…: one iteration of conjugate gradients, the mean over ten, from a state close to the solution: what
// most iterations of a solve are.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "contact/level.h"
#include "fft/plan_cache.h"
#include "simd/kernel_table.h"
#include "solve/candidate.h"
#include "solve/textbook.h"

namespace {

using namespace brinell;
using bench::SolveMethod;

constexpr double kTolerance = 1e-6;
constexpr std::int32_t kIterations = 10;

bench::Clock clock_for(int threads) {
  return threads > 1 ? bench::Clock::wall : bench::Clock::cpu;
}

void bm_solve(benchmark::State& state, const bench::SolveCase& which) {
  bench::SolveInputs inputs(which.nodes);
  const auto solve = bench::prepare(which, inputs.make(*which.scene, which.nodes), clock_for(which.threads));
  if (which.method != SolveMethod::textbook) solve();
  bench::SolveSample sample{};
  for (auto _ : state) {
    sample = solve();
    state.SetIterationTime(sample.seconds);
  }
  state.counters["iterations"] = sample.iterations;
  state.counters["certificate"] = sample.certificate;
  state.SetItemsProcessed(state.iterations() * which.nodes * which.nodes);
}

/// Time from the first iteration's end to the tenth's, per iteration.
class IterationTimer {
 public:
  explicit IterationTimer(bench::Clock clock) : clock_(clock) {}
  void observe(std::int32_t iteration) {
    if (iteration == 1) start_ = bench::seconds(clock_);
    if (iteration == kIterations && last_ != kIterations) end_ = bench::seconds(clock_);
    last_ = iteration;
  }
  double per_iteration() const { return (end_ - start_) / (kIterations - 1); }

 private:
  bench::Clock clock_;
  double start_ = 0, end_ = 0;
  std::int32_t last_ = 0;
};

void bm_iteration_textbook(benchmark::State& state, const bench::SolveScene& scene, std::int64_t nodes) {
  bench::SolveInputs inputs(nodes);
  const Grid grid = scene.grid(nodes);
  const bench::SolveInput input = inputs.make(scene, nodes);
  bench::Textbook solver(grid, scene.boundary, input.gap);
  for (auto _ : state) {
    IterationTimer timer(bench::Clock::cpu);
    solver.solve(contact::Drive::force, input.target, 1e-14, kIterations,
                 [&](const bench::TextbookSolution& solution) { timer.observe(solution.iterations); });
    state.SetIterationTime(timer.per_iteration());
  }
  state.SetItemsProcessed(state.iterations() * nodes * nodes);
}

template <class Real>
void bm_iteration(benchmark::State& state, const bench::SolveCase& which) {
  bench::SolveInputs inputs(which.nodes);
  const Grid grid = which.scene->grid(which.nodes);
  const bench::SolveInput input = inputs.make(*which.scene, which.nodes);
  const parallel::Arena arena(which.threads);
  fft::PlanCache plans;
  influence::SpectrumCache spectra(std::size_t{4} << 30);
  const contact::Resources resources{{arena, simd::kernels(which.isa), plans}, spectra};
  const Grid unit{grid.nx, grid.ny, 1, 1};
  const contact::Compliance<double> compliance(resources, unit, which.scene->boundary);
  Buffer<double> p(grid.nodes()), g(grid.nodes());
  contact::Level<Real> level(resources, compliance, contact::PlacedGrid::centred(unit), which.scene->boundary,
                             {input.gap, 1 / grid.dx, 0.0}, {p.data(), g.data()});
  const auto go_on = [](const contact::Report&) { return true; };
  const contact::Load load{contact::Drive::force, input.target};
  level.solve(load, 1e-3, 500, go_on);
  const std::vector<double> start(p.begin(), p.end());
  for (auto _ : state) {
    std::copy(start.begin(), start.end(), p.begin());
    IterationTimer timer(clock_for(which.threads));
    level.solve(load, 1e-14, kIterations, [&](const contact::Report& report) {
      timer.observe(report.iteration);
      return true;
    });
    state.SetIterationTime(timer.per_iteration());
  }
  state.SetItemsProcessed(state.iterations() * which.nodes * which.nodes);
}

template <class Function>
void add(const std::string& name, Function function) {
  benchmark::RegisterBenchmark(name.c_str(), function)->UseManualTime()->Unit(benchmark::kMillisecond);
}

void add_scene(const bench::SolveScene& scene, std::int64_t nodes) {
  const std::string place = "/" + scene.name + "/";
  const std::string size = "/" + std::to_string(nodes) + "/";
  const bench::SolveCase textbook{&scene, nodes, SolveMethod::textbook, simd::Isa::baseline, 1, kTolerance};
  add("bm_solve" + place + "textbook" + size + "fftw/double/1",
      [=](benchmark::State& state) { bm_solve(state, textbook); });
  add("bm_iteration" + place + "textbook" + size + "fftw/double/1",
      [&scene, nodes](benchmark::State& state) { bm_iteration_textbook(state, scene, nodes); });
  for (const simd::Isa isa : simd::supported()) {
    for (const SolveMethod method : {SolveMethod::in_double, SolveMethod::mixed}) {
      for (const int threads : {1, 2}) {
        const bench::SolveCase which{&scene, nodes, method, isa, threads, kTolerance};
        const std::string end =
            size + std::string(simd::name(isa)) + "/" + name(method) + "/" + std::to_string(threads);
        add("bm_solve" + place + "brinell" + end, [=](benchmark::State& state) { bm_solve(state, which); });
        add("bm_iteration" + place + "brinell" + end, [=](benchmark::State& state) {
          if (which.method == SolveMethod::mixed) {
            bm_iteration<float>(state, which);
          } else {
            bm_iteration<double>(state, which);
          }
        });
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* scene : {"rough_5", "rough_20", "sphere", "periodic_5"}) {
    for (const std::int64_t nodes : {256, 512, 1024}) add_scene(bench::solve_scene(scene), nodes);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
