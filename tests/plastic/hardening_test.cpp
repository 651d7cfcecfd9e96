#include "plastic/hardening.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "plastic/return_case.h"

namespace brinell::plastic {
namespace {

TEST(Hardening, follows_its_formula) {
  for (const auto& [name, law] : laws()) {
    const YieldCurve curve({law, {}});
    double last = 0;
    for (const double p :
         {0.0, 1e-280, 1e-200, 1e-30, 1e-12, 1e-9, 5e-9, 1e-6, 1e-4, 2e-3, 0.01, 0.03, 0.1, 0.29, 1.0, 7.0}) {
      const double found = curve.yield_stress(p), expected = static_cast<double>(support::yield_of(law, p));
      // The argument of the exponential, up to ln(1e300), is rounded.
      if (p > 0 || expected > 0) {
        EXPECT_NEAR(found, expected, 3e-13 * expected + 1e-30) << name << " at " << p;
      }
      EXPECT_GE(found, last * (1 - 4e-16)) << name << " at " << p;
      last = found;
    }
  }
}

TEST(Hardening, a_table_goes_through_its_points_and_keeps_their_order) {
  const HardeningTable table{{0, 1e-4, 1e-3, 0.01, 0.05, 0.3}, {300e6, 420e6, 500e6, 500e6, 700e6, 810e6}};
  const YieldCurve curve({table, {}});
  for (std::size_t k = 0; k < table.stress.size(); ++k) {
    EXPECT_EQ(curve.yield_stress(table.plastic_strain[k]), table.stress[k]);
  }
  double last = 0;
  for (double p = 0; p < 0.4; p += 1e-5) {
    const double now = curve.yield_stress(p);
    EXPECT_GE(now, last * (1 - 4e-16)) << p;
    last = now;
  }
  EXPECT_EQ(curve.yield_stress(0.005), 500e6);  // flat between equal stresses
  EXPECT_EQ(curve.yield_stress(3), 810e6);
}

TEST(Hardening, the_factor_is_linear_between_depths_and_constant_beyond) {
  const YieldCurve curve({PerfectPlasticity{1e8}, {{1e-6, 2.0}, {3e-6, 1.0}, {4e-6, 1.5}}});
  EXPECT_EQ(curve.factor_at(0), 2.0);
  EXPECT_EQ(curve.factor_at(1e-6), 2.0);
  EXPECT_NEAR(curve.factor_at(2e-6), 1.5, 1e-15);
  EXPECT_EQ(curve.factor_at(3e-6), 1.0);
  EXPECT_NEAR(curve.factor_at(3.5e-6), 1.25, 1e-15);
  EXPECT_EQ(curve.factor_at(1.0), 1.5);
  EXPECT_EQ(YieldCurve({PerfectPlasticity{1e8}, {}}).factor_at(5), 1.0);
}

void expect_refused(const Hardening& hardening, const std::string& name, const std::string& value) {
  try {
    check(hardening);
    ADD_FAILURE() << name << " = " << value << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    EXPECT_EQ(std::string(error.what()).find(name + " is " + value + "; it must be "), 0) << error.what();
  }
}

TEST(Hardening, what_is_no_law_is_refused_by_name) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  expect_refused({Swift{0, 1, 0.1}, {}}, "B", "0");
  expect_refused({Swift{infinity, 1, 0.1}, {}}, "B", "inf");
  expect_refused({Swift{1, -1, 0.1}, {}}, "C", "-1");
  expect_refused({Swift{1, 1, -0.1}, {}}, "n", "-0.1");
  expect_refused({Swift{1, 1, 1.5}, {}}, "n", "1.5");
  expect_refused({Swift{1, 1, nan}, {}}, "n", "nan");
  expect_refused({Swift{1, 1, 0.5, 0}, {}}, "strain_scale", "0");
  expect_refused({LinearHardening{-5, 1}, {}}, "yield_stress", "-5");
  expect_refused({LinearHardening{5, -1}, {}}, "hardening_modulus", "-1");
  expect_refused({PerfectPlasticity{nan}, {}}, "yield_stress", "nan");
  expect_refused({Voce{0, 2, 1}, {}}, "yield_stress", "0");
  expect_refused({Voce{3, 2, 1}, {}}, "saturation_stress", "2");
  expect_refused({Voce{1, 2, 0}, {}}, "rate", "0");
  expect_refused({RambergOsgood{0, 5, 0}, {}}, "K", "0");
  expect_refused({RambergOsgood{1, 0.5, 0}, {}}, "m", "0.5");
  expect_refused({RambergOsgood{1, 5, -1}, {}}, "yield_stress", "-1");
  expect_refused({HardeningTable{{0.1, 1}, {1, 2}}, {}}, "plastic_strain[0]", "0.1");
  expect_refused({HardeningTable{{0, 1, 1}, {1, 2, 3}}, {}}, "plastic_strain[2]", "1");
  expect_refused({HardeningTable{{0, 1}, {0, 2}}, {}}, "stress[0]", "0");
  expect_refused({HardeningTable{{0, 1}, {3, 2}}, {}}, "stress[1]", "2");
  expect_refused({PerfectPlasticity{1}, {{0, 1}, {0, 1}}}, "depth_factor[1]: depth", "0");
  expect_refused({PerfectPlasticity{1}, {{-1, 1}}}, "depth_factor[0]: depth", "-1");
  expect_refused({PerfectPlasticity{1}, {{0, 0}}}, "depth_factor[0]: factor", "0");
  EXPECT_THROW(check({HardeningTable{{}, {}}, {}}), Error);
  EXPECT_THROW(check({HardeningTable{{0, 1}, {1}}, {}}), Error);
}

}  // namespace
}  // namespace brinell::plastic
