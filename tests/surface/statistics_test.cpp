#include "surface/statistics.h"

#include <cmath>

#include "surface/roughness.h"
#include "surface_testing.h"

namespace brinell::surface {
namespace {

constexpr double kPi = 3.14159265358979323846;

HeightStatistics of(const std::vector<double>& heights, std::int64_t nx, std::int64_t ny, double dx, double dy,
                    Detrend detrend = Detrend::none, Boundary boundary = Boundary::free) {
  return height_statistics(HeightMap::contiguous(heights.data(), nx, ny), dx, dy, detrend, boundary,
                           parallel::Arena(1));
}

TEST(Statistics, of_a_wave_in_both_directions) {
  // cos·cos over whole waves: mean square 1/4, mean fourth power (3/8)², and the slope factor of first differences.
  const int n = 64;
  const double a = 2e-6;
  const double dx = 1e-6;
  const double dy = 3e-6;
  std::vector<double> heights(static_cast<std::size_t>(n) * n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i)
      heights[j * n + i] = 0.5 + a * std::cos(2 * kPi * 2 * i / n) * std::cos(2 * kPi * j / n);
  }
  const auto s = of(heights, n, n, dx, dy, Detrend::none, Boundary::periodic);
  const double rounding = 4 * 1.2e-16 / a;  // heights are rounded at 0.5
  EXPECT_NEAR(s.sq, a / 2, rounding * a);
  EXPECT_NEAR(s.ssk, 0, 10 * rounding);
  EXPECT_NEAR(s.sku, 16 * 9.0 / 64, 20 * rounding);
  EXPECT_NEAR(s.sp, a, rounding * a);
  EXPECT_NEAR(s.sv, a, rounding * a);
  EXPECT_EQ(s.sz, s.sp + s.sv);
  double mean_cosine = 0;  // of |cos| over the n samples, 32 and 64 a wave
  double mean_cosine_2 = 0;
  for (int i = 0; i < n; ++i) {
    mean_cosine += std::fabs(std::cos(2 * kPi * i / n)) / n;
    mean_cosine_2 += std::fabs(std::cos(4 * kPi * i / n)) / n;
  }
  EXPECT_NEAR(s.sa, a * mean_cosine * mean_cosine_2, rounding * a);
  const double slope_x = a / 2 * 2 * std::sin(kPi * 2 / n) / dx;
  const double slope_y = a / 2 * 2 * std::sin(kPi / n) / dy;
  EXPECT_NEAR(s.sdq, std::hypot(slope_x, slope_y), rounding);
}

TEST(Statistics, of_a_plane) {
  const int nx = 30;
  const int ny = 20;
  std::vector<double> heights(static_cast<std::size_t>(nx) * ny);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) heights[j * nx + i] = 3e-7 * i + 4e-7 * j;
  }
  const auto s = of(heights, nx, ny, 1e-6, 1e-6);
  EXPECT_NEAR(s.sdq, 0.5, 1e-14);  // differences of 4e-7 between numbers rounded at 1.6e-5: 40 roundings
  EXPECT_NEAR(s.sq * s.sq, (9e-14 * (nx * nx - 1) + 16e-14 * (ny * ny - 1)) / 12, 1e-25);
  EXPECT_NEAR(s.ssk, 0, 1e-13);
  const auto level = of(heights, nx, ny, 1e-6, 1e-6, Detrend::plane);
  EXPECT_NEAR(level.sz, 0, 3 * 2.3e-16 * 1.7e-5);
}

TEST(Statistics, by_hand) {
  // Heights about their mean 2: −2 −1 −1 4.
  const auto s = of({0, 1, 1, 6}, 4, 1, 2, 1);
  EXPECT_DOUBLE_EQ(s.sa, 2);
  EXPECT_DOUBLE_EQ(s.sq, std::sqrt(22.0 / 4));
  EXPECT_DOUBLE_EQ(s.ssk, (-8 - 1 - 1 + 64) / 4.0 / std::pow(5.5, 1.5));
  EXPECT_DOUBLE_EQ(s.sku, (16 + 1 + 1 + 256) / 4.0 / (5.5 * 5.5));
  EXPECT_DOUBLE_EQ(s.sp, 4);
  EXPECT_DOUBLE_EQ(s.sv, 2);
  EXPECT_DOUBLE_EQ(s.sz, 6);
  EXPECT_DOUBLE_EQ(s.sdq, std::sqrt((1 + 0 + 25) / 3.0) / 2);
  EXPECT_DOUBLE_EQ(of({0, 1, 1, 6}, 4, 1, 2, 1, Detrend::none, Boundary::periodic).sdq,
                   std::sqrt((1 + 0 + 25 + 36) / 4.0) / 2);
  EXPECT_DOUBLE_EQ(of({0, 1, 1, 6}, 1, 4, 1, 2).sdq, s.sdq);
}

TEST(Statistics, of_flat_and_single_nodes_are_zero) {
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 5}, {9, 6}}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      const auto s =
          of(std::vector<double>(static_cast<std::size_t>(nx * ny), 0.1), nx, ny, 1, 1, Detrend::none, boundary);
      for (const double value : {s.sa, s.sq, s.ssk, s.sku, s.sp, s.sv, s.sz, s.sdq}) {
        EXPECT_EQ(value, 0);
        EXPECT_FALSE(std::signbit(value));
      }
    }
  }
}

TEST(Statistics, of_a_rough_surface_are_those_asked_for_and_gaussian) {
  // Waves up to a sixteenth of the side: about 400 correlation areas, so kurtosis spreads by sqrt(24/400) = 0.25 and
  // skewness by sqrt(6/400) = 0.12; four of them allowed.
  const Grid grid{256, 256, 1e-6, 1e-6};
  Roughness rough;
  rough.hurst = 0.8;
  rough.rms_height = 1e-6;
  rough.long_cutoff = rough.rolloff = 16e-6;
  rough.short_cutoff = 8e-6;
  const auto heights = rough_heights(rough, {}, grid, parallel::Arena(1));
  const auto s = height_statistics(HeightMap::contiguous(heights.data(), 256, 256), 1e-6, 1e-6, Detrend::none,
                                   Boundary::periodic, parallel::Arena(1));
  EXPECT_NEAR(s.sq, 1e-6, 1e-20);
  EXPECT_NEAR(s.ssk, 0, 0.5);
  EXPECT_NEAR(s.sku, 3, 1);
  EXPECT_NEAR(s.sa / s.sq, std::sqrt(2 / kPi), 0.05);
}

TEST(Statistics, have_the_same_bits_for_any_number_of_threads) {
  std::vector<double> heights(301 * 207);
  for (std::size_t k = 0; k < heights.size(); ++k) heights[k] = std::sin(static_cast<double>(k * k % 10007));
  expect_same_bits_for_any_threads([&](const parallel::Arena& arena) {
    const auto s = height_statistics(HeightMap::contiguous(heights.data(), 301, 207), 1, 2, Detrend::plane,
                                     Boundary::free, arena);
    return std::vector<double>{s.sa, s.sq, s.ssk, s.sku, s.sp, s.sv, s.sz, s.sdq};
  });
}

TEST(Statistics, refuse_bad_spacing_and_heights) {
  expect_refused([] { of({1, 2}, 2, 1, 0, 1); }, {"dx is 0"});
  expect_refused([] { of({1, 2}, 2, 1, 1, -3); }, {"dy is -3"});
  expect_refused([] { of({1, std::nan("")}, 2, 1, 1, 1); }, {"(1, 0)", "nan"});
}

}  // namespace
}  // namespace brinell::surface
