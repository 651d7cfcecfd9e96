// Return mapping beside the textbook's, 32768 points, Swift's law; "again": as the plastic loop calls it, blocks
// without plastic strain left unwritten. Goals, one thread: all points plastic at least 6 times (AVX2 3.5 times) as
// fast as the textbook, better 15 times; 2 % plastic in clusters at least 150 million points a second, better 1200
// million. With
// --compare [ROUNDS]: all candidates take turns in one process, round after round, process CPU time, medians over the
// rounds and of the ratios within a round, and the largest residuals; otherwise Google Benchmark.
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

#include "kernels/textbook_return.h"
#include "parallel/arena.h"
#include "plastic/return_mapping.h"
#include "simd/kernel_table.h"

namespace brinell {
namespace {

using namespace plastic;

constexpr std::size_t kPoints = 32768;
constexpr std::size_t kStride = kPoints + 72;  // arrays a power of two apart would share a few cache sets
constexpr double kShearModulus = 80.77e9;
constexpr Swift kSteel{1240e6, 30, 0.085, 1e6};

enum class Load { all, half, clusters, none };

struct Case {
  Load load;
  const char* name;
};
constexpr Case kCases[] = {{Load::all, "all_plastic"},
                           {Load::half, "half_at_random"},
                           {Load::clusters, "2_percent_in_clusters"},
                           {Load::none, "elastic"}};

struct Points {
  explicit Points(Load load) : memory(15 * kStride) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const bool clustered = i % 12800 >= 6000 && i % 12800 < 6256;
      const bool yields =
          load == Load::all || (load == Load::half && uniform(random) < 0.5) || (load == Load::clusters && clustered);
      const bool hardened = load != Load::none && (load != Load::clusters || clustered);
      const double p = hardened ? 0.01 * uniform(random) : 0;
      double s[6], square = 0;
      for (double& component : s) component = normal(random);
      const double mean = (s[0] + s[1] + s[2]) / 3;
      for (int c = 0; c < 6; ++c) square += (c < 3 ? 1.5 : 3) * std::pow(s[c] - (c < 3 ? mean : 0), 2);
      const double reach = yields ? 1.05 + 2 * uniform(random) : 0.9 * uniform(random);
      const double q = reach * bench::swift_stress(kSteel, p), pressure = -3e9 * uniform(random);
      for (int c = 0; c < 6; ++c) {
        memory[c * kStride + i] = (s[c] - (c < 3 ? mean : 0)) * q / std::sqrt(square) + (c < 3 ? pressure : 0);
      }
      memory[6 * kStride + i] = p;
    }
  }

  TrialState state() const {
    TrialState state;
    state.count = kPoints;
    for (std::size_t c = 0; c < 6; ++c) state.trial[c] = memory.data() + c * kStride;
    state.plastic_strain = memory.data() + 6 * kStride;
    return state;
  }
  MappedState result() {
    MappedState result;
    for (std::size_t c = 0; c < 6; ++c) result.increment[c] = memory.data() + (7 + c) * kStride;
    result.plastic_strain = memory.data() + 13 * kStride;
    return result;
  }
  /// As the plastic loop calls it: blocks without plastic strain are not written again.
  MappedState result_again() {
    MappedState again = result();
    again.moved = moved.data();
    return again;
  }
  double* von_mises() { return memory.data() + 14 * kStride; }

  std::vector<double> memory;
  std::vector<std::uint8_t> moved = std::vector<std::uint8_t>(moved_size(kPoints), 1);
};

void bm_return_mapping(benchmark::State& state, Load load, simd::Isa isa, int threads, bool again) {
  const parallel::Arena arena(threads);
  const YieldCurve law({kSteel, {}});
  Points points(load);
  for (auto _ : state) {
    map_to_yield(arena, simd::kernels(isa), law, kShearModulus, points.state(),
                 again ? points.result_again() : points.result());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoints));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(14 * sizeof(double) * kPoints));
}

void bm_textbook(benchmark::State& state, Load load) {
  Points points(load);
  const MappedState result = points.result();
  for (auto _ : state) {
    bench::textbook_return(kSteel, kShearModulus, kPoints, points.state().trial, points.state().plastic_strain,
                           result.increment, result.plastic_strain);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoints));
}

