// Influence coefficients, many offsets at a time.
#pragma once

namespace brinell::simd {

struct InfluenceKernels {};

}  // namespace brinell::simd
