// Clocks of the benchmarks. With one thread, process CPU time is what a shared machine disturbs least; with more,
// only wall time tells how long a user waits.
#pragma once

#include <ctime>

namespace brinell::bench {

enum class Clock { cpu, wall };

inline double seconds(Clock clock) {
  std::timespec now{};
  clock_gettime(clock == Clock::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace brinell::bench
