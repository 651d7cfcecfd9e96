// Forces beside the centre: what they cost against centric ones, and against Newton's method around the centric
// solver. Everything takes turns in one process, round after round, on one thread and in process CPU time.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "contact/solver.h"
#include "fft/plan_cache.h"
#include "measure/clock.h"
#include "measure/statistics.h"
#include "simd/kernel_table.h"
#include "solve/nested_newton.h"
#include "solve/scenes.h"

namespace {

using namespace brinell;

constexpr std::int32_t kMostIterations = 5000;
constexpr std::int32_t kIterations = 10;                         // of which one is timed, the first left out
constexpr double kEccentricities[] = {0.0, 0.1, 0.2, 0.3, 0.4};  // of the flat's radius

struct Options {
  std::vector<std::int64_t> sizes{128, 256};
  std::vector<std::int64_t> iteration_sizes{256, 512, 1024};
  std::vector<std::string> iteration_scenes{"punch", "rough_20"};
  std::vector<double> tolerances{1e-3, 1e-8};
  bool solves = true, iterations = true;
  int repeats = 6;
  int iteration_repeats = 30;
  simd::Isa isa = simd::supported().back();
};

constexpr auto go_on = [](const contact::Report&) { return true; };

double seconds_of(const auto& work) {
  const double start = bench::seconds(bench::Clock::cpu);
  work();
  return bench::seconds(bench::Clock::cpu) - start;
}

struct Engine {
  explicit Engine(simd::Isa isa) : arena(1), resources{{arena, simd::kernels(isa), plans}, spectra} {}

  parallel::Arena arena;
  fft::PlanCache plans;
  influence::SpectrumCache spectra{std::size_t{4} << 30};
  contact::Resources resources;
};

std::vector<double> gap_of(const bench::SolveScene& scene, const Grid& grid, const parallel::Arena& arena) {
  std::vector<double> gap(grid.nodes());
  scene.fill_gap(grid, gap, arena);
  return gap;
}

contact::Load load_of(double total, bool moments, double x0) {
  contact::Load load{contact::Drive::force, total};
  load.moments = moments;
  load.force_x = x0;
  return load;
}

/// Without moments, then at every eccentricity; beside the last of them the textbook.
void compare_solves(const Options& options, Engine& engine, std::int64_t nodes, double tolerance) {
  const bench::SolveScene& scene = bench::solve_scene("punch");
  const Grid grid = scene.grid(nodes);
  const std::vector<double> gap = gap_of(scene, grid, engine.arena);
  const double total = scene.mean_pressure * static_cast<double>(grid.nodes());
  bench::NestedNewton textbook(grid, gap.data());

  struct Row {
    contact::Load load;
    contact::Solution ours{};
    bench::NestedSolution nested{};
    std::vector<double> seconds{}, nested_seconds{};
  };
  std::vector<Row> rows{{load_of(total, false, 0)}};
  for (const double e : kEccentricities) rows.push_back({load_of(total, true, e * bench::kPunchRadius)});
  for (int round = 0; round <= options.repeats; ++round) {
    for (Row& row : rows) {
      const double ours = seconds_of([&] {
        contact::Solver solver(engine.resources, grid, Boundary::free, gap.data(), false);
        row.ours = solver.solve(row.load, tolerance, kMostIterations, go_on);
      });
      // Long turns vary less: two tell as much.
      const bool long_enough = round > 2;
      const double nested = long_enough ? 0 : seconds_of([&] {
        row.nested = textbook.solve(total, row.load.force_x, tolerance, kMostIterations);
      });
      if (round == 0) continue;  // fills the caches
      row.seconds.push_back(ours);
      if (!long_enough) row.nested_seconds.push_back(nested);
    }
  }
  for (const Row& row : rows) {
    const double seconds = bench::median(row.seconds), nested = bench::median(row.nested_seconds);
    const std::string e = row.load.moments
                              ? CLI::detail::to_string(std::round(10 * row.load.force_x / bench::kPunchRadius) / 10)
                              : "none";
    std::printf(
        "| %lld² | %.0e | %s | %d | %.2f | %.4f | %.2f | %.0e | %d | %d | %d | %.1f | %.4f | %.0e%s | %.1f |\n",
        static_cast<long long>(nodes), tolerance, e.c_str(), row.ours.iterations,
        static_cast<double>(row.ours.iterations) / rows[0].ours.iterations, seconds,
        seconds / bench::median(rows[0].seconds), row.ours.certificate.worst(), row.nested.steps,
        row.nested.solutions, row.nested.iterations,
        static_cast<double>(row.nested.iterations) / rows[0].nested.iterations, nested,
        row.nested.certificate.worst(), row.nested.converged ? "" : " (failed)", nested / seconds);
    std::fflush(stdout);
  }
}

/// One level close to its solution, and what an iteration of it takes.
class Iterations {
 public:
  Iterations(Engine& engine, const Grid& grid, const contact::Compliance<double>& compliance,
             const std::vector<double>& gap, const contact::Load& load)
      : load_(load),
        p_(grid.nodes()),
        g_(grid.nodes()),
        level_(engine.resources, compliance, contact::PlacedGrid::centred({grid.nx, grid.ny, 1, 1}), Boundary::free,
               {gap.data(), 1 / grid.dx, 0.0}, {p_.data(), g_.data()}) {
    level_.solve(load_, 1e-3, 500, go_on);
    start_.assign(p_.begin(), p_.end());
  }

