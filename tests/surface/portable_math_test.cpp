#include "surface/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace brinell::surface {
namespace {

constexpr long double kPi = 3.14159265358979323846264338327950288L;

TEST(PortableMath, sine_and_cosine_agree_with_long_double) {
  // Documented: 3e-16. Fractions of a turn that are dense and irregular, near zero and far out.
  for (int k = -20000; k <= 20000; ++k) {
    const double turns = k * 0.000317 + (k % 7) * 41.0;
    const long double reduced = static_cast<long double>(turns) - std::nearbyint(turns);
    const auto value = portable::sin_cos_of_turns(turns);
    EXPECT_NEAR(value.sin, static_cast<double>(std::sin(2 * kPi * reduced)), 3e-16) << turns;
    EXPECT_NEAR(value.cos, static_cast<double>(std::cos(2 * kPi * reduced)), 3e-16) << turns;
  }
}

TEST(PortableMath, sine_is_relatively_accurate_near_zero) {
  for (double turns = 0.1; turns > 1e-300; turns *= 0.37) {
    const auto exact = static_cast<double>(std::sin(2 * kPi * static_cast<long double>(turns)));
    EXPECT_NEAR(portable::sin_cos_of_turns(turns).sin, exact, 3.3e-16 * exact);  // factor 2 pi and sine: 1.5 ulp
  }
}

TEST(PortableMath, quarter_turns_are_exact_and_symmetry_is_to_the_bit) {
  for (int k = -9; k <= 9; ++k) {
    const auto value = portable::sin_cos_of_turns(0.25 * k);
    const int quarter = ((k % 4) + 4) % 4;
    EXPECT_EQ(value.sin, quarter == 1 ? 1.0 : quarter == 3 ? -1.0 : 0.0);
    EXPECT_EQ(value.cos, quarter == 0 ? 1.0 : quarter == 2 ? -1.0 : 0.0);
  }
  for (int k = 1; k <= 1000; ++k) {
    const double turns = k * 0.0137;
    EXPECT_EQ(portable::sin_cos_of_turns(-turns).sin, -portable::sin_cos_of_turns(turns).sin);
    EXPECT_EQ(portable::sin_cos_of_turns(-turns).cos, portable::sin_cos_of_turns(turns).cos);
  }
}

TEST(PortableMath, logarithm_and_exponential_agree_with_long_double) {
  for (double value = 1e-300; value < 1e300; value *= 1.37) {
    const long double exact = std::log2(static_cast<long double>(value));
    EXPECT_NEAR(portable::log2(value), static_cast<double>(exact),
                4e-16 * (1 + std::fabs(static_cast<double>(exact))));
  }
  EXPECT_EQ(portable::log2(1.0), 0.0);
  EXPECT_EQ(portable::log2(1024.0), 10.0);
  for (double value = -1000; value <= 1000; value += 0.731) {
    const auto exact = static_cast<double>(std::exp2(static_cast<long double>(value)));
    EXPECT_NEAR(portable::exp2(value), exact, 4.5e-16 * exact) << value;  // 2 ulp
  }
  EXPECT_EQ(portable::exp2(-3.0), 0.125);
}

TEST(PortableMath, power_keeps_its_documented_error) {
  for (double base = 1; base < 1e12; base *= 2.3) {
    for (const double exponent : {-0.5, -0.9, -1.0, 0.31}) {
      const auto exact = static_cast<double>(std::pow(static_cast<long double>(base), exponent));
      const double bound = 4.5e-16 * (1 + std::fabs(exponent * std::log2(base)));
      EXPECT_NEAR(portable::power(base, exponent), exact, bound * exact) << base << "^" << exponent;
    }
  }
}

}  // namespace
}  // namespace brinell::surface
