// Fused vector passes of the contact solver.
#pragma once

namespace brinell::simd {

template <class Real>
struct ContactKernels {};

}  // namespace brinell::simd
