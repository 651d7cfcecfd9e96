// bm_stream_triad/<MB of each array>/<threads>: the bandwidth that the other figures are to be seen against; arrays
// that fit the caches and arrays that do not.
#include <benchmark/benchmark.h>

#include <string>
#include <thread>

#include "measure/stream_triad.h"

namespace {

void bm_stream_triad(benchmark::State& state, std::size_t megabytes, int threads) {
  const brinell::parallel::Arena arena(threads);
  brinell::bench::StreamTriad triad((megabytes << 20) / sizeof(double));
  triad.run(arena);
  for (auto _ : state) {
    triad.run(arena);
    benchmark::DoNotOptimize(triad.result());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(triad.bytes()) * state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
  const int most = static_cast<int>(std::thread::hardware_concurrency());
  for (const std::size_t megabytes : {1, 4, 64}) {
    for (int threads = 1; threads <= most; threads *= 2) {
      const std::string name = "bm_stream_triad/" + std::to_string(megabytes) + "/" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(),
                                   [=](benchmark::State& state) { bm_stream_triad(state, megabytes, threads); })
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
