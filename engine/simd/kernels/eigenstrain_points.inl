// Potentials of a cuboid from some way off: those of its points, summed by a Gauss rule. A derivative of a function
// of R with n_1, n_2, n_3 differentiations is
//
//   Σ over p_1, p_2, p_3 of c(n_1,p_1) c(n_2,p_2) c(n_3,p_3) x^(n_1−2p_1) y^(n_2−2p_2) z^(n_3−2p_3) (1/R d/dR)^(n−p)
//   f,
//
// p = p_1 + p_2 + p_3, c(n,p) = n!/(2^p p! (n−2p)!): a polynomial in the direction cosines times a power of R.
#pragma once

#include "simd/eigenstrain_kernels.h"
#include "simd/kernels/eigenstrain_tensors.inl"
#include "simd/kernels/influence_row.inl"
#include "simd/kernels/transform_dft.inl"

namespace brinell::simd {
namespace {

/// (1/R d/dR)^s of R and of 1/R, without their power of R.
inline constexpr double kOfRadius[6] = {1, 1, -1, 3, -15, 105};
inline constexpr double kOfInverse[5] = {1, -1, 3, -15, 105};

constexpr double pairings(int n, int p) {
  double ways = 1;
  for (int k = 0; k < 2 * p; ++k) ways *= n - k;
  for (int k = 1; k <= p; ++k) ways /= 2 * k;
  return ways;
}

template <class V>
struct Direction {
  V x[6], y[6], z[6];  // powers of the direction cosines
};

template <int n1, int n2, int n3, class V>
[[gnu::always_inline]] inline V polynomial(const Direction<V>& d, const double* f) {
  V sum(0.0);
  unrolled<n1 / 2 + 1>([&](auto p1) __attribute__((always_inline)) {
    unrolled<n2 / 2 + 1>([&](auto p2) __attribute__((always_inline)) {
      unrolled<n3 / 2 + 1>([&](auto p3) __attribute__((always_inline)) {
        constexpr int q1 = p1, q2 = p2, q3 = p3;
        constexpr double ways = pairings(n1, q1) * pairings(n2, q2) * pairings(n3, q3);
        const V factor(ways * f[n1 + n2 + n3 - q1 - q2 - q3]);
        sum = sum + factor * (d.x[n1 - 2 * q1] * d.y[n2 - 2 * q2] * d.z[n3 - 2 * q3]);
      });
    });
  });
  return sum;
}

/// body(number, n1, n2, n3) for the derivatives of fourth order in their order.
template <int count, class Body>
[[gnu::always_inline]] inline void fourth_derivatives(Body&& body) {
  unrolled<count>([&](auto number) __attribute__((always_inline)) {
    constexpr int k = number;
    constexpr int m = k < 1 ? 0 : k < 3 ? 1 : k < 6 ? 2 : k < 10 ? 3 : 4;
    constexpr int t = k - m * (m + 1) / 2;
    body(number, std::integral_constant<int, 4 - m>{}, std::integral_constant<int, m - t>{},
         std::integral_constant<int, t>{});
  });
}

template <class V>
struct Point {
  V x, y, z;  // from the source
  V inverse;  // 1/R
  V s;        // R + z
  Direction<V> d;

