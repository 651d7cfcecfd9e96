#pragma once

#include "simd/kernels/transform_rows.inl"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
constexpr TransformKernels<Real> transform_kernels() {
  return {kLanes<Arch, Real>, rows_forward<Arch, Real>, rows_backward<Arch, Real>, free_block<Arch, Real>,
          periodic_block<Arch, Real>};
}

}  // namespace
}  // namespace brinell::simd
