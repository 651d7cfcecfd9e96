// Residual stress of plastic strain in a box, six components, ours and the textbook's (3-D FFTW with full complex
// spectra); the residual displacement of the surface; and the time to generate the spectra. Goals, 64 x 64 x 32: one
// thread 4 times (aim 6.5) as fast as the textbook, spectra of at most 110 MB generated in less than 2 s by two
// threads. With --compare [ROUNDS]: all candidates take turns in one process, round after round, process CPU time,
// medians over the rounds and of the ratios within a round; otherwise Google Benchmark.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fft/plan_cache.h"
#include "kernels/textbook_eigenstrain.h"
#include "measure/clock.h"
#include "measure/statistics.h"
#include "parallel/arena.h"
#include "plastic/eigenstrain_displacement.h"
#include "simd/kernel_table.h"

namespace brinell {
namespace {

using plastic::Box;

constexpr double kShearModulus = 80e9, kPoissonsRatio = 0.3;

std::string name_of(const Box& box) {
  return std::to_string(box.nx) + "x" + std::to_string(box.ny) + "x" + std::to_string(box.nz);
}

struct Engine {
  Engine(simd::Isa isa, int threads) : arena(threads), backend{arena, simd::kernels(isa), plans} {}
  parallel::Arena arena;
  fft::PlanCache plans;
  fft::Backend backend;
};

struct Fields {
  explicit Fields(const Box& box) : memory(6 * box.cuboids()) {
    for (std::size_t c = 0; c < 6; ++c) component[c] = memory.data() + c * box.cuboids();
  }
  plastic::TensorView constant() const {
    plastic::TensorView tensor{};
    std::copy(component.begin(), component.end(), tensor.begin());
    return tensor;
  }
  std::vector<double> memory;
  plastic::TensorArrays component{};
};

Fields random_strain(const Box& box) {
  Fields strain(box);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1e-2, 1e-2);
  for (double& value : strain.memory) value = uniform(random);
  for (std::size_t n = 0; n < box.cuboids(); ++n) {
    strain.component[2][n] = -strain.component[0][n] - strain.component[1][n];
  }
  return strain;
}

void bm_stress(benchmark::State& state, Box box, simd::Isa isa, int threads) {
  const Engine engine(isa, threads);
  plastic::EigenstrainResponse response(engine.backend, box, kShearModulus, kPoissonsRatio);
  const Fields strain = random_strain(box);
  const Fields stress(box);
  for (auto _ : state) response.stress(strain.constant(), stress.component);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(box.cuboids()));
}

void bm_generate(benchmark::State& state, Box box, simd::Isa isa, int threads) {
  const Engine engine(isa, threads);
  for (auto _ : state) {
    const plastic::EigenstrainResponse response(engine.backend, box, kShearModulus, kPoissonsRatio);
    benchmark::DoNotOptimize(&response);
  }
}

void bm_displacement(benchmark::State& state, Box box, simd::Isa isa, int threads) {
  const Engine engine(isa, threads);
  const Grid grid{2 * box.nx, 2 * box.ny, box.dx, box.dy};
  plastic::EigenstrainDisplacement response(engine.backend, grid, box.nz, box.dz, kPoissonsRatio);
  const Fields strain = random_strain(box);
  std::vector<double> displacement(grid.nodes());
  for (auto _ : state) response.displacement(strain.constant(), box, box.nx / 2, box.ny / 2, displacement.data());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(box.cuboids()));
}

void bm_textbook(benchmark::State& state, Box box, int parts) {
  bench::TextbookEigenstrain textbook(box, kShearModulus, kPoissonsRatio, parts);
  const Fields strain = random_strain(box);
  const Fields stress(box);
  for (auto _ : state) textbook.stress(strain.constant(), stress.component);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(box.cuboids()));
}

void add_all() {
  for (const Box& box : {Box{32, 32, 32, 1e-6, 1e-6, 1e-6}, Box{64, 64, 32, 1e-6, 1e-6, 1e-6}}) {
    const auto add = [&](const std::string& name, auto... arguments) {
      benchmark::RegisterBenchmark((name + "/" + name_of(box)).c_str(), arguments...)
          ->Unit(benchmark::kMillisecond)
          ->MeasureProcessCPUTime()
          ->UseRealTime();
    };
    add("bm_textbook_eigenstrain", bm_textbook, box, 4);
    add("bm_textbook_eigenstrain_one_image_part", bm_textbook, box, 2);
    for (const simd::Isa isa : simd::supported()) {
      for (const int threads : {1, 2}) {
        const std::string end = "/" + std::string(simd::name(isa)) + "/threads:" + std::to_string(threads);
        add("bm_residual_stress" + end, bm_stress, box, isa, threads);
        add("bm_residual_displacement" + end, bm_displacement, box, isa, threads);
        add("bm_residual_spectra" + end, bm_generate, box, isa, threads);
      }
    }
  }
}

