#include "simd/isa.h"

#include <array>
#include <cstddef>
#include <string>

#include "base/error.h"
#include "simd/kernel_table.h"

namespace brinell::simd {

namespace {

bool runs(Isa isa) {
#if defined(__x86_64__)
  // __builtin_cpu_supports also asks whether the operating system saves the wide registers.
  switch (isa) {
    case Isa::baseline: return true;
    case Isa::avx2: return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    case Isa::avx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0 && runs(Isa::avx2);
  }
  return false;
#else
  return isa == Isa::baseline;
#endif
}

struct Supported {
  std::array<Isa, 3> isa{};
  std::size_t count = 0;

  Supported() {
    for (const Isa candidate : {Isa::baseline, Isa::avx2, Isa::avx512}) {
      if (runs(candidate)) isa[count++] = candidate;
    }
  }
};

}  // namespace

std::string_view name(Isa isa) {
  switch (isa) {
    case Isa::baseline: return "baseline";
    case Isa::avx2: return "avx2";
    case Isa::avx512: return "avx512";
  }
  return "unknown";
}

std::span<const Isa> supported() {
  static const Supported found;
  return {found.isa.data(), found.count};
}

const KernelTable& kernels(Isa isa) {
  if (!runs(isa)) {
    std::string message =
        "instruction set '" + std::string(name(isa)) + "' is not supported by this machine; it has:";
    for (const Isa has : supported()) message += " " + std::string(name(has));
    fail(Status::unsupported, message);
  }
#if defined(__x86_64__)
  if (isa == Isa::avx512) return kernels_avx512();
  if (isa == Isa::avx2) return kernels_avx2();
#endif
  return kernels_baseline();
}

const KernelTable& best_kernels() {
  return kernels(supported().back());
}

}  // namespace brinell::simd
