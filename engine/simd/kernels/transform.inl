#pragma once

#include "simd/kernels/transform_rows.inl"
#include "simd/kernels/transform_sums.inl"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
constexpr TransformKernels<Real> transform_kernels() {
  return {kLanes<Arch, Real>,      rows_forward<Arch, Real>,   rows_backward<Arch, Real>,
          free_block<Arch, Real>,  periodic_block<Arch, Real>, free_forward<Arch, Real>,
          free_sum<Arch, Real>,    free_spectrum<Arch, Real>,  periodic_forward<Arch, Real>,
          periodic_sum<Arch, Real>};
}

}  // namespace
}  // namespace brinell::simd
