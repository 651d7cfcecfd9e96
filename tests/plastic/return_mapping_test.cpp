#include "plastic/return_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/error.h"
#include "plastic/return_case.h"

namespace brinell::plastic {
namespace {

using support::LongTensor;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

LongTensor increment_at(Field& field, std::size_t i) {
  LongTensor d{};
  for (std::size_t c = 0; c < 6; ++c) d[c] = field.output(c)[i];
  return d;
}

/// What the issue asks of every point, and the solution of the bisection.
void expect_returned(const HardeningLaw& law, const YieldCurve& curve, double factor, const Point& point,
                     Field& field, std::size_t i) {
  const auto p = static_cast<long double>(field.output(6)[i]),
             before = static_cast<long double>(point.plastic_strain);
  const long double von_mises = field.output(7)[i];
  const long double q = support::von_mises_of(point.trial);
  const LongTensor d = increment_at(field, i);
  const long double flow = std::sqrt(support::contract(d, d) / 1.5L);
  const long double yield = factor * support::yield_of(law, p);
  ASSERT_GE(p, before);
  ASSERT_TRUE(std::isfinite(field.output(8)[i]) && std::isfinite(field.output(9)[i]));
  // The differences of the normal stresses are rounded once, their thirds and products a few times.
  ASSERT_LE(std::abs(d[0] + d[1] + d[2]), 8 * kEpsilon * flow);
  // Rounding of the trial's deviator, of the products and the root.
  const long double q_error = 8 * kEpsilon * q;
  if (flow == 0) {
    ASSERT_EQ(p, before);
    // On the yield stress within 2^−46; without plastic strain that of the least one, which may be above the law's.
    const long double allowed = before > 0 ? yield : factor * static_cast<long double>(curve.yield_stress(0));
    ASSERT_LE(q, allowed * (1 + 2 * 0x1p-46L));
    ASSERT_LE(std::abs(von_mises - q), q_error);
    ASSERT_EQ(field.output(8)[i], 1.0);
    ASSERT_EQ(field.output(9)[i], 0.0);
    for (std::size_t c = 0; c < 6; ++c) ASSERT_EQ(field.output(10 + c)[i], field.input(c)[i]);
    return;
  }
  if (p < 1e-290L) return;  // too close to the least strain that a law from zero tells apart
  ASSERT_LE(std::abs(von_mises - yield), 1e-12L * yield);
  ASSERT_LE(std::abs(von_mises + 3 * kShearModulus * flow - q), 2 * q_error);
  ASSERT_LE(std::abs(p - before - flow), 8 * kEpsilon * p);
  // The root's condition: the stress moves with q and with p by at most as much.
  const long double expected = support::flow_of(law, factor, kShearModulus, q, before);
  ASSERT_LE(std::abs(von_mises - (q - 3 * kShearModulus * expected)), 1e-12L * yield + 2 * q_error);
  const LongTensor s = support::deviator_of(point.trial);
  for (std::size_t c = 0; c < 6; ++c) ASSERT_LE(std::abs(d[c] - 1.5L * flow / q * s[c]), 16 * kEpsilon * flow);
  LongTensor stress{};
  for (std::size_t c = 0; c < 6; ++c) stress[c] = field.output(10 + c)[i];
  const long double mean = (point.trial[0] + point.trial[1] + point.trial[2]) / 3;
  ASSERT_LE(std::abs((stress[0] + stress[1] + stress[2]) / 3 - mean), 8 * kEpsilon * (std::abs(mean) + q));
  ASSERT_LE(std::abs(support::von_mises_of(stress) - von_mises), 16 * kEpsilon * (std::abs(mean) + von_mises));
}

TEST(ReturnMapping, every_law_returns_every_point_at_every_instruction_set) {
  const parallel::Arena arena(1);
  for (const auto& [name, law] : laws()) {
    const YieldCurve curve({law, {}});
    for (const double factor : {1.0, 0.3, 7.0}) {
      const std::vector<Point> points = points_for(law, factor, 5);
      for (const simd::Isa isa : simd::supported()) {
        Field field(points);
        const std::int64_t yielded =
            map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, field.state({&factor, 1}), field.result());
        std::int64_t expected = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          SCOPED_TRACE(name + " at " + std::string(simd::name(isa)) + ", factor " + text(factor) + ", point " +
                       std::to_string(i) +
                       ", q = " + text(static_cast<double>(support::von_mises_of(points[i].trial))) +
                       ", p = " + text(points[i].plastic_strain));
          expect_returned(law, curve, factor, points[i], field, i);
          if (HasFatalFailure()) break;
          expected += field.output(0)[i] != 0 || field.output(3)[i] != 0 ? 1 : 0;
        }
        if (HasFatalFailure()) return;
        EXPECT_EQ(yielded, expected) << name;
        EXPECT_TRUE(field.canaries_live());
      }
    }
  }
}