void add_all() {
  for (const Case& one : kCases) {
    const auto add = [&](const std::string& name, auto... arguments) {
      benchmark::RegisterBenchmark((name + "/" + one.name).c_str(), arguments...)
          ->Unit(benchmark::kMicrosecond)
          ->MeasureProcessCPUTime();
    };
    add("bm_textbook", bm_textbook, one.load);
    for (const simd::Isa isa : simd::supported()) {
      for (const int threads : {1, 2}) {
        const std::string end = "/" + std::string(simd::name(isa)) + "/threads:" + std::to_string(threads);
        add("bm_return_mapping" + end, bm_return_mapping, one.load, isa, threads, false);
        add("bm_return_mapping_again" + end, bm_return_mapping, one.load, isa, threads, true);
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

/// Largest |f + 3 mu flow − q|/q and |von Mises − σ_y|/σ_y of the mapped points, in long double.
void print_residuals(const Case& one, Points& points, const parallel::Arena& arena, const simd::KernelTable& kernels,
                     const YieldCurve& law) {
  MappedState result = points.result();
  result.von_mises = points.von_mises();
  map_to_yield(arena, kernels, law, kShearModulus, points.state(), result);
  long double worst_yield = 0, worst_balance = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const long double p = result.plastic_strain[i], before = points.state().plastic_strain[i];
    if (!(p > before)) continue;
    const long double yield =
        kSteel.B * std::pow(kSteel.C + kSteel.strain_scale * p, static_cast<long double>(kSteel.n));
    long double square = 0;
    for (std::size_t c = 0; c < 6; ++c) {
      const double* trial = points.state().trial[c];
      const long double component = c < 3 ? trial[i] - (static_cast<long double>(points.state().trial[0][i]) +
                                                        points.state().trial[1][i] + points.state().trial[2][i]) /
                                                           3
                                          : trial[i];
      const long double after = component - 2 * kShearModulus * static_cast<long double>(result.increment[c][i]);
      square += (c < 3 ? 1.5L : 3.0L) * after * after;
    }
    worst_yield = std::max(worst_yield, std::abs(result.von_mises[i] - yield) / yield);
    worst_balance = std::max(worst_balance, std::abs(std::sqrt(square) - yield) / yield);
  }
  std::printf("| %-22s | %-8s | von Mises to yield stress %.1e, of trial less 2 mu increment %.1e |\n", one.name,
              std::string(simd::name(kernels.isa)).c_str(), static_cast<double>(worst_yield),
              static_cast<double>(worst_balance));
}

void compare(const Case& one, int rounds) {
  struct Candidate {
    std::string name;
    std::function<void()> run;
    std::vector<double> times{};
  };
  const parallel::Arena arena(1);
  const YieldCurve law({kSteel, {}});
  Points points(one.load);
  const TrialState state = points.state();
  const MappedState result = points.result(), again = points.result_again();
  std::vector<Candidate> candidates{{"textbook", [&] {
                                       bench::textbook_return(kSteel, kShearModulus, kPoints, state.trial,
                                                              state.plastic_strain, result.increment,
                                                              result.plastic_strain);
                                     }}};
  for (const simd::Isa isa : simd::supported()) {
    candidates.push_back({std::string(simd::name(isa)),
                          [&, isa] { map_to_yield(arena, simd::kernels(isa), law, kShearModulus, state, result); }});
    candidates.push_back({std::string(simd::name(isa)) + ", again",
                          [&, isa] { map_to_yield(arena, simd::kernels(isa), law, kShearModulus, state, again); }});
  }
  constexpr int kTurns = 8;
  for (int round = -1; round < rounds; ++round) {  // the first warms up
    for (Candidate& candidate : candidates) {
      candidate.run();
      const double start = cpu_seconds();
      for (int turn = 0; turn < kTurns; ++turn) candidate.run();
      if (round >= 0) candidate.times.push_back((cpu_seconds() - start) / kTurns);
    }
  }
  for (const Candidate& candidate : candidates) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < candidate.times.size(); ++i) {
      ratios.push_back(candidates[0].times[i] / candidate.times[i]);
    }
    std::printf("| %-22s | %-15s | %8.1f million points/s | %5.2f (%.2f to %.2f) |\n", one.name,
                candidate.name.c_str(), 1e-6 * static_cast<double>(kPoints) / quantile(candidate.times, 0.5),
                quantile(ratios, 0.5), quantile(ratios, 0.25), quantile(ratios, 0.75));
  }
  for (const simd::Isa isa : simd::supported()) print_residuals(one, points, arena, simd::kernels(isa), law);
}

}  // namespace
}  // namespace brinell

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--compare") {
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 41;
    for (const brinell::Case& one : brinell::kCases) brinell::compare(one, rounds > 0 ? rounds : 1);
    return 0;
  }
  brinell::add_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
