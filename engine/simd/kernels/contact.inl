#pragma once

#include "simd/contact_kernels.h"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
constexpr ContactKernels<Real> contact_kernels() {
  return {};
}

}  // namespace
}  // namespace brinell::simd
