// What brn_benchmark_run can carry out: kernels of the engine, and calibrations to see them against.
#pragma once

#include <cstdint>
#include <span>

#include "scene/engine.h"

namespace brinell::capi {

struct Benchmark {
  const char* name;
  std::int32_t calibration;  // index
  double (*seconds)(scene::Engine& engine);
};

/// Calibrations first.
std::span<const Benchmark> benchmarks();

}  // namespace brinell::capi