TEST(ReturnMapping, random_laws_return_every_point) {
  const parallel::Arena arena(1);
  std::mt19937 random(21);
  const auto between = [&](double low, double high) {  // decades
    return std::pow(10.0, std::uniform_real_distribution<double>(low, high)(random));
  };
  for (int k = 0; k < 90; ++k) {
    HardeningLaw law = Swift{between(5, 11), between(-12, 6), between(-6, 0), between(0, 9)};
    if (k % 3 == 1) law = RambergOsgood{between(7, 11), between(0, 2), k % 2 == 0 ? between(6, 9) : 0};
    if (k % 3 == 2) {
      const double yield = between(5, 9);
      law = Voce{yield, yield + between(4, 10), between(-2, 9)};
    }
    const YieldCurve curve({law, {}});
    const std::vector<Point> points = points_for(law, 1, static_cast<unsigned>(k));
    Field field(points);
    const simd::Isa isa = simd::supported()[static_cast<std::size_t>(k) % simd::supported().size()];
    map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, field.state(), field.result());
    for (std::size_t i = 0; i < points.size(); ++i) {
      SCOPED_TRACE("law " + std::to_string(k) + " at " + std::string(simd::name(isa)) + ", point " +
                   std::to_string(i));
      expect_returned(law, curve, 1, points[i], field, i);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(ReturnMapping, a_mapped_stress_stays) {
  const parallel::Arena arena(1);
  for (const auto& [name, law] : laws()) {
    const YieldCurve curve({law, {}});
    std::vector<Point> points = points_for(law, 1, 8);
    for (const simd::Isa isa : simd::supported()) {
      Field first(points), second(points.size());
      map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, first.state(), first.result());
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t c = 0; c < 6; ++c) second.input(c)[i] = first.output(10 + c)[i];
        second.input(6)[i] = first.output(6)[i];
      }
      map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, second.state(), second.result());
      for (std::size_t i = 0; i < points.size(); ++i) {
        // A pressure of ten yield stresses rounds the stress by 1e-15 of the yield stress, less than 2^−46.
        EXPECT_EQ(second.output(6)[i], first.output(6)[i]) << name << " point " << i;
        for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(second.output(c)[i], 0) << name << " point " << i;
      }
    }
  }
}

