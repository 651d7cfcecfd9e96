// From the potentials of a cuboid to the stress of a unit strain nucleus, in any kind of number: the operators of
// engine/influence/eigenstrain.h written out once. Axes are 0 1 2; index pairs of the stress are (i, k), those of the
// strain (j, l); everything is per 2 mu times −1/(8π(1 − ν)).
#pragma once

#include "simd/eigenstrain_kernels.h"

namespace brinell::simd {
namespace {

/// Number of a symmetric derivative among 11 12 13 22 …, 111 112 113 122 …, 1111 1112 …: with m indices that are not
/// 1, of them t equal to 3, it is m(m + 1)/2 + t.
template <class... Axis>
constexpr int derivative_number(Axis... axis) {
  const int m = ((axis != 0) + ...), t = ((axis == 2) + ...);
  return m * (m + 1) / 2 + t;
}

struct IndexPair {
  int first, second;
};
/// xx yy zz yz xz xy.
inline constexpr IndexPair kIndexPair[6] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};

template <class V>
struct KelvinTensors {
  V psi[15];
  V phi[6];
};

template <class V>
[[gnu::always_inline]] inline void kelvin_tensors(const V* potential, KelvinTensors<V>& t) {
  for (int k = 0; k < 15; ++k) t.psi[k] = potential[k];
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      t.phi[derivative_number(i, j)] =
          V(0.5) * (t.psi[derivative_number(i, j, 0, 0)] + t.psi[derivative_number(i, j, 1, 1)] +
                    t.psi[derivative_number(i, j, 2, 2)]);
    }
  }
}

template <class V>
struct ImageTensors {
  V plus[15], minus[15];  // (3 − 4ν)Ψ ± qX
  V psi[15];              // fourth derivatives
  V phi2[6];
  V psi5[15];  // Ψ,ijkl3
  V phi3[10];
  V phi4[15];
};

/// The missing one of fifteen derivatives of a biharmonic function.
template <class V>
V biharmonic_rest(const V* d) {
  const auto at = [d](int i, int j) { return d[derivative_number(i, i, j, j)]; };
  return -(at(0, 0) + at(1, 1) + V(2.0) * (at(0, 1) + at(0, 2) + at(1, 2)));
}

template <class V>
[[gnu::always_inline]] inline void image_tensors(const V* p, double nu, ImageTensors<V>& t) {
  const auto n = [](auto... axis) { return derivative_number(axis...); };
  for (int k = 0; k < 14; ++k) t.psi[k] = p[k];
  for (int k = 0; k < 14; ++k) t.psi5[k] = p[18 + k];
  t.psi[14] = biharmonic_rest(t.psi);
  t.psi5[14] = biharmonic_rest(t.psi5);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const auto half_trace = [&](const V* d) {
        return V(0.5) * (d[n(i, j, 0, 0)] + d[n(i, j, 1, 1)] + d[n(i, j, 2, 2)]);
      };
      t.phi2[n(i, j)] = half_trace(t.psi);
      t.phi3[n(i, j, 2)] = half_trace(t.psi5);
    }
  }
  t.phi3[n(0, 0, 1)] = p[32];
  t.phi3[n(0, 1, 1)] = p[33];
  t.phi3[n(0, 0, 0)] = -(t.phi3[n(0, 2, 2)] + p[33]);
  t.phi3[n(1, 1, 1)] = -(t.phi3[n(1, 2, 2)] + p[32]);
  t.phi4[n(0, 0, 0, 0)] = p[34];
  t.phi4[n(0, 0, 0, 1)] = p[35];
  t.phi4[n(0, 0, 1, 1)] = p[36];
  t.phi4[n(0, 1, 1, 1)] = p[37];
  t.phi4[n(1, 1, 1, 1)] = p[38];
  t.phi4[n(0, 0, 0, 2)] = p[39];
  t.phi4[n(0, 0, 1, 2)] = p[40];
  t.phi4[n(0, 1, 1, 2)] = p[41];
  t.phi4[n(1, 1, 1, 2)] = p[42];
  t.phi4[n(0, 0, 2, 2)] = -(p[34] + p[36]);
  t.phi4[n(0, 1, 2, 2)] = -(p[35] + p[37]);
  t.phi4[n(1, 1, 2, 2)] = -(p[36] + p[38]);
  t.phi4[n(0, 2, 2, 2)] = -(p[39] + p[41]);
  t.phi4[n(1, 2, 2, 2)] = -(p[40] + p[42]);
  t.phi4[n(2, 2, 2, 2)] = p[34] + p[36] + p[36] + p[38];
  V x[15];
  x[n(0, 0, 0, 1)] = p[14];
  x[n(0, 0, 1, 1)] = p[15];
  x[n(0, 0, 1, 2)] = p[16];
  x[n(0, 1, 1, 2)] = p[17];
  x[n(0, 0, 0, 0)] = -(t.phi2[n(0, 0)] + p[15]);
  x[n(0, 1, 1, 1)] = -(t.phi2[n(0, 1)] + p[14]);
  x[n(1, 1, 1, 1)] = -(t.phi2[n(1, 1)] + p[15]);
  x[n(0, 0, 0, 2)] = -(t.phi2[n(0, 2)] + p[17]);
  x[n(1, 1, 1, 2)] = -(t.phi2[n(1, 2)] + p[16]);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) x[n(i, j, 2, 2)] = t.phi2[n(i, j)];
  }
  const V three(3 - 4 * nu), q(4 * (1 - nu) * (1 - 2 * nu));
  for (int k = 0; k < 15; ++k) {
    const V first = three * t.psi[k], second = q * x[k];
    t.plus[k] = first + second;
    t.minus[k] = first - second;
  }
}

