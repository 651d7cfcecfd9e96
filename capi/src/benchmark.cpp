#include <brinell.h>

#include <string>

#include "benchmark_kernels.h"
#include "handles.h"

using namespace brinell;
using namespace brinell::capi;

namespace {

const Benchmark* find(int32_t index) {
  const auto all = benchmarks();
  return index >= 0 && static_cast<std::size_t>(index) < all.size() ? &all[static_cast<std::size_t>(index)] : nullptr;
}

}  // namespace

extern "C" {

int32_t brn_benchmark_count(void) {
  return static_cast<int32_t>(benchmarks().size());
}

const char* brn_benchmark_name(int32_t index) {
  const Benchmark* benchmark = find(index);
  return benchmark != nullptr ? benchmark->name : nullptr;
}

int32_t brn_benchmark_calibration(int32_t index) {
  const Benchmark* benchmark = find(index);
  return benchmark != nullptr ? benchmark->calibration : -1;
}

brn_status brn_benchmark_run(brn_engine* engine, int32_t index, double* seconds) {
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(engine, "engine");
    require(seconds, "seconds");
    const Benchmark* benchmark = find(index);
    if (benchmark == nullptr) {
      fail(Status::invalid_argument, "index = " + std::to_string(index) + ": there are benchmarks 0 to " +
                                         std::to_string(brn_benchmark_count() - 1));
    }
    *seconds = benchmark->seconds(engine->engine);
  });
}
}
