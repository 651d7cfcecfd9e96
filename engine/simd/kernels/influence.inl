#pragma once

#include "simd/influence_kernels.h"

namespace brinell::simd {
namespace {

template <class Arch>
constexpr InfluenceKernels influence_kernels() {
  return {};
}

}  // namespace
}  // namespace brinell::simd
