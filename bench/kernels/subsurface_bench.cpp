// Six stress components below the surface, ours and the textbook's, and what it costs to find the largest von Mises
// stress alone. Goals, one thread, 128 x 128 x 64: from pressure 4 times, from pressure and both shears 5 times as
// fast as the textbook. With --compare [ROUNDS]: all candidates take turns in one process, round after round, process
// CPU time, medians over the rounds and of the ratios within a round; otherwise Google Benchmark.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fft/plan_cache.h"
#include "kernels/textbook_stress.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "subsurface/depths.h"
#include "subsurface/stress_field.h"

namespace brinell {
namespace {

using namespace subsurface;

constexpr std::size_t kKeepAll = static_cast<std::size_t>(-1);

struct Case {
  std::int64_t nodes, layers;
  int sources;  // 1: pressure, 3: and both shears

  Grid grid() const { return {nodes, nodes, 1e-6, 1e-6}; }
  std::vector<double> depths() const { return layer_depths(layers, 1e-6); }
  std::string name() const {
    return std::to_string(nodes) + "x" + std::to_string(nodes) + "x" + std::to_string(layers) +
           (sources == 1 ? "/pressure" : "/pressure_and_shears");
  }
  std::vector<double> tractions() const {
    std::vector<double> values(static_cast<std::size_t>(3 * nodes * nodes));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1e9);
    for (double& value : values) value = uniform(random);
    return values;
  }
  std::array<const double*, 3> pointers(const std::vector<double>& tractions) const {
    return {tractions.data(), tractions.data() + nodes * nodes, tractions.data() + 2 * nodes * nodes};
  }
};

struct Ours {
  Ours(const Case& one, simd::Isa isa, int threads, std::size_t spectra_limit, bool maximum_only)
      : arena(threads), stress({arena, simd::kernels(isa), plans}, request(one, maximum_only), spectra_limit) {}

  static StressRequest request(const Case& one, bool maximum_only) {
    StressRequest request;
    request.grid = one.grid();
    request.poissons_ratio = 0.3;
    request.depths = one.depths();
    if (one.sources == 3) request.sources = {Traction::pressure, Traction::shear_x, Traction::shear_y};
    if (maximum_only) {
      request.maxima = {Invariant::von_mises};
    } else {
      request.components = kAllComponents;
    }
    return request;
  }

