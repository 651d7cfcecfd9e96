// Transforms of 2, 3, 4, 5, 8 and 16 values in registers, y_t = Σ_s x_s exp(sign·2πi st/R), and the transposition
// of a square of vectors. V is a SIMD vector or a plain number.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace brinell::simd {
namespace {

/// body(0), body(1) … body(N − 1) with compile-time indices: arrays indexed by them stay in registers.
template <std::size_t N, class Body>
[[gnu::always_inline]] inline void unrolled(Body&& body) {
  [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
    (body(std::integral_constant<std::size_t, I>{}), ...);
  }
  (std::make_index_sequence<N>{});
}

template <class V>
struct Complex {
  V re, im;
};

/// A vector of equal numbers.
template <class V>
[[gnu::always_inline]] inline V constant(double value) {
  if constexpr (std::is_floating_point_v<V>) {
    return static_cast<V>(value);
  } else {
    return V(static_cast<typename V::value_type>(value));
  }
}

template <class V>
[[gnu::always_inline]] inline Complex<V> operator+(const Complex<V>& a, const Complex<V>& b) {
  return {a.re + b.re, a.im + b.im};
}
template <class V>
[[gnu::always_inline]] inline Complex<V> operator-(const Complex<V>& a, const Complex<V>& b) {
  return {a.re - b.re, a.im - b.im};
}

/// a·w, and a·conj(w).
template <class V>
[[gnu::always_inline]] inline Complex<V> times(const Complex<V>& a, const V& w_re, const V& w_im) {
  return {a.re * w_re - a.im * w_im, a.re * w_im + a.im * w_re};
}
template <class V>
[[gnu::always_inline]] inline Complex<V> times_conjugate(const Complex<V>& a, const V& w_re, const V& w_im) {
  return {a.re * w_re + a.im * w_im, a.im * w_re - a.re * w_im};
}

/// a·exp(sign·2πi/4).
template <int sign, class V>
[[gnu::always_inline]] inline Complex<V> turned(const Complex<V>& a) {
  if constexpr (sign > 0) {
    return {-a.im, a.re};
  } else {
    return {a.im, -a.re};
  }
}
/// a + sign·i·b.
template <int sign, class V>
[[gnu::always_inline]] inline Complex<V> plus_turned(const Complex<V>& a, const Complex<V>& b) {
  if constexpr (sign > 0) {
    return {a.re - b.im, a.im + b.re};
  } else {
    return {a.re + b.im, a.im - b.re};
  }
}

template <int sign, class V>
[[gnu::always_inline]] inline void dft4(Complex<V>& x0, Complex<V>& x1, Complex<V>& x2, Complex<V>& x3) {
  const Complex<V> sum02 = x0 + x2, difference02 = x0 - x2;
  const Complex<V> sum13 = x1 + x3, difference13 = x1 - x3;
  x0 = sum02 + sum13;
  x1 = plus_turned<sign>(difference02, difference13);
  x2 = sum02 - sum13;
  x3 = plus_turned<-sign>(difference02, difference13);
}

template <int sign, std::size_t R, class V>
[[gnu::always_inline]] inline void dft(Complex<V> (&x)[R]) {
  if constexpr (R == 2) {
    const Complex<V> sum = x[0] + x[1];
    x[1] = x[0] - x[1];
    x[0] = sum;
  } else if constexpr (R == 3) {
    const V half = constant<V>(0.5), sine = constant<V>(0.86602540378443864676);
    const Complex<V> sum = x[1] + x[2], difference = x[1] - x[2];
    const Complex<V> middle{x[0].re - half * sum.re, x[0].im - half * sum.im};
    const Complex<V> side{sine * difference.re, sine * difference.im};
    x[0] = x[0] + sum;
    x[1] = plus_turned<sign>(middle, side);
    x[2] = plus_turned<-sign>(middle, side);
  } else if constexpr (R == 4) {
    dft4<sign>(x[0], x[1], x[2], x[3]);
  } else if constexpr (R == 5) {
    const V cos1 = constant<V>(0.30901699437494742410), sin1 = constant<V>(0.95105651629515357212);
    const V cos2 = constant<V>(-0.80901699437494742410), sin2 = constant<V>(0.58778525229247312917);
    const Complex<V> sum1 = x[1] + x[4], difference1 = x[1] - x[4];
    const Complex<V> sum2 = x[2] + x[3], difference2 = x[2] - x[3];
    const Complex<V> even1{x[0].re + cos1 * sum1.re + cos2 * sum2.re, x[0].im + cos1 * sum1.im + cos2 * sum2.im};
    const Complex<V> even2{x[0].re + cos2 * sum1.re + cos1 * sum2.re, x[0].im + cos2 * sum1.im + cos1 * sum2.im};
    const Complex<V> odd1{sin1 * difference1.re + sin2 * difference2.re,
                          sin1 * difference1.im + sin2 * difference2.im};
    const Complex<V> odd2{sin2 * difference1.re - sin1 * difference2.re,
                          sin2 * difference1.im - sin1 * difference2.im};
    x[0] = x[0] + sum1 + sum2;
    x[1] = plus_turned<sign>(even1, odd1);
    x[2] = plus_turned<sign>(even2, odd2);
    x[3] = plus_turned<-sign>(even2, odd2);
    x[4] = plus_turned<-sign>(even1, odd1);
  } else if constexpr (R == 8) {
    const V root = constant<V>(0.70710678118654752440);
    Complex<V> even[4], odd[4];
    unrolled<4>([&](auto s) __attribute__((always_inline)) {
      even[s] = x[s] + x[s + 4];
      odd[s] = x[s] - x[s + 4];
    });
    dft4<sign>(even[0], even[1], even[2], even[3]);
    // odd[1] and odd[3] times the eighth roots (1 ± i)/√2 and (−1 ± i)/√2; 1/√2 waits for the last addition.
    const Complex<V> sum02 = plus_turned<sign>(odd[0], odd[2]), difference02 = plus_turned<-sign>(odd[0], odd[2]);
    const Complex<V> first = plus_turned<sign>(odd[1], odd[1]);
    const Complex<V> third = plus_turned<-sign>(odd[3], odd[3]);  // times −1
    const Complex<V> sum13 = first - third, difference13 = first + third;
    x[0] = even[0];
    x[2] = even[1];
    x[4] = even[2];
    x[6] = even[3];
    x[1] = {sum02.re + root * sum13.re, sum02.im + root * sum13.im};
    x[5] = {sum02.re - root * sum13.re, sum02.im - root * sum13.im};
    x[3] = plus_turned<sign>(difference02, {root * difference13.re, root * difference13.im});
    x[7] = plus_turned<-sign>(difference02, {root * difference13.re, root * difference13.im});
  } else {
    static_assert(R == 16);
    const V one = constant<V>(0.92387953251128675613), three = constant<V>(0.38268343236508977173);
    const V two = constant<V>(0.70710678118654752440), plus = constant<V>(sign);
    unrolled<4>([&](auto s) __attribute__((always_inline)) { dft4<sign>(x[s], x[s + 4], x[s + 8], x[s + 12]); });
    // x[4a + s] = Σ_b x_{s+4b} exp(sign·2πi ab/4), to be turned by exp(sign·2πi as/16)
    x[5] = times(x[5], one, plus * three);
    x[6] = times(x[6], two, plus * two);
    x[7] = times(x[7], three, plus * one);
    x[9] = times(x[9], two, plus * two);
    x[10] = turned<sign>(x[10]);
    x[11] = times(x[11], -two, plus * two);
    x[13] = times(x[13], three, plus * one);
    x[14] = times(x[14], -two, plus * two);
    x[15] = times(x[15], -one, -plus * three);
    unrolled<4>([&](auto a) __attribute__((always_inline)) {
      dft4<sign>(x[4 * a], x[4 * a + 1], x[4 * a + 2], x[4 * a + 3]);
    });
    // y_{a + 4b} stands in x[4a + b]
    unrolled<4>([&](auto a) __attribute__((always_inline)) {
      unrolled<4>([&](auto b) __attribute__((always_inline)) {
        if constexpr (a < b) std::swap(x[4 * a + b], x[4 * b + a]);
      });
    });
  }
}

/// Exchanges, between vectors a and b, the lanes in which bit `distance` of the lane differs from the vector's.
template <std::size_t distance, class V>
[[gnu::always_inline]] inline void exchange(V& a, V& b) {
  using Register = typename V::register_type;
  const Register left = a, right = b;
  [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
    a = V(Register(__builtin_shufflevector(left, right, ((I & distance) != 0 ? V::size + I - distance : I)...)));
    b = V(Register(__builtin_shufflevector(left, right, ((I & distance) != 0 ? V::size + I : I + distance)...)));
  }
  (std::make_index_sequence<V::size>{});
}

/// Transposes x: lane i of vector j and lane j of vector i change places.
template <std::size_t distance, class V, std::size_t lanes>
[[gnu::always_inline]] inline void transpose(Complex<V> (&x)[lanes]) {
  static_assert(lanes == V::size);
  if constexpr (distance < lanes) {
    unrolled<lanes>([&](auto j) __attribute__((always_inline)) {
      if constexpr ((j & distance) == 0) {
        exchange<distance>(x[j].re, x[j + distance].re);
        exchange<distance>(x[j].im, x[j + distance].im);
      }
    });
    transpose<2 * distance>(x);
  }
}

}  // namespace
}  // namespace brinell::simd
