#include "subsurface/depths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace brinell::subsurface {
namespace {

TEST(Depths, of_equal_layers_are_their_middles) {
  EXPECT_EQ(layer_depths(3, 2.0), (std::vector<double>{1.0, 3.0, 5.0}));
}

TEST(Depths, listed_may_begin_at_the_surface) {
  EXPECT_NO_THROW(check_depths(std::vector<double>{0.0, 1e-9, 4.0}));
}

void expect_refused(const std::vector<double>& depths, const std::string& part) {
  try {
    check_depths(depths);
    FAIL() << "accepted; expected: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Depths, that_make_no_sense_are_named) {
  expect_refused({}, "at least one");
  expect_refused({0.0, -1e-6}, "depths[1] = -1e-06");
  expect_refused({std::nan("")}, "depths[0] = nan");
  expect_refused({0.0, std::numeric_limits<double>::infinity()}, "depths[1] = inf");
  expect_refused({1.0, 2.0, 2.0}, "depths[2] = 2: must be greater than the depth before it, 2");
  EXPECT_THROW(layer_depths(0, 1.0), Error);
  EXPECT_THROW(layer_depths(2, -1.0), Error);
  EXPECT_THROW(layer_depths(2, std::nan("")), Error);
}

}  // namespace
}  // namespace brinell::subsurface