  parallel::Arena arena;
  fft::PlanCache plans;
  StressField stress;
};

struct Fields {
  explicit Fields(const Case& one) : memory(static_cast<std::size_t>(6 * one.nodes * one.nodes * one.layers)) {
    for (std::size_t c = 0; c < 6; ++c) component[c] = memory.data() + c * memory.size() / 6;
  }
  std::vector<double> memory;
  std::array<double*, 6> component{};
};

void bm_stress(benchmark::State& state, Case one, simd::Isa isa, int threads, std::size_t limit, bool maximum_only) {
  Ours ours(one, isa, threads, limit, maximum_only);
  Fields fields(one);
  const std::vector<double> tractions = one.tractions();
  StressFields targets;
  targets.component = fields.component;
  for (auto _ : state) benchmark::DoNotOptimize(ours.stress.compute(one.pointers(tractions), targets));
  state.SetItemsProcessed(state.iterations() * one.nodes * one.nodes * one.layers);
}

void bm_textbook(benchmark::State& state, Case one) {
  bench::TextbookStress textbook(one.grid(), 0.3, one.depths(), one.sources);
  textbook.make_spectra();
  Fields fields(one);
  const std::vector<double> tractions = one.tractions();
  for (auto _ : state) textbook.compute(one.pointers(tractions), true, fields.component);
  state.SetItemsProcessed(state.iterations() * one.nodes * one.nodes * one.layers);
}

void add_all() {
  for (const Case& one : {Case{128, 64, 1}, Case{128, 64, 3}, Case{256, 32, 1}}) {
    const auto add = [&](const std::string& name, auto... arguments) {
      benchmark::RegisterBenchmark((name + "/" + one.name()).c_str(), arguments...)
          ->Unit(benchmark::kMillisecond)
          ->MeasureProcessCPUTime();
    };
    add("bm_textbook", bm_textbook, one);
    for (const simd::Isa isa : simd::supported()) {
      const std::string on = "/" + std::string(simd::name(isa));
      for (const int threads : {1, 2}) {
        const std::string end = on + "/threads:" + std::to_string(threads);
        add("bm_stress_kept" + end, bm_stress, one, isa, threads, kKeepAll, false);
        add("bm_stress_streamed" + end, bm_stress, one, isa, threads, std::size_t{0}, false);
        add("bm_largest_von_mises_kept" + end, bm_stress, one, isa, threads, kKeepAll, true);
      }
    }
  }
}

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

void compare(const Case& one, int rounds) {
  struct Candidate {
    std::string name;
    std::function<void()> run;
    std::size_t against;  // candidate
    std::vector<double> times{};
  };
  const std::vector<double> tractions = one.tractions();
  const std::array<const double*, 3> pointers = one.pointers(tractions);
  Fields expected(one), found(one);
  StressFields targets;
  targets.component = found.component;
  bench::TextbookStress stored(one.grid(), 0.3, one.depths(), one.sources);
  bench::TextbookStress generating(one.grid(), 0.3, one.depths(), one.sources);
  stored.make_spectra();
  const simd::Isa best = simd::supported().back();
  Ours kept(one, best, 1, kKeepAll, false), streamed(one, best, 1, 0, false);
  Ours maximum(one, best, 1, kKeepAll, true), streamed_maximum(one, best, 1, 0, true);
  Ours narrow(one, simd::supported()[std::min<std::size_t>(1, simd::supported().size() - 1)], 1, kKeepAll, false);
  std::vector<Candidate> candidates{
      {"textbook, spectra stored", [&] { stored.compute(pointers, true, expected.component); }, 0},
      {"textbook, spectra made", [&] { generating.compute(pointers, false, expected.component); }, 1},
      {"ours, spectra kept", [&] { kept.stress.compute(pointers, targets); }, 0},
      {"ours, spectra kept, avx2", [&] { narrow.stress.compute(pointers, targets); }, 0},
      {"ours, spectra made", [&] { streamed.stress.compute(pointers, targets); }, 1},
      {"ours, von Mises max, kept", [&] { maximum.stress.compute(pointers, {}); }, 0},
      {"ours, von Mises max, made", [&] { streamed_maximum.stress.compute(pointers, {}); }, 1}};
  for (int round = -1; round < rounds; ++round) {  // the first warms up
    for (Candidate& candidate : candidates) {
      const double start = cpu_seconds();
      candidate.run();
      if (round >= 0) candidate.times.push_back(cpu_seconds() - start);
    }
  }
  double largest = 0, error = 0;
  for (std::size_t k = 0; k < expected.memory.size(); ++k) {
    largest = std::max(largest, std::abs(expected.memory[k]));
    error = std::max(error, std::abs(expected.memory[k] - found.memory[k]));
  }
  for (const Candidate& candidate : candidates) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < candidate.times.size(); ++i) {
      ratios.push_back(candidates[candidate.against].times[i] / candidate.times[i]);
    }
    std::printf("| %-34s | %-26s | %8.1f | %5.2f (%.2f to %.2f) |\n", one.name().c_str(), candidate.name.c_str(),
                1e3 * quantile(candidate.times, 0.5), quantile(ratios, 0.5), quantile(ratios, 0.25),
                quantile(ratios, 0.75));
  }
  const StressPlan& plan = kept.stress.plan();
  std::printf(
      "  largest difference from the textbook, of the largest stress: %.1e; planned bytes: fields %zu, spectra "
      "%zu, work %zu\n",
      error / largest, plan.field_bytes, plan.kept_bytes, plan.work_bytes);
  std::fflush(stdout);
}

}  // namespace
}  // namespace brinell

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--compare") {
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 7;
    std::printf("| case                               | candidate                  |   CPU ms | times as fast |\n");
    for (const int sources : {1, 3}) brinell::compare({128, 64, sources}, rounds);
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  brinell::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
