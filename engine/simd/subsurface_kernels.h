// Invariants of many stress tensors at a time; conventions and formulas stand in engine/subsurface/invariants.h.
#pragma once

#include <cstddef>

namespace brinell::simd {

/// Stress at n points: one array of n values for each of xx yy zz yz xz xy.
struct StressArrays {
  const double* component[6] = {};
};

/// Principal values in falling order and their directions: direction[3·k + axis] belongs to value[k].
/// Null: not wanted; the directions are wanted all or none.
struct PrincipalArrays {
  double* value[3] = {};
  double* direction[9] = {};
};

struct SubsurfaceKernels {
  void (*von_mises)(std::size_t n, const StressArrays& stress, double* result);

  /// A third of the trace; reads xx, yy and zz alone.
  void (*hydrostatic)(std::size_t n, const StressArrays& stress, double* result);

  /// Largest less smallest principal value.
  void (*tresca)(std::size_t n, const StressArrays& stress, double* result);

  void (*principal)(std::size_t n, const StressArrays& stress, const PrincipalArrays& result);

  /// The largest of n >= 1 values, NaN left out (−infinity if nothing else is there).
  double (*largest)(std::size_t n, const double* values);
};

}  // namespace brinell::simd
