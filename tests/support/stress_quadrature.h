// Stress below a uniformly loaded rectangle by brute force: the point forces of Boussinesq and Cerruti (K. L.
// Johnson, Contact Mechanics, 1985, eqs. 3.19 and 3.76) integrated in long double over panels that are halved until
// each is small against its distance from the field point. Slow, and the authority: it shares nothing with the
// engine.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/legendre_rule.h"

namespace brinell::reference {

using Long = long double;
using Six = std::array<Long, 6>;  // xx yy zz yz xz xy

/// 2π times the stress of a unit normal force pressing along +z at the origin.
inline Six normal_force(Long x, Long y, Long z, Long nu) {
  const Long rho = std::hypot(x, y, z), s = rho + z, m = 1 - 2 * nu;
  const Long r3 = rho * rho * rho, r5 = r3 * rho * rho;
  // Second derivatives of ln(z + ρ): eq. 3.19 without its division by x² + y².
  const auto log_second = [&](Long a, Long b, Long delta) {
    return delta / (rho * s) - a * b / (r3 * s) - a * b / (rho * rho * s * s);
  };
  return {-2 * nu * z / r3 - z * (3 * x * x / r5 - 1 / r3) - m * log_second(x, x, 1),
          -2 * nu * z / r3 - z * (3 * y * y / r5 - 1 / r3) - m * log_second(y, y, 1),
          -3 * z * z * z / r5,
          -3 * y * z * z / r5,
          -3 * x * z * z / r5,
          -3 * x * y * z / r5 - m * log_second(x, y, 0)};
}

/// The same for a unit tangential force along +x.
inline Six tangential_force(Long x, Long y, Long z, Long nu) {
  const Long rho = std::hypot(x, y, z), s = rho + z, m = 1 - 2 * nu;
  const Long r2 = rho * rho, r3 = r2 * rho, r5 = r3 * r2;
  return {
      -3 * x * x * x / r5 +
          m * (x / r3 - 3 * x / (rho * s * s) + x * x * x / (r3 * s * s) + 2 * x * x * x / (r2 * s * s * s)),
      -3 * x * y * y / r5 +
          m * (x / r3 - x / (rho * s * s) + x * y * y / (r3 * s * s) + 2 * x * y * y / (r2 * s * s * s)),
      -3 * x * z * z / r5,
      -3 * x * y * z / r5,
      -3 * x * x * z / r5,
      -3 * x * x * y / r5 + m * (-y / (rho * s * s) + x * x * y / (r3 * s * s) + 2 * x * x * y / (r2 * s * s * s))};
}

class StressQuadrature {
 public:
  /// Stress at (x, y, z), z > 0, under a unit traction on |ξ| <= a, |η| <= b: 0 pressure, 1 along x, 2 along y.
  Six operator()(int traction, Long x, Long y, Long z, Long a, Long b, Long nu) const {
    Six sum{};
    if (traction == 2) {
      const Six turned = (*this)(1, y, x, z, b, a, nu);
      return {turned[1], turned[0], turned[2], turned[4], turned[3], turned[5]};
    }
    add_panel(traction, x, y, z, -a, a, -b, b, nu, sum);
    for (Long& component : sum) component /= 2 * std::numbers::pi_v<Long>;
    return sum;
  }

 private:
  static constexpr int kNodes = 14;

  void add_panel(int traction, Long x, Long y, Long z, Long left, Long right, Long low, Long high, Long nu,
                 Six& sum) const {
    const Long width = right - left, height = high - low;
    const Long away_x = std::max({left - x, x - right, 0.0L}), away_y = std::max({low - y, y - high, 0.0L});
    if (std::max(width, height) > 0.7L * std::hypot(away_x, away_y, z)) {
      if (width >= height) {
        const Long middle = (left + right) / 2;
        add_panel(traction, x, y, z, left, middle, low, high, nu, sum);
        add_panel(traction, x, y, z, middle, right, low, high, nu, sum);
      } else {
        const Long middle = (low + high) / 2;
        add_panel(traction, x, y, z, left, right, low, middle, nu, sum);
        add_panel(traction, x, y, z, left, right, middle, high, nu, sum);
      }
      return;
    }
    for (int k = 0; k < kNodes; ++k) {
      for (int l = 0; l < kNodes; ++l) {
        const Long to_x = x - (left + right + width * rule_.node[k]) / 2,
                   to_y = y - (low + high + height * rule_.node[l]) / 2;
        const Six point = traction == 0 ? normal_force(to_x, to_y, z, nu) : tangential_force(to_x, to_y, z, nu);
        for (int c = 0; c < 6; ++c) sum[c] += rule_.weight[k] * rule_.weight[l] * width * height / 4 * point[c];
      }
    }
  }

  LegendreRule<kNodes> rule_;
};

}  // namespace brinell::reference