/// Stress (i, k) of the nucleus s_jl = 1, both orders of j and l where they differ.
template <int I, int J, class V>
[[gnu::always_inline]] inline V kelvin_stress(const KelvinTensors<V>& t, double nu) {
  constexpr int i = kIndexPair[I].first, k = kIndexPair[I].second;
  constexpr int j = kIndexPair[J].first, l = kIndexPair[J].second;
  const auto one = [&]<int a, int b>() __attribute__((always_inline)) {  // s_ab
    V sum = -t.psi[derivative_number(i, k, j, l)];
    if constexpr (i == a) sum = sum + V(2 * (1 - nu)) * t.phi[derivative_number(k, b)];
    if constexpr (k == a) sum = sum + V(2 * (1 - nu)) * t.phi[derivative_number(i, b)];
    if constexpr (i == k) sum = sum + V(2 * nu) * t.phi[derivative_number(j, l)];
    return sum;
  };
  if constexpr (j == l) {
    return one.template operator()<j, l>();
  } else {
    return one.template operator()<j, l>() + one.template operator()<l, j>();
  }
}

/// Derivatives of the image's operators: displacement i, force j, and further derivatives.
template <int i, int j, int l, int k, class V>
[[gnu::always_inline]] inline V image_0(const ImageTensors<V>& t, double nu) {  // d_l d_k I0_ij
  constexpr int four = derivative_number(i, j, l, k), two = derivative_number(l, k);
  if constexpr (i < 2 && j < 2) {
    if constexpr (i == j) {
      return V(4 * (1 - nu)) * t.phi2[two] - t.plus[four];
    } else {
      return -t.plus[four];
    }
  } else if constexpr (i == 2 && j < 2) {
    return t.plus[four];
  } else if constexpr (j == 2 && i < 2) {
    return t.minus[four];
  } else {
    return V(8 * (1 - nu) * (1 - nu)) * t.phi2[two] - V(3 - 4 * nu) * t.psi[four];
  }
}
/// d_l I1_ij from Ψ fourth, Φ second derivatives; d_l d_k I1_ij from fifth, third ones.
template <int i, int j, int... more, class V>
[[gnu::always_inline]] inline V image_1(const V* psi, const V* phi, double nu) {
  constexpr int of_psi =
      sizeof...(more) == 1 ? derivative_number(i, j, 2, more...) : derivative_number(i, j, more...);
  if constexpr (i < 2 && j < 2) {
    return V(-2.0) * psi[of_psi];
  } else if constexpr (i == 2 && j < 2) {
    return V(-4 * (1 - 2 * nu)) * phi[derivative_number(j, more...)] - V(2.0) * psi[of_psi];
  } else if constexpr (j == 2 && i < 2) {
    return V(2.0) * psi[of_psi] - V(8 * (1 - nu)) * phi[derivative_number(i, more...)];
  } else {
    return V(2.0) * psi[of_psi] - V(4.0) * phi[derivative_number(2, more...)];
  }
}

constexpr double mirror(int axis) {
  return axis == 2 ? -1.0 : 1.0;
}

template <int i, int j, int l, int k, class V>
[[gnu::always_inline]] inline V gradient_a(const ImageTensors<V>& t, double nu) {
  V sum = image_0<i, j, l, k>(t, nu);
  if constexpr (k == 2) sum = sum + image_1<i, j, l>(t.psi, t.phi2, nu);
  return sum;
}
template <int i, int j, int l, int k, class V>
[[gnu::always_inline]] inline V gradient_b(const ImageTensors<V>& t, double nu) {
  V sum = image_1<i, j, l, k>(t.psi5, t.phi3, nu);
  if constexpr (k == 2) sum = sum + V(4 * mirror(j)) * t.phi3[derivative_number(i, j, l)];
  return sum;
}

/// The three parts of the image's stress, sigma = a + z b + z² c.
enum class ImagePart { a, b, c };

template <ImagePart part, int I, int J, class V>
[[gnu::always_inline]] inline V image_stress(const ImageTensors<V>& t, double nu) {
  constexpr int i = kIndexPair[I].first, k = kIndexPair[I].second;
  constexpr int first = kIndexPair[J].first, second = kIndexPair[J].second;
  const auto one = [&]<int j, int l>() __attribute__((always_inline)) {
    V sum(0.0);
    if constexpr (part == ImagePart::a) {
      if constexpr (i == k) {
        sum = gradient_a<i, j, l, i>(t, nu);
        if constexpr (j < 2) {
          sum = sum + V(nu * (2 - 8 * nu)) * t.phi2[derivative_number(j, l)] +
                V(4 * nu) * t.psi[derivative_number(j, 2, 2, l)];
        } else {
          sum = sum + V(nu * (14 - 8 * nu)) * t.phi2[derivative_number(2, l)] -
                V(4 * nu) * t.psi[derivative_number(2, 2, 2, l)];
        }
      } else {
        sum = V(0.5) * (gradient_a<i, j, l, k>(t, nu) + gradient_a<k, j, l, i>(t, nu));
      }
    } else if constexpr (part == ImagePart::b) {
      if constexpr (i == k) {
        sum = gradient_b<i, j, l, i>(t, nu) - V(4 * nu * mirror(j)) * t.phi3[derivative_number(j, 2, l)];
      } else {
        sum = V(0.5) * (gradient_b<i, j, l, k>(t, nu) + gradient_b<k, j, l, i>(t, nu));
      }
    } else {
      sum = V(2 * mirror(j)) * t.phi4[derivative_number(i, j, l, k)];
    }
    return mirror(l) < 0 ? -sum : sum;
  };
  if constexpr (first == second) {
    return one.template operator()<first, second>();
  } else {
    return one.template operator()<first, second>() + one.template operator()<second, first>();
  }
}

}  // namespace
}  // namespace brinell::simd