  double seconds() {
    std::copy(start_.begin(), start_.end(), p_.begin());
    double begin = 0, end = 0;
    const contact::LevelResult result = level_.solve(load_, 1e-14, kIterations, [&](const contact::Report& report) {
      const double now = bench::seconds(bench::Clock::cpu);
      if (report.iteration == 1 && begin == 0) begin = now;
      if (report.iteration == kIterations && end == 0) end = now;
      return true;
    });
    convolutions_ = result.convolutions;
    return (end - begin) / (kIterations - 1);
  }

  std::int32_t convolutions() const { return convolutions_; }

 private:
  contact::Load load_;
  Buffer<double> p_, g_;
  contact::Level<double> level_;
  std::vector<double> start_;
  std::int32_t convolutions_ = 0;
};

/// The force acts at the centre, which makes the contacts nearly the same.
void compare_iterations(const Options& options, Engine& engine, const bench::SolveScene& scene, std::int64_t nodes) {
  const Grid grid = scene.grid(nodes);
  const std::vector<double> gap = gap_of(scene, grid, engine.arena);
  const double total = scene.mean_pressure * static_cast<double>(grid.nodes());
  const contact::Compliance<double> compliance(engine.resources, {grid.nx, grid.ny, 1, 1}, Boundary::free);
  Iterations parallel(engine, grid, compliance, gap, load_of(total, false, 0));
  Iterations tilting(engine, grid, compliance, gap, load_of(total, true, 0));
  std::vector<double> without, with, ratios;
  for (int round = 0; round < options.iteration_repeats; ++round) {
    const bool first = round % 2 == 0;
    const double a = first ? parallel.seconds() : tilting.seconds();
    const double b = first ? tilting.seconds() : parallel.seconds();
    without.push_back(first ? a : b);
    with.push_back(first ? b : a);
    ratios.push_back(with.back() / without.back());
  }
  const bench::Band band = bench::bootstrap_median(ratios);
  std::printf("| %s | %lld² | %.4f | %.4f | %.3f | %.3f to %.3f | %d, %d |\n", scene.name.c_str(),
              static_cast<long long>(nodes), 1e3 * bench::median(without), 1e3 * bench::median(with), band.middle,
              band.low, band.high, parallel.convolutions(), tilting.convolutions());
  std::fflush(stdout);
}

void compare_all(const Options& options) {
  Engine engine(options.isa);
  if (options.solves) {
    std::printf(
        "Rounded punch, force at e times the flat's radius.\n\n"
        "| nodes | tolerance | e | iterations | to centric | seconds | to centric | certificate | Newton steps | "
        "solutions "
        "| iterations | to centric | seconds | certificate | times as fast |\n"
        "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  }
  for (const std::int64_t nodes : options.sizes) {
    if (!options.solves) break;
    for (const double tolerance : options.tolerances) compare_solves(options, engine, nodes, tolerance);
  }
  if (!options.iterations) return;
  std::printf(
      "\nOne iteration [ms].\n\n| scene | nodes | parallel | tilting | ratio | 95 %% | convolutions in ten |\n"
      "|---|--:|--:|--:|--:|---|--:|\n");
  for (const std::string& scene : options.iteration_scenes) {
    for (const std::int64_t nodes : options.iteration_sizes) {
      compare_iterations(options, engine, bench::solve_scene(scene), nodes);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Forces beside the centre: this engine and Newton's method around the centric textbook, and one iteration of\n"
      "bodies that may tilt beside one of bodies that stay parallel, as Markdown tables. Medians of process CPU "
      "time.",
      "compare_tilt");
  std::map<std::string, simd::Isa> isas;
  for (const simd::Isa isa : simd::supported()) isas.emplace(simd::name(isa), isa);
  app.add_option("--sizes", options.sizes, "n of n x n nodes of whole solves (128,256)")
      ->delimiter(',')
      ->check(CLI::Range(2, 16384));
  app.add_option("--tolerances", options.tolerances, "On the certificate (1e-3,1e-8)")
      ->delimiter(',')
      ->check(CLI::Range(1e-14, 0.1));
  app.add_option("--repeats", options.repeats, "Rounds of whole solves (6)")->check(CLI::Range(1, 1000));
  app.add_option("--iteration-sizes", options.iteration_sizes, "Of single iterations (256,512,1024)")
      ->delimiter(',')
      ->check(CLI::Range(2, 16384));
  app.add_option("--iteration-repeats", options.iteration_repeats, "Rounds of single iterations (30)")
      ->check(CLI::Range(2, 1000));
  app.add_flag("!--no-solves", options.solves, "Single iterations alone");
  app.add_flag("!--no-iterations", options.iterations, "Whole solves alone");
  app.add_option("--isa", options.isa, "Instruction set")->transform(CLI::CheckedTransformer(isas));
  CLI11_PARSE(app, argc, argv);
  try {
    compare_all(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_tilt: %s\n", error.what());
    return 1;
  }
  return 0;
}
