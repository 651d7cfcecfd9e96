// What the kernels of influence coefficients share: the walk over a row of offsets, and 1/√.
#pragma once

#include <cstring>

#include "simd/influence_kernels.h"

namespace brinell::simd {
namespace {

/// Calls body(x) for every register of offsets of the span, and store(values, where, count) with what it returns.
/// The last, partial register is computed whole, so that a coefficient does not depend on its place in a register.
template <class Arch, class Body, class Store>
void for_offsets(const RowSpan& span, Body body, Store store) {
  using Batch = xsimd::batch<double, Arch>;
  constexpr std::int64_t kLanes = Batch::size;
  alignas(64) double lanes[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) lanes[lane] = static_cast<double>(span.first) + lane;
  Batch index = xsimd::load_aligned<Arch>(lanes);
  const Batch dx(span.dx), step(static_cast<double>(kLanes));
  const std::int64_t count = span.count;
  for (std::int64_t done = 0; done < count; done += kLanes, index += step) {
    store(body(index * dx), done, count - done < kLanes ? count - done : kLanes);
  }
}

/// The first `count` lanes to memory.
template <class Batch>
void store_lanes(Batch values, double* memory, std::int64_t count) {
  constexpr std::int64_t kLanes = Batch::size;
  if (count == kLanes) {
    values.store_unaligned(memory);
    return;
  }
  alignas(64) double lanes[kLanes];
  values.store_aligned(lanes);
  std::memcpy(memory, lanes, static_cast<std::size_t>(count) * sizeof(double));
}

template <class Arch, class Body>
void fill_row(const RowSpan& span, double* row, Body body) {
  for_offsets<Arch>(span, body, [row](xsimd::batch<double, Arch> values, std::int64_t done, std::int64_t count) {
    store_lanes(values, row + done, count);
  });
}

/// 1/√square. AVX-512's estimate of 14 bits and one step of fourth order, ε = 1 − square·h²,
/// h (1 + ε/2 + 3ε²/8 + 5ε³/16), take a third of the time of a division and a square root.
template <class Arch>
xsimd::batch<double, Arch> inverse_root(xsimd::batch<double, Arch> square) {
  using Batch = xsimd::batch<double, Arch>;
#if XSIMD_WITH_AVX512F
  const Batch estimate = _mm512_rsqrt14_pd(square);
  const Batch error = Batch(1.0) - square * estimate * estimate;
  const Batch correction = error * (Batch(0.5) + error * (Batch(0.375) + error * Batch(0.3125)));
  return estimate + estimate * correction;
#else
  return Batch(1.0) / xsimd::sqrt(square);
#endif
}

}  // namespace
}  // namespace brinell::simd
