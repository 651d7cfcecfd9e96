// Gauss-Legendre rules ∫_{-1}^{1} f(t) dt ≈ Σ w_k f(t_k), exact for polynomials of degree 2n − 1. A function that
// is analytic inside the ellipse with foci ±1 and half-axes' sum ρ is integrated with an error of order ρ^(−2n).
#pragma once

#include "simd/influence_kernels.h"

namespace brinell::influence {

/// 1 <= nodes <= simd::kMaxGaussNodes; nodes ascending, rounded from long double.
const simd::GaussRule& gauss_legendre(int nodes);

}  // namespace brinell::influence
