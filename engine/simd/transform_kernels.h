// Passes of the convolution.
#pragma once

namespace brinell::simd {

template <class Real>
struct TransformKernels {};

}  // namespace brinell::simd
