// theta and theta_bar against central differences of the long-double return.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "plastic/return_case.h"

namespace brinell::plastic {
namespace {

using support::LongTensor;

TEST(ReturnTangent, is_the_derivative_of_the_increment) {
  const parallel::Arena arena(1);
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (const NamedLaw& one :
       {NamedLaw{"swift", Swift{1240e6, 30, 0.085, 1e6}}, NamedLaw{"linear", LinearHardening{500e6, 10e9}},
        NamedLaw{"perfect", PerfectPlasticity{250e6}}, NamedLaw{"voce", Voce{300e6, 700e6, 12}},
        NamedLaw{"ramberg_osgood", RambergOsgood{4320e6, 12.6, 0}},
        NamedLaw{"plateau", RambergOsgood{4320e6, 12.6, 3000e6}},
        NamedLaw{"table", HardeningTable{{0, 0.01, 0.05, 0.3}, {300e6, 500e6, 700e6, 810e6}}}}) {
    const YieldCurve curve({one.law, {}});
    const auto yield = static_cast<double>(support::yield_of(one.law, 0.003));
    const Point point = random_point(random, 1.7 * yield, yield, 0.003);
    for (const simd::Isa isa : simd::supported()) {
      Field field(std::vector<Point>{point});
      map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, field.state(), field.result());
      const long double theta = field.output(8)[0], theta_bar = field.output(9)[0];
      LongTensor direction{};
      for (std::size_t c = 0; c < 6; ++c) direction[c] = field.output(c)[0];
      const long double size = std::sqrt(support::contract(direction, direction));
      for (auto& component : direction) component /= size;
      // The third derivative over the yield stress squared is of order one: an error of step squared.
      const long double step = 1e-5L;
      for (int k = 0; k < 6; ++k) {
        LongTensor change{}, up = point.trial, down = point.trial;
        for (std::size_t c = 0; c < 6; ++c) {
          change[c] = yield * normal(random);
          up[c] += step * change[c];
          down[c] -= step * change[c];
        }
        const LongTensor above = support::increment_of(one.law, 1, kShearModulus, up, 0.003);
        const LongTensor below = support::increment_of(one.law, 1, kShearModulus, down, 0.003);
        const LongTensor along = support::deviator_of(change);
        const long double part = support::contract(direction, change);
        for (std::size_t c = 0; c < 6; ++c) {
          const long double found = kShearModulus * (above[c] - below[c]) / step;
          const long double expected = (1 - theta) * along[c] + theta_bar * part * direction[c];
          EXPECT_NEAR(static_cast<double>(found / yield), static_cast<double>(expected / yield), 1e-8)
              << one.name << " " << simd::name(isa);
        }
      }
    }
  }
}

}  // namespace
}  // namespace brinell::plastic