void compare(const Box& box, int rounds) {
  struct Candidate {
    std::string name;
    std::function<void()> run;
    std::vector<double> times{};
  };
  const Fields strain = random_strain(box);
  const Fields expected(box), found(box);
  bench::TextbookEigenstrain whole(box, kShearModulus, kPoissonsRatio, 4);
  bench::TextbookEigenstrain least(box, kShearModulus, kPoissonsRatio, 2);
  const auto isas = simd::supported();
  const Engine best(isas.back(), 1), narrow(isas[std::min<std::size_t>(1, isas.size() - 1)], 1), two(isas.back(), 2);
  plastic::EigenstrainResponse ours(best.backend, box, kShearModulus, kPoissonsRatio);
  plastic::EigenstrainResponse avx2(narrow.backend, box, kShearModulus, kPoissonsRatio);
  std::vector<Candidate> candidates{
      {"textbook", [&] { whole.stress(strain.constant(), expected.component); }},
      {"textbook, one image part", [&] { least.stress(strain.constant(), found.component); }},
      {"ours, " + std::string(simd::name(narrow.backend.kernels.isa)),
       [&] { avx2.stress(strain.constant(), found.component); }},
      {"ours, " + std::string(simd::name(best.backend.kernels.isa)),
       [&] { ours.stress(strain.constant(), found.component); }},
  };
  for (int round = -1; round < rounds; ++round) {  // the first warms up
    for (Candidate& candidate : candidates) {
      const double start = bench::seconds(bench::Clock::cpu);
      candidate.run();
      if (round >= 0) candidate.times.push_back(bench::seconds(bench::Clock::cpu) - start);
    }
  }
  double largest = 0, error = 0;
  for (std::size_t n = 0; n < expected.memory.size(); ++n) {
    largest = std::max(largest, std::abs(expected.memory[n]));
    error = std::max(error, std::abs(expected.memory[n] - found.memory[n]));
  }
  for (const Candidate& candidate : candidates) {
    std::vector<double> to_whole, to_least;
    for (std::size_t round = 0; round < candidate.times.size(); ++round) {
      to_whole.push_back(candidates[0].times[round] / candidate.times[round]);
      to_least.push_back(candidates[1].times[round] / candidate.times[round]);
    }
    std::printf("| %-10s | %-26s | %8.1f | %6.2f | %6.2f |\n", name_of(box).c_str(), candidate.name.c_str(),
                1e3 * bench::median(candidate.times), bench::median(to_whole), bench::median(to_least));
  }
  for (const Engine* engine : {&best, &two}) {
    std::vector<double> times;
    for (int turn = 0; turn < 3; ++turn) {
      const double start = bench::seconds(bench::Clock::wall);
      const plastic::EigenstrainResponse again(engine->backend, box, kShearModulus, kPoissonsRatio);
      times.push_back(bench::seconds(bench::Clock::wall) - start);
    }
    std::printf("  spectra generated by %d thread(s) in %.2f s\n", engine->arena.threads(), bench::median(times));
  }
  const auto bytes = plastic::EigenstrainResponse::bytes(best.backend, box);
  std::printf(
      "  largest difference from the textbook, of the largest stress: %.1e; bytes: spectra %.1f MB, textbook's "
      "%.1f MB, work %.1f MB\n",
      error / largest, 1e-6 * static_cast<double>(bytes.spectra), 1e-6 * static_cast<double>(whole.spectra_bytes()),
      1e-6 * static_cast<double>(bytes.work));
  std::fflush(stdout);
}

}  // namespace
}  // namespace brinell

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--compare") {
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 7;
    std::printf(
        "| box        | candidate                  |   CPU ms | times as fast as the textbook | as one image part "
        "|\n");
    for (const std::int64_t nodes : {32, 64}) brinell::compare({nodes, nodes, 32, 1e-6, 1e-6, 1e-6}, rounds);
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  brinell::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