TEST(ReturnMapping, a_change_of_the_unit_of_stress_changes_no_strain) {
  const parallel::Arena arena(1);
  const double scale = 1e-6;  // MPa
  const std::vector<Point> points = points_for(Swift{1240e6, 30, 0.085, 1e6}, 1, 4);
  Field field(points), scaled(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t c = 0; c < 6; ++c) scaled.input(c)[i] = scale * field.input(c)[i];
    scaled.input(6)[i] = field.input(6)[i];
  }
  const simd::KernelTable& kernels = simd::best_kernels();
  map_to_yield(arena, kernels, YieldCurve({Swift{1240e6, 30, 0.085, 1e6}, {}}), kShearModulus, field.state(),
               field.result());
  map_to_yield(arena, kernels, YieldCurve({Swift{scale * 1240e6, 30, 0.085, 1e6}, {}}), scale * kShearModulus,
               scaled.state(), scaled.result());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double reach = static_cast<double>(support::von_mises_of(points[i].trial)) / (3 * kShearModulus);
    for (std::size_t c = 0; c < 6; ++c) {
      // The scaled trial is rounded anew: with a pressure of ten times its deviator.
      EXPECT_NEAR(scaled.output(c)[i], field.output(c)[i], 1e-13 * reach) << i;
    }
  }
}

TEST(ReturnMapping, layers_have_their_own_yield_stress) {
  const parallel::Arena arena(2);
  const YieldCurve curve({PerfectPlasticity{100e6}, {}});
  constexpr std::size_t kLayers = 5, kEach = 37;
  const std::vector<double> factors{1, 2, 0.5, 3, 1.5};
  Field field(kLayers * kEach);
  for (std::size_t i = 0; i < kLayers * kEach; ++i) field.input(0)[i] = 180e6;
  EXPECT_EQ(map_to_yield(arena, simd::best_kernels(), curve, kShearModulus, field.state(factors), field.result()),
            static_cast<std::int64_t>(3 * kEach));
  std::vector<double> yield(kLayers * kEach);
  yield_stresses(arena, simd::best_kernels(), curve, yield.size(), field.output(6), factors, yield.data());
  for (std::size_t i = 0; i < kLayers * kEach; ++i) {
    EXPECT_NEAR(field.output(7)[i], std::min(180e6, 100e6 * factors[i / kEach]), 1e-6);
    EXPECT_EQ(yield[i], 100e6 * factors[i / kEach]);
  }
}

std::string refusal(Field& field, const YieldCurve& curve, double shear_modulus, std::span<const double> factors) {
  try {
    map_to_yield(parallel::Arena(2), simd::best_kernels(), curve, shear_modulus, field.state(factors),
                 field.result());
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    return error.what();
  }
  return "nothing refused";
}

TEST(ReturnMapping, what_is_no_number_is_refused_with_its_place) {
  constexpr std::size_t kCount = 9000;
  const YieldCurve curve({Swift{1240e6, 30, 0.085, 1e6}, {}});
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const std::size_t place : {std::size_t{0}, std::size_t{77}, std::size_t{4096}, kCount - 1}) {
    for (std::size_t c = 0; c < 7; ++c) {
      for (const double bad : {nan, infinity, -infinity, 1e200}) {
        if (c == 6 && bad == 1e200) continue;
        Field field(kCount);
        field.input(c)[place] = bad;
        field.input(c)[kCount - 1] = bad;
        const std::string message = refusal(field, curve, kShearModulus, {});
        EXPECT_NE(message.find("point " + std::to_string(place) + ":"), std::string::npos) << message;
        EXPECT_NE(message.find(text(bad)), std::string::npos) << message;
      }
    }
  }
  Field field(kCount);
  field.input(6)[5] = -1e-9;
  EXPECT_NE(refusal(field, curve, kShearModulus, {}).find("point 5: plastic_strain is -1e-09"), std::string::npos);
  Field good(kCount);
  EXPECT_NE(refusal(good, curve, 0, {}).find("shear_modulus is 0"), std::string::npos);
  EXPECT_NE(refusal(good, curve, nan, {}).find("shear_modulus is nan"), std::string::npos);
  const std::vector<double> seven(7, 1.0), falling{1, -1};
  EXPECT_NE(refusal(good, curve, kShearModulus, seven).find("9000 points in 7 layers"), std::string::npos);
  EXPECT_NE(refusal(good, curve, kShearModulus, falling).find("layer_factor[1] is -1"), std::string::npos);
}

}  // namespace
}  // namespace brinell::plastic