  [[gnu::always_inline]] inline Point(V x_, V y_, V z_, V inverse_) : x(x_), y(y_), z(z_), inverse(inverse_) {
    s = (x * x + y * y + z * z) * inverse + z;
    const auto powers = [](V(&power)[6], V cosine) __attribute__((always_inline)) {
      power[0] = V(1.0);
      for (int k = 1; k < 6; ++k) power[k] = power[k - 1] * cosine;
    };
    powers(d.x, x * inverse);
    powers(d.y, y * inverse);
    powers(d.z, z * inverse);
  }
};

template <class V>
[[gnu::always_inline]] inline void add_kelvin(const Point<V>& at, V weight, V (&sum)[kKelvinPotentials]) {
  const V scale = weight * at.inverse * at.inverse * at.inverse;
  fourth_derivatives<15>([&](auto k, auto n1, auto n2, auto n3) __attribute__((always_inline)) {
    sum[k] = sum[k] + scale * polynomial<n1, n2, n3>(at.d, kOfRadius);
  });
}

template <class V>
[[gnu::always_inline]] inline void add_image(const Point<V>& at, V weight, V (&sum)[kImagePotentials]) {
  const V r1 = at.inverse, r3 = weight * r1 * r1 * r1, r4 = r3 * r1, r5 = r4 * r1;
  fourth_derivatives<14>([&](auto k, auto n1, auto n2, auto n3) __attribute__((always_inline)) {
    sum[k] = sum[k] + r3 * polynomial<n1, n2, n3>(at.d, kOfRadius);
    sum[18 + k] = sum[18 + k] + r4 * polynomial<n1, n2, n3 + 1>(at.d, kOfRadius);
  });
  // Derivatives of chi = z ln(R + z) − R along x and y are Σ of 1/(R S²), T3 = its (1/R d/dR), T4 = the next.
  const V rs = V(1.0) / at.s, rho = at.z * at.z + at.x * at.x + at.y * at.y, r = rho * r1;
  const V t2 = r1 * rs * rs, t3 = -(V(3.0) * r + at.z) * r1 * r1 * r1 * rs * rs * rs;
  const V t4 = V(3.0) * (V(5.0) * rho + V(4.0) * r * at.z + at.z * at.z) * r1 * r1 * r1 * r1 * r1 * rs * rs * rs * rs;
  const V xx = at.x * at.x, yy = at.y * at.y, xy = at.x * at.y;
  sum[14] = sum[14] + weight * xy * (V(3.0) * t3 + xx * t4);
  sum[15] = sum[15] + weight * (t2 + (xx + yy) * t3 + xx * yy * t4);
  const V w = (r + r + at.z) * r1 * r1 * r1 * rs * rs;
  const V dw = -(V(8.0) * rho + V(9.0) * r * at.z + V(3.0) * at.z * at.z) * r1 * r1 * r1 * r1 * r1 * rs * rs * rs;
  sum[16] = sum[16] - weight * at.y * (w + xx * dw);
  sum[17] = sum[17] - weight * at.x * (w + yy * dw);
  sum[32] = sum[32] + r4 * polynomial<2, 1, 0>(at.d, kOfInverse);
  sum[33] = sum[33] + r4 * polynomial<1, 2, 0>(at.d, kOfInverse);
  unrolled<5>([&](auto k) __attribute__((always_inline)) {
    sum[34 + k] = sum[34 + k] + r5 * polynomial<4 - k, k, 0>(at.d, kOfInverse);
  });
  unrolled<4>([&](auto k) __attribute__((always_inline)) {
    sum[39 + k] = sum[39 + k] + r5 * polynomial<3 - k, k, 1>(at.d, kOfInverse);
  });
}

/// 2π times the surface's displacement into the body, of the six components.
template <class V>
[[gnu::always_inline]] inline void add_surface(const Point<V>& at, V weight, double nu,
                                               V (&sum)[kSurfacePotentials]) {
  const V r1 = at.inverse, r2 = weight * r1 * r1, rs = V(1.0) / at.s;
  const V r = (at.x * at.x + at.y * at.y + at.z * at.z) * r1;
  const V kappa(1 - 2 * nu), v = kappa * weight * r1 * rs,
                             w = kappa * weight * (r + r + at.z) * r1 * r1 * r1 * rs * rs;
  const V phi_3 = -r2 * at.d.z[1], all = V(2 * nu) * phi_3;
  sum[0] = sum[0] - r2 * polynomial<2, 0, 1>(at.d, kOfRadius) - (v - at.x * at.x * w) + all;
  sum[1] = sum[1] - r2 * polynomial<0, 2, 1>(at.d, kOfRadius) - (v - at.y * at.y * w) + all;
  sum[2] = sum[2] + V(3 - 2 * nu) * phi_3 - r2 * polynomial<0, 0, 3>(at.d, kOfRadius) + all;
  sum[3] = sum[3] + V(2.0) * r2 * (polynomial<0, 1, 2>(at.d, kOfRadius) + at.d.y[1]);
  sum[4] = sum[4] + V(2.0) * r2 * (polynomial<1, 0, 2>(at.d, kOfRadius) + at.d.x[1]);
  sum[5] = sum[5] - V(2.0) * (r2 * polynomial<1, 1, 1>(at.d, kOfRadius) - at.x * at.y * w);
}

/// Sums add(point, weight, sums) over the cuboid's points for every offset of the span.
template <class Arch, int potentials, class Add>
void sum_points(const Cuboid& cuboid, const GaussRule& rule, double z, const RowSpan& span, double* rows,
                std::int64_t stride, Add add) {
  using V = xsimd::batch<double, Arch>;
  struct Sums {
    V of[potentials];
  };
  const double volume = cuboid.a * cuboid.b * cuboid.c;
  const auto body = [&](V x) {
    Sums sums;
    for (int k = 0; k < potentials; ++k) sums.of[k] = V(0.0);
    for (int n = 0; n < rule.nodes; ++n) {
      const V to_z(z + cuboid.c * rule.node[n]);
      for (int m = 0; m < rule.nodes; ++m) {
        const V to_y(span.y + cuboid.b * rule.node[m]), rest = to_z * to_z + to_y * to_y;
        for (int l = 0; l < rule.nodes; ++l) {
          const V to_x = x + V(cuboid.a * rule.node[l]);
          const V inverse = inverse_root<Arch>(to_x * to_x + rest);
          add(Point<V>(to_x, to_y, to_z, inverse), V(volume * rule.weight[n] * rule.weight[m] * rule.weight[l]),
              sums.of);
        }
      }
    }
    return sums;
  };
  for_offsets<Arch>(span, body, [&](const Sums& sums, std::int64_t done, std::int64_t count) {
    for (int k = 0; k < potentials; ++k) store_lanes(sums.of[k], rows + k * stride + done, count);
  });
}

template <class Arch>
void kelvin_points(const Cuboid& cuboid, const GaussRule& rule, double z, const RowSpan& span, double* rows,
                   std::int64_t stride) {
  using V = xsimd::batch<double, Arch>;
  sum_points<Arch, kKelvinPotentials>(
      cuboid, rule, z, span, rows, stride,
      [](const Point<V>& at, V weight, V(&sum)[kKelvinPotentials])
          __attribute__((always_inline)) { add_kelvin(at, weight, sum); });
}

template <class Arch>
void image_points(const Cuboid& cuboid, const GaussRule& rule, double z, const RowSpan& span, double* rows,
                  std::int64_t stride) {
  using V = xsimd::batch<double, Arch>;
  sum_points<Arch, kImagePotentials>(
      cuboid, rule, z, span, rows, stride,
      [](const Point<V>& at, V weight, V(&sum)[kImagePotentials])
          __attribute__((always_inline)) { add_image(at, weight, sum); });
}

template <class Arch>
void surface_points(const Cuboid& cuboid, const GaussRule& rule, double z, double poissons_ratio, const RowSpan& span,
                    double* rows, std::int64_t stride) {
  using V = xsimd::batch<double, Arch>;
  sum_points<Arch, kSurfacePotentials>(
      cuboid, rule, z, span, rows, stride,
      [poissons_ratio](const Point<V>& at, V weight, V(&sum)[kSurfacePotentials])
          __attribute__((always_inline)) { add_surface(at, weight, poissons_ratio, sum); });
}

}  // namespace
}  // namespace brinell::simd
