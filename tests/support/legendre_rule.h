// Gauss-Legendre quadrature in long double, apart from the engine's own: Newton's method on the recurrence of the
// Legendre polynomial.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace brinell::reference {

template <int kNodes>
struct LegendreRule {
  std::array<long double, kNodes> node{}, weight{};  // on [-1, 1]

  LegendreRule() {
    for (int k = 0; k < kNodes; ++k) {
      long double t = -std::cos(std::numbers::pi_v<long double> * (k + 0.75L) / (kNodes + 0.5L)), slope = 0;
      for (int step = 0; step < 10; ++step) {
        long double previous = 1, value = t;
        for (int n = 2; n <= kNodes; ++n) {
          const long double next = ((2 * n - 1) * t * value - (n - 1) * previous) / n;
          previous = value;
          value = next;
        }
        slope = kNodes * (t * value - previous) / (t * t - 1);
        t -= value / slope;
      }
      node[static_cast<std::size_t>(k)] = t;
      weight[static_cast<std::size_t>(k)] = 2 / ((1 - t * t) * slope * slope);
    }
  }
};

}  // namespace brinell::reference
