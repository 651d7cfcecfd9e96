// Complete elliptic integrals by the arithmetic-geometric mean (Abramowitz, Stegun 1964, 17.6), modulus k:
//   K = ∫ dθ/√(1 − k² sin²θ),   E = ∫ √(1 − k² sin²θ) dθ,   0 <= θ <= π/2.
#pragma once

#include <cmath>
#include <numbers>

namespace brinell::support {

struct EllipticIntegrals {
  long double first = 0;   // K
  long double second = 0;  // E
};

inline EllipticIntegrals elliptic_integrals(long double k) {
  long double a = 1, b = std::sqrt((1 - k) * (1 + k)), c = k, weight = 0.5L, sum = weight * c * c;
  for (int step = 0; step < 12; ++step) {  // quadratic: the 64 bits are there after seven
    const long double mean = (a + b) / 2;
    c = (a - b) / 2;
    b = std::sqrt(a * b);
    a = mean;
    weight *= 2;
    sum += weight * c * c;
  }
  const long double first = std::numbers::pi_v<long double> / (2 * a);
  return {first, first * (1 - sum)};
}

}  // namespace brinell::support
