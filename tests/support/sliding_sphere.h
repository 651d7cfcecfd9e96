// Stress below a sphere that slides, pressed on by p0 √(1 − r²/a²) and dragged along x by μ times that: the exact
// field whose closed form G. M. Hamilton gave (Explicit equations for the stresses beneath a sliding spherical
// contact, 1983).
//
// The potential of the Hertzian pressure is that of point forces on a line in imaginary depth,
//
//   ∬ p/ρ dA = (π p0 / 2a) ∫_{−a}^{a} (a² − s²)/R ds,    R² = x² + y² + (z + is)²,
//
// because √(a² − r²) = ∫_r^a t dt/√(t² − r²), and the disc 1/√(t² − r²) has the potential π ∫_{−t}^{t} ds/R. Stresses
// are derivatives of it and of its integrals over z, times powers of the real depth z (K. L. Johnson, Contact
// Mechanics, 1985, eqs. 3.2 to 3.10):  with V = 1/R, Λ = ln(R + ζ), χ = ζΛ − R, ζ = z + is,
//
//   pressure 2πσ: xx 2νV_z − zV_xx − (1−2ν)Λ_xx      zz V_z − zV_zz     xz −zV_xz      xy −zV_xy − (1−2ν)Λ_xy
//   shear x  2πσ: xx 2(1+ν)V_x + 2νχ_xxx − zΛ_xxx    zz −zV_xz          xz V_z − zV_xx xy V_y + 2νχ_xxy − zΛ_xxy
//                 yy 2νV_x + 2νχ_xyy − zΛ_xyy                           yz −zV_xy
//
// Elementary integrals; here summed by Gauss-Legendre rules on short pieces, exact to round-off for z >= 0.05 a.
#pragma once

#include <array>
#include <complex>
#include <numbers>

namespace brinell::reference {

struct SlidingSphere {
  double a = 1, p0 = 1, friction = 0, nu = 0.3;

  /// xx yy zz yz xz xy at depth z > 0.
  std::array<double, 6> operator()(double x, double y, double z) const {
    // Ten Gauss nodes on [0, 1], those of [−1, 1] folded.
    constexpr double node[5] = {0.14887433898163121, 0.43339539412924719, 0.67940956829902441, 0.86506336668898451,
                                0.97390652851717172};
    constexpr double weight[5] = {0.29552422471475287, 0.26926671930999635, 0.21908636251598204, 0.14945134915058059,
                                  0.06667134430868814};
    constexpr int pieces = 80;
    std::array<double, 6> sum{};
    for (int piece = 0; piece < pieces; ++piece) {
      for (int k = 0; k < 5; ++k) {
        for (const double side : {-1.0, 1.0}) {
          // The integrand's real part is even in s.
          const double s = a * (piece + 0.5 + 0.5 * side * node[k]) / pieces;
          const double share = std::numbers::pi * p0 / (2 * a) * 2 * (a * a - s * s) * (0.5 * weight[k] * a / pieces);
          const std::array<double, 6> part = point(x, y, z, s);
          for (std::size_t c = 0; c < 6; ++c) sum[c] += share * part[c] / (2 * std::numbers::pi);
        }
      }
    }
    return sum;
  }

  /// 2π times the real part of the stress of one point force at imaginary depth, s = 0: an ordinary one.
  std::array<double, 6> point(double x, double y, double z, double s) const {
    using Complex = std::complex<double>;
    const Complex zeta(z, s), r = std::sqrt(x * x + y * y + zeta * zeta), q = r + zeta;
    const Complex r2 = r * r, r3 = r2 * r, r4 = r2 * r2, r5 = r4 * r;
    const Complex vx = -x / r3, vy = -y / r3, vz = -zeta / r3;
    const Complex vxx = 3 * x * x / r5 - 1.0 / r3, vyy = 3 * y * y / r5 - 1.0 / r3, vxy = 3 * x * y / r5;
    const Complex vxz = 3.0 * x * zeta / r5, vyz = 3.0 * y * zeta / r5, vzz = 3.0 * zeta * zeta / r5 - 1.0 / r3;
    const Complex l0 = 1.0 / (r * q), l1 = 1.0 / (r3 * q) + 1.0 / (r2 * q * q);
    const Complex l2 = 3.0 / (r5 * q) + 3.0 / (r4 * q * q) + 2.0 / (r3 * q * q * q);
    const Complex c1 = 1.0 / (r * q * q), c2 = 1.0 / (r3 * q * q) + 2.0 / (r2 * q * q * q);
    const double m = 1 - 2 * nu, f = friction;
    const std::array<Complex, 6> all{
        2 * nu * vz - z * vxx - m * (l0 - x * x * l1) +
            f * (2 * (1 + nu) * vx + 2 * nu * (3 * x * c1 - x * x * x * c2) - z * (x * x * x * l2 - 3 * x * l1)),
        2 * nu * vz - z * vyy - m * (l0 - y * y * l1) +
            f * (2 * nu * vx + 2 * nu * (x * c1 - x * y * y * c2) - z * (x * y * y * l2 - x * l1)),
        vz - z * vzz - f * z * vxz,
        -z * vyz - f * z * vxy,
        -z * vxz + f * (vz - z * vxx),
        -z * vxy + m * x * y * l1 + f * (vy + 2 * nu * (y * c1 - x * x * y * c2) - z * (x * x * y * l2 - y * l1))};
    std::array<double, 6> real{};
    for (std::size_t c = 0; c < 6; ++c) real[c] = all[c].real();
    return real;
  }
};

}  // namespace brinell::reference
