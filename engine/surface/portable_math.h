// Elementary functions whose bits are the same on every machine: only + − × ÷ and integer arithmetic, no library
// calls, which choose their code (fused or not) by the processor. Requires IEEE double arithmetic without
// contraction (-ffp-contract=off) and rounding to nearest.
#pragma once

#include <bit>
#include <cfloat>
#include <cstdint>

namespace brinell::surface::portable {

static_assert(FLT_EVAL_METHOD == 0, "intermediate results must have the precision of their type");

struct SinCos {
  double sin;
  double cos;
};

/// Nearest integer, ties to even; |value| < 2^51.
inline double nearest(double value) {
  constexpr double kShift = 6755399441055744.0;  // 1.5·2^52: adding it leaves no bits behind the point
  return (value + kShift) - kShift;
}

/// Sine and cosine for |angle| <= pi/4 by their Taylor series, whose first left-out terms are below 1e-19 and
/// 2e-18. Error below 1 ulp.
inline SinCos sin_cos_of_eighth(double angle) {
  const double s = angle * angle;
  double sine = 1.0 / 355687428096000.0;  // 1/17!
  sine = 1.0 / 1307674368000.0 - s * sine;
  sine = 1.0 / 6227020800.0 - s * sine;
  sine = 1.0 / 39916800.0 - s * sine;
  sine = 1.0 / 362880.0 - s * sine;
  sine = 1.0 / 5040.0 - s * sine;
  sine = 1.0 / 120.0 - s * sine;
  sine = 1.0 / 6.0 - s * sine;
  double cosine = 1.0 / 20922789888000.0;  // 1/16!
  cosine = 1.0 / 87178291200.0 - s * cosine;
  cosine = 1.0 / 479001600.0 - s * cosine;
  cosine = 1.0 / 3628800.0 - s * cosine;
  cosine = 1.0 / 40320.0 - s * cosine;
  cosine = 1.0 / 720.0 - s * cosine;
  cosine = 1.0 / 24.0 - s * cosine;
  cosine = 0.5 - s * cosine;
  return {angle - angle * s * sine, 1.0 - s * cosine};
}

/// sin(2·pi·turns) and cos(2·pi·turns), exact at multiples of a quarter turn, odd and even to the bit; absolute
/// error below 3e-16 for |turns| < 2^49.
inline SinCos sin_cos_of_turns(double turns) {
  const double quarters = nearest(4.0 * turns);
  const double rest = turns - 0.25 * quarters;  // exact
  const SinCos first = sin_cos_of_eighth(6.283185307179586476925 * rest);
  switch (static_cast<std::uint64_t>(static_cast<std::int64_t>(quarters)) & 3U) {
    case 0: return first;
    case 1: return {first.cos, -first.sin};
    case 2: return {-first.sin, -first.cos};
    default: return {-first.cos, first.sin};
  }
}

/// Logarithm to base 2 of a normal positive number. With m = value/2^e in [sqrt(1/2), sqrt(2)) and
/// s = (m − 1)/(m + 1): log2 value = e + 2/ln2 · (s + s³/3 + s⁵/5 + …).
inline double log2(double value) {
  constexpr std::uint64_t kSqrtHalf = 0x3fe6a09e667f3bcdULL;
  constexpr std::uint64_t kMantissa = 0x000fffffffffffffULL;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t shifted = bits - kSqrtHalf;
  const std::int64_t exponent = static_cast<std::int64_t>(shifted) >> 52;
  const double m = std::bit_cast<double>((shifted & kMantissa) + kSqrtHalf);
  const double s = (m - 1.0) / (m + 1.0);
  const double square = s * s;  // <= 0.0295: the first term left out is below 1e-18
  double series = 1.0 / 23.0;
  series = series * square + 1.0 / 21.0;
  series = series * square + 1.0 / 19.0;
  series = series * square + 1.0 / 17.0;
  series = series * square + 1.0 / 15.0;
  series = series * square + 1.0 / 13.0;
  series = series * square + 1.0 / 11.0;
  series = series * square + 1.0 / 9.0;
  series = series * square + 1.0 / 7.0;
  series = series * square + 1.0 / 5.0;
  series = series * square + 1.0 / 3.0;
  return static_cast<double>(exponent) + 2.885390081777926814720 * (s + s * square * series);
}

/// 2^value for |value| <= 1000: 2^n · exp(f·ln2) with |f| <= 1/2, by the exponential series.
inline double exp2(double value) {
  const double n = nearest(value);
  const double z = (value - n) * 0.693147180559945309417;
  double series = 1.0 / 87178291200.0;  // 1/14!
  series = series * z + 1.0 / 6227020800.0;
  series = series * z + 1.0 / 479001600.0;
  series = series * z + 1.0 / 39916800.0;
  series = series * z + 1.0 / 3628800.0;
  series = series * z + 1.0 / 362880.0;
  series = series * z + 1.0 / 40320.0;
  series = series * z + 1.0 / 5040.0;
  series = series * z + 1.0 / 720.0;
  series = series * z + 1.0 / 120.0;
  series = series * z + 1.0 / 24.0;
  series = series * z + 1.0 / 6.0;
  series = series * z + 0.5;
  const std::uint64_t scale = static_cast<std::uint64_t>(1023 + static_cast<std::int64_t>(n)) << 52;
  return (1.0 + (z + z * z * series)) * std::bit_cast<double>(scale);
}

/// base^exponent for base > 0 and |exponent·log2 base| <= 1000; relative error about
/// (1 + |exponent·log2 base|)·2.2e-16.
inline double power(double base, double exponent) {
  return exp2(exponent * log2(base));
}

}  // namespace brinell::surface::portable
