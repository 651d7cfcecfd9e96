// Exponential and logarithm without branches or calls, so that loops over them vectorise at every instruction set.
// xsimd's pow loses up to 32 units in the last place, more for large exponents. Here a relative error of 1e-16 each,
// and of about |n·ln x|·1e-16 in x^n = exp(n·ln x). The logarithm's coefficients are those of FDLIBM (Sun, 1993).
// In single precision, with an error of about 2e-7, for starting values.
#pragma once

#include <cstdint>

namespace brinell::simd {
namespace {

/// exp(x) = power·(1 + rest), power = 2^k; x is held within the normal range.
struct SplitExponential {
  double power, rest;
};

inline __attribute__((always_inline)) SplitExponential split_exponential(double x) {
  constexpr double kRounder = 0x1.8p52;  // its sum with a small number has that number's integer in the low bits
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  const double above = x > -700.0 ? x : -700.0;
  const double held = above < 700.0 ? above : 700.0;
  const double shifted = held * 1.44269504088896338700 + kRounder;
  const double k = shifted - kRounder;
  const double r = (held - k * kLn2High) - k * kLn2Low;
  const double r2 = r * r, r4 = r2 * r2;
  const double a = 1.0 / 2 + r * (1.0 / 6) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const double b = 1.0 / 720 + r * (1.0 / 5040) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const double c = 1.0 / 3628800 + r * (1.0 / 39916800) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const double rest = r + r2 * (a + r4 * (b + r4 * c));
  const std::uint64_t bits = (__builtin_bit_cast(std::uint64_t, shifted) + 1023) << 52;
  return {__builtin_bit_cast(double, bits), rest};
}

inline __attribute__((always_inline)) double exp_of(double x) {
  const SplitExponential e = split_exponential(x);
  return e.power + e.power * e.rest;
}

/// exp(x) − 1, also for small x.
inline __attribute__((always_inline)) double expm1_of(double x) {
  const SplitExponential e = split_exponential(x);
  return (e.power - 1.0) + e.power * e.rest;
}

/// x > 0; below the normal range the logarithm of its end.
inline __attribute__((always_inline)) double log_of(double x) {
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e00000000u, kOne = 0x3ff0000000000000u;
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  const double held = x > 0x1p-1022 ? x : 0x1p-1022;
  const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, held) + (kOne - kRootHalf);
  const double k = __builtin_bit_cast(double, (bits >> 52) | 0x4330000000000000u) - (0x1p52 + 1023.0);
  const double f = __builtin_bit_cast(double, (bits & 0x000fffffffffffffu) + kRootHalf) - 1.0;
  const double s = f / (2.0 + f), z = s * s, w = z * z;
  const double odd =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double half_square = 0.5 * f * f;
  return k * kLn2High - ((half_square - (s * (half_square + (odd + even)) + k * kLn2Low)) - f);
}

/// 2^x, x held to at least −100 and at most 100.
inline __attribute__((always_inline)) float exp2_of(float x) {
  constexpr float kRounder = 0x1.8p23f;
  const float above = x > -100.0f ? x : -100.0f;
  const float held = above < 100.0f ? above : 100.0f;
  const float shifted = held + kRounder;
  const float r = held - (shifted - kRounder);
  const float series =
      1.0f + r * (0.693147182f +
                  r * (0.240226507f +
                       r * (0.0555041087f + r * (0.00961812911f + r * (0.00133335581f + r * 0.000154035304f)))));
  return __builtin_bit_cast(
      float, __builtin_bit_cast(std::uint32_t, series) + (__builtin_bit_cast(std::uint32_t, shifted) << 23));
}

/// x > 0 and normal.
inline __attribute__((always_inline)) float log2_of(float x) {
  constexpr std::uint32_t kRootHalf = 0x3f3504f3u, kOne = 0x3f800000u;
  const std::uint32_t bits = __builtin_bit_cast(std::uint32_t, x) + (kOne - kRootHalf);
  const float k = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
  const float m = __builtin_bit_cast(float, (bits & 0x007fffffu) + kRootHalf);
  const float s = (m - 1.0f) / (m + 1.0f), z = s * s;
  return k + s * (2.88539008f + z * (0.961796694f + z * (0.577078016f + z * (0.412198583f + z * 0.320598898f))));
}

}  // namespace
}  // namespace brinell::simd
