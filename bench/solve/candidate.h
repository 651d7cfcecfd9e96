// One contact solved by one method, ready to be repeated and timed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "measure/clock.h"
#include "simd/isa.h"
#include "solve/scenes.h"

namespace brinell::bench {

enum class SolveMethod { textbook, in_double, mixed };

const char* name(SolveMethod method);

struct SolveCase {
  const SolveScene* scene;
  std::int64_t nodes;  // n of n × n
  SolveMethod method;
  simd::Isa isa;  // the textbook ignores this and the next
  int threads;
  double tolerance;
};

/// The undeformed gap [m] and the target of a scene on n × n nodes, in memory shared with workers.
struct SolveInput {
  const double* gap;
  double target;  // Σ p [E*], or the approach [m]
};

/// Made in a process of its own; each input replaces the last.
class SolveInputs {
 public:
  explicit SolveInputs(std::int64_t largest_nodes);
  SolveInput make(const SolveScene& scene, std::int64_t nodes);

 private:
  double* memory_;  // the target, then the gap
};

struct SolveSample {
  double seconds;
  double certificate;
  double approach;          // [m]
  double contact_fraction;  // of the nodes
  std::int32_t iterations;
  std::int32_t convolutions;
  std::int32_t converged;
};

/// Sets up what stays warm from solve to solve: threads, plans of transforms, and the spectra, which the first solve
/// fills. A turn makes a solver and solves; the textbook's solver is made here, with plans by measure, and its turns
/// only solve.
std::function<SolveSample()> prepare(const SolveCase& which, const SolveInput& input, Clock clock);

}  // namespace brinell::bench
