#pragma once

#include "simd/transform_kernels.h"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
constexpr TransformKernels<Real> transform_kernels() {
  return {};
}

}  // namespace
}  // namespace brinell::simd
