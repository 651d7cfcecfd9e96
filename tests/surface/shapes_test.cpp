#include "surface/shapes.h"

#include <cmath>
#include <limits>
#include <utility>

#include "surface_testing.h"

namespace brinell::surface {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEps = std::numeric_limits<double>::epsilon();

std::vector<double> gap_of(const Shape& shape, const Grid& grid, Centre centre = {},
                           const parallel::Arena& arena = parallel::Arena(1)) {
  std::vector<double> gap(grid.nodes());
  add_to_gap(shape, centre, grid, gap, arena);
  return gap;
}

// The gap at one point: a grid of one node, whose own centre is the origin.
double gap_at(const Shape& shape, double x, double y) {
  return gap_of(shape, {1, 1, 1.0, 1.0}, {-x, -y})[0];
}

const Shape kShapes[] = {
    Plane{},
    Sphere{1e-3},
    Sphere{1e-3, Profile::exact},
    Ellipsoid{1e-3, 5e-3},
    Ellipsoid{5e-3, 1e-3, Profile::exact},
    Cone{1.2, 0},
    Cone{0.5, 1e-4},
    FlatPunch{3e-4, 1e-3},
    FlatPunch{3e-4, 1e-4, Profile::exact},
    Roller{1e-3, 4e-4, 2e-3},
    Roller{1e-3, 4e-4, 2e-4, Profile::exact},
    Sinusoid{1e-6, 7e-4, 3e-4},
    Sinusoid{1e-6, 7e-4, 0},
};

TEST(Shapes, closed_forms_at_points) {
  const double x = 3e-4;
  const double y = -4e-4;  // at the distance 5e-4
  const double tight = 4 * kEps;
  const auto expect = [&](const Shape& shape, double height) {
    EXPECT_NEAR(gap_at(shape, x, y), height, tight * std::fabs(height)) << shape.index();
  };
  expect(Plane{}, 0);
  expect(Sphere{1e-3}, 1.25e-4);
  expect(Sphere{1e-3, Profile::exact}, 1e-3 - std::sqrt(0.75) * 1e-3);
  expect(Ellipsoid{2e-3, 8e-4}, 0.5 * (9e-8 / 2e-3 + 16e-8 / 8e-4));
  // Semi-axes sqrt(2e-3·8e-4) along x, 8e-4 along y and z.
  expect(Ellipsoid{2e-3, 8e-4, Profile::exact}, 8e-4 * (1 - std::sqrt(1 - 9e-8 / 16e-7 - 0.25)));
  expect(Cone{kPi / 6, 0}, 5e-4 * std::sqrt(3.0));
  // The sharp cone is higher than the rounded one by R(1/sin − 1), which is R here.
  expect(Cone{kPi / 6, 1e-4}, 5e-4 * std::sqrt(3.0) - 1e-4);
  expect(Cone{kPi / 6, 1e-3}, 1e-3 - std::sqrt(0.75) * 1e-3);
  expect(FlatPunch{6e-4, 1e-5}, 0);
  expect(FlatPunch{2e-4, 1e-3}, 4.5e-5);
  expect(FlatPunch{2e-4, 5e-4, Profile::exact}, 1e-4);
  expect(Roller{1e-3, 7e-4, 1e-3}, 8e-5);
  expect(Roller{1e-3, 4e-4, 1e-3}, 8e-5 + 5e-6);
  // Crown's drop 5e-4 − sqrt(25 − 9)·1e-4 = 1e-4: local radius 9e-4.
  expect(Roller{1e-3, 0, 5e-4, Profile::exact}, 1e-3 - std::sqrt(81.0 - 16.0) * 1e-4);
  expect(Sinusoid{2e-6, 1.2e-3, 1.6e-3}, 2e-6);   // both a quarter of a wave from the crest
  expect(Sinusoid{2e-6, 6e-4, kInfinity}, 4e-6);  // valley
  expect(Sinusoid{2e-6, 0, 2.4e-3}, 2e-6 * (1 - std::cos(2 * kPi / 6)));
}

TEST(Shapes, are_zero_at_the_apex_and_never_negative) {
  for (const Shape& shape : kShapes) {
    EXPECT_EQ(gap_at(shape, 0, 0), 0) << shape.index();
    for (const double value : gap_of(shape, {31, 30, 1e-4, 1e-4})) EXPECT_GE(value, 0) << shape.index();
  }
}

TEST(Shapes, grow_outwards_and_stay_finite_beyond_the_solid) {
  for (const Shape& shape : kShapes) {
    if (std::holds_alternative<Sinusoid>(shape)) continue;
    for (const double angle : {0.0, 0.4, 0.9, kPi / 2}) {
      double before = 0;
      for (double r = 1e-6; r < 1e3; r *= 1.05) {
        const double height = gap_at(shape, r * std::cos(angle), r * std::sin(angle));
        EXPECT_TRUE(std::isfinite(height)) << shape.index() << " at " << r;
        EXPECT_GE(height, before) << shape.index() << " at " << r;
        before = height;
      }
    }
  }
}

// The steepest rise over a step is that of an arc just inside its end, sqrt(2·R·step) for the largest R of 5e-3; arcs
// end at heights R between 1e-4 and 5e-3, so that any other continuation would jump by more.
TEST(Shapes, are_continuous) {
  const double step = 1e-7;
  const double bound = 1.01 * std::sqrt(2 * 5e-3 * step);
  for (const Shape& shape : kShapes) {
    for (const auto& [grid, centre] : {std::pair{Grid{120001, 1, step, 1}, Centre{0, 0}},
                                       {Grid{120001, 1, step, 1}, Centre{0, 2e-4}},
                                       {Grid{1, 120001, 1, step}, Centre{0, 0}},
                                       {Grid{1, 120001, 1, step}, Centre{4e-4, 0}}}) {
      const auto gap = gap_of(shape, grid, centre);
      for (std::size_t k = 1; k < gap.size(); ++k) {
        ASSERT_LE(std::fabs(gap[k] - gap[k - 1]), bound) << shape.index() << " at " << k;
      }
    }
  }
}

TEST(Shapes, edges_begin_tangentially) {
  const auto slope_x = [](const Shape& shape, double x, double step) {
    return (gap_at(shape, x + step, 0) - gap_at(shape, x, 0)) / step;
  };
  const double step = 1e-9;
  // The slope changes by step/radius of the arc on either side; differences round by 1e-19/1e-9.
  for (const Profile profile : {Profile::parabolic, Profile::exact}) {
    const FlatPunch punch{3e-4, 1e-3, profile};
    EXPECT_EQ(slope_x(punch, 3e-4, -step), 0);
    EXPECT_NEAR(slope_x(punch, 3e-4, step), 0, step / 1e-3);
    const Roller roller{1e-3, 6e-4, 1e-3, profile};
    EXPECT_EQ(slope_x(roller, 3e-4, -step), 0);
    EXPECT_NEAR(slope_x(roller, 3e-4, step), 0, step / 1e-3);
  }
  for (const double half_angle : {0.3, 0.9, 1.4}) {
    const Cone cone{half_angle, 1e-3};
    const double edge = 1e-3 * std::cos(half_angle);
    const double slope = 1 / std::tan(half_angle);
    const double curvature = 1 / (1e-3 * std::pow(std::sin(half_angle), 3));
    EXPECT_NEAR(slope_x(cone, edge, step), slope, 1e-9);
    EXPECT_NEAR(slope_x(cone, edge, -step), slope, step * curvature + 1e-9);
  }
}

TEST(Shapes, exact_profiles_follow_their_series_where_they_are_flat) {
  // R − sqrt(R² − r²) = r²/2R · (1 + r²/4R² + …): for r/R = 1e-5 the next term is below 1e-20, and the plain formula
  // would have lost ten digits.
  const double r = 1e-8;
  const double series = 0.5 * r * r / 1e-3 * (1 + 0.25e-10);
  EXPECT_NEAR(gap_at(Sphere{1e-3, Profile::exact}, r, 0), series, 4 * kEps * series);
  EXPECT_NEAR(gap_at(Ellipsoid{1e-3, 1e-3, Profile::exact}, 0, r), series, 4 * kEps * series);
  EXPECT_NEAR(gap_at(Cone{0.3, 1e-3}, r, 0), series, 4 * kEps * series);
  EXPECT_NEAR(gap_at(Roller{1e-3, 1, 1, Profile::exact}, 0, r), series, 4 * kEps * series);
  EXPECT_NEAR(gap_at(FlatPunch{0, 1e-3, Profile::exact}, r, 0), series, 4 * kEps * series);
  const double wave = 1e-6 * 0.5 * std::pow(2 * kPi * 1e-5, 2) * (1 - std::pow(2 * kPi * 1e-5, 2) / 12);
  EXPECT_NEAR(gap_at(Sinusoid{1e-6, 1e-3, 0}, r, 0), wave, 8 * kEps * wave);
}

TEST(Shapes, special_cases_of_one_another_agree) {
  for (const double x : {0.0, 1e-4, 9e-4, 2e-3}) {
    for (const Profile profile : {Profile::parabolic, Profile::exact}) {
      EXPECT_EQ(gap_at(Sphere{1e-3, profile}, x, 3e-4), gap_at(Ellipsoid{1e-3, 1e-3, profile}, x, 3e-4));
      EXPECT_EQ(gap_at(Ellipsoid{kInfinity, 1e-3, profile}, x, 3e-4), gap_at(Sphere{1e-3, profile}, 0, 3e-4));
      EXPECT_EQ(gap_at(Ellipsoid{kInfinity, kInfinity, profile}, x, 3e-4), 0);
    }
    EXPECT_EQ(gap_at(Roller{1e-3, 0, 5e-3}, x, 3e-4), gap_at(Ellipsoid{5e-3, 1e-3}, x, 3e-4));
  }
}

TEST(Shapes, are_symmetric_to_the_bit) {
  for (const Shape& shape : kShapes) {
    for (const Grid grid : {Grid{24, 17, 1.1e-4, 0.9e-4}, Grid{17, 24, 0.7e-4, 1.3e-4}}) {
      const auto gap = gap_of(shape, grid);
      for (std::int64_t j = 0; j < grid.ny; ++j) {
        for (std::int64_t i = 0; i < grid.nx; ++i) {
          const double here = gap[j * grid.nx + i];
          EXPECT_EQ(here, gap[j * grid.nx + grid.nx - 1 - i]);
          EXPECT_EQ(here, gap[(grid.ny - 1 - j) * grid.nx + i]);
        }
      }
    }
  }
}

TEST(Shapes, move_with_their_centre_and_add_up) {
  const Grid grid{21, 13, 0x1p-13, 0x1p-14};  // spacings that round nothing
  for (const Shape& shape : kShapes) {
    const auto still = gap_of(shape, grid);
    const auto moved = gap_of(shape, grid, {3 * grid.dx, -2 * grid.dy});
    for (std::int64_t j = 0; j + 2 < grid.ny; ++j) {
      for (std::int64_t i = 3; i < grid.nx; ++i) {
        EXPECT_EQ(moved[j * grid.nx + i], still[(j + 2) * grid.nx + i - 3]) << shape.index();
      }
    }
    auto twice = still;
    add_to_gap(shape, {}, grid, twice, parallel::Arena(1));
    for (std::size_t k = 0; k < twice.size(); ++k) EXPECT_EQ(twice[k], 2 * still[k]);
  }
}

TEST(Shapes, come_back_on_the_other_side_of_a_periodic_boundary) {
  const Grid grid{12, 10, 0x1p-13, 0x1p-14};  // spacings that round nothing
  for (const Shape& shape : kShapes) {
    const auto still = gap_of(shape, grid);
    for (const auto& [by_i, by_j] : {std::pair{0, 0}, std::pair{3, 4}, std::pair{-5, 13}, std::pair{24, -1}}) {
      std::vector<double> moved(grid.nodes());
      add_to_gap(shape, {by_i * grid.dx, by_j * grid.dy}, grid, moved, parallel::Arena(1), Boundary::periodic);
      for (std::int64_t j = 0; j < grid.ny; ++j) {
        for (std::int64_t i = 0; i < grid.nx; ++i) {
          const std::int64_t to_i = (i + by_i + 10 * grid.nx) % grid.nx, to_j = (j + by_j + 10 * grid.ny) % grid.ny;
          EXPECT_EQ(moved[to_j * grid.nx + to_i], still[j * grid.nx + i]) << shape.index();
        }
      }
    }
  }
}

TEST(Shapes, have_the_same_bits_for_any_number_of_threads) {
  const Grid grid{301, 257, 1e-5, 1e-5};
  for (const Shape& shape : kShapes) {
    expect_same_bits_for_any_threads([&](const parallel::Arena& arena) { return gap_of(shape, grid, {}, arena); });
  }
}

TEST(Shapes, refuse_parameters_that_describe_no_shape) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const Shape& shape, std::initializer_list<const char*> words) {
    expect_refused([&] { check(shape); }, words);
    expect_refused([&] { gap_at(shape, 0, 0); }, words);
  };
  refused(Sphere{0}, {"sphere: radius is 0", "positive"});
  refused(Sphere{-1}, {"sphere: radius is -1"});
  refused(Sphere{kInfinity}, {"sphere: radius is inf"});
  refused(Sphere{1, static_cast<Profile>(7)}, {"sphere: profile is 7"});
  refused(Ellipsoid{nan, 1}, {"radius_x is nan"});
  refused(Ellipsoid{1, -2}, {"radius_y is -2"});
  refused(Cone{0, 0}, {"half_angle is 0", "pi/2"});
  refused(Cone{1.6, 0}, {"half_angle is 1.6"});
  refused(Cone{1, -1}, {"tip_radius is -1"});
  refused(FlatPunch{-1, 1}, {"flat_punch: radius is -1"});
  refused(FlatPunch{1, 0}, {"edge_radius is 0"});
  refused(Roller{0, 1, 1}, {"roller: radius is 0"});
  refused(Roller{1, nan, 1}, {"straight_length is nan"});
  refused(Roller{1, 1, 0}, {"crown_radius is 0"});
  refused(Sinusoid{-1, 1, 1}, {"amplitude is -1"});
  refused(Sinusoid{1, -1, 1}, {"wavelength_x is -1"});
  refused(Sinusoid{1, 1, nan}, {"wavelength_y is nan"});
}

TEST(Shapes, refuse_grids_and_gaps_that_do_not_fit) {
  const parallel::Arena arena(1);
  std::vector<double> gap(6);
  const auto add = [&](const Grid& grid, Centre centre = {}) {
    return [&arena, &gap, grid, centre] { add_to_gap(Sphere{1}, centre, grid, gap, arena); };
  };
  EXPECT_NO_THROW(add({3, 2, 1, 1})());
  expect_refused(add({3, 3, 1, 1}), {"6", "9"});
  expect_refused(add({0, 2, 1, 1}), {"nx = 0"});
  expect_refused(add({3, 2, 0, 1}), {"dx is 0"});
  expect_refused(add({3, 2, 1, -1}), {"dy is -1"});
  expect_refused(add({3, 2, 1, 1}, {kInfinity, 0}), {"centre x", "inf"});
}

}  // namespace
}  // namespace brinell::surface
