// The radial return as textbooks write it: point by point, Newton's method for the plastic strain increment, the
// power law by std::pow (M. A. Crisfield, Non-linear finite element analysis, volume 1, 1991, section 6.6.6).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "plastic/hardening.h"

namespace brinell::bench {

inline double swift_stress(const plastic::Swift& law, double p) {
  return law.B * std::pow(law.C + law.strain_scale * p, law.n);
}

inline double swift_slope(const plastic::Swift& law, double p) {
  return law.n * law.B * law.strain_scale * std::pow(law.C + law.strain_scale * p, law.n - 1);
}

inline void textbook_return(const plastic::Swift& law, double shear_modulus, std::size_t count,
                            const std::array<const double*, 6>& trial, const double* before,
                            const std::array<double*, 6>& increment, double* after) {
  for (std::size_t i = 0; i < count; ++i) {
    const double mean = (trial[0][i] + trial[1][i] + trial[2][i]) / 3;
    const double xx = trial[0][i] - mean, yy = trial[1][i] - mean, zz = trial[2][i] - mean;
    const double yz = trial[3][i], xz = trial[4][i], xy = trial[5][i];
    const double q = std::sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2 * (yz * yz + xz * xz + xy * xy)));
    double flow = 0;
    if (q > swift_stress(law, before[i])) {
      for (int k = 0; k < 50; ++k) {
        const double excess = swift_stress(law, before[i] + flow) + 3 * shear_modulus * flow - q;
        if (std::abs(excess) <= 1e-13 * q) break;
        flow -= excess / (3 * shear_modulus + swift_slope(law, before[i] + flow));
      }
    }
    const double share = q > 0 ? 1.5 * flow / q : 0.0;
    const double deviator[6] = {xx, yy, zz, yz, xz, xy};
    for (std::size_t c = 0; c < 6; ++c) increment[c][i] = share * deviator[c];
    after[i] = before[i] + flow;
  }
}

}  // namespace brinell::bench
