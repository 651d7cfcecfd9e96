#include "surface/height_map.h"

#include <cmath>
#include <limits>

#include "surface_testing.h"

namespace brinell::surface {
namespace {

std::vector<double> pattern(std::int64_t nx, std::int64_t ny) {
  std::vector<double> values(static_cast<std::size_t>(nx * ny));
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = 1e-6 * std::sin(0.7 * static_cast<double>(k * k % 1001));
  return values;
}

TEST(HeightMap, a_peak_reduces_the_gap) {
  const std::vector<double> heights = {1, 2, 3, 4, 5, 6};
  std::vector<double> gap(6, 10.0);
  add_to_gap(HeightMap::contiguous(heights.data(), 3, 2), Detrend::none, {3, 2, 1, 1}, gap, parallel::Arena(1));
  EXPECT_EQ(gap, (std::vector<double>{9, 8, 7, 6, 5, 4}));
}

TEST(HeightMap, strides_mirror_transpose_and_skip) {
  const std::vector<double> heights = {1, 2, 3, 4, 5, 6};
  const parallel::Arena arena(1);
  const auto gap_of = [&](const HeightMap& map) {
    std::vector<double> gap(static_cast<std::size_t>(map.nx * map.ny));
    add_to_gap(map, Detrend::none, {map.nx, map.ny, 1, 1}, gap, arena);
    return gap;
  };
  EXPECT_EQ(gap_of({heights.data() + 2, 3, 2, -1, 3}), (std::vector<double>{-3, -2, -1, -6, -5, -4}));
  EXPECT_EQ(gap_of({heights.data() + 3, 3, 2, 1, -3}), (std::vector<double>{-4, -5, -6, -1, -2, -3}));
  EXPECT_EQ(gap_of({heights.data(), 2, 3, 3, 1}), (std::vector<double>{-1, -4, -2, -5, -3, -6}));
  EXPECT_EQ(gap_of({heights.data(), 2, 2, 2, 3}), (std::vector<double>{-1, -3, -4, -6}));
}

TEST(HeightMap, detrending_takes_out_mean_and_plane) {
  const parallel::Arena arena(1);
  for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 7}, {8, 1}, {2, 2}, {13, 9}, {128, 300}}) {
    const auto wanted = pattern(nx, ny);
    const HeightMap map = HeightMap::contiguous(wanted.data(), nx, ny);
    const double mean = trend_of(map, Detrend::mean, arena).level;
    double sum = 0;
    for (const double value : wanted) sum += value - mean;
    EXPECT_NEAR(sum / (nx * ny), 0, 1e-21);  // roundings of 1e-6

    // A plane many times as high as the pattern changes the trend by that plane and the residue by roundings of it.
    auto tilted = wanted;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) tilted[j * nx + i] += 3e-5 + 2e-7 * (2 * i - (nx - 1)) - 5e-7 * (2 * j - (ny - 1));
    }
    const HeightMap tilted_map = HeightMap::contiguous(tilted.data(), nx, ny);
    const Trend before = trend_of(map, Detrend::plane, arena);
    const Trend after = trend_of(tilted_map, Detrend::plane, arena);
    const double rounding = 4e-16 * (3e-5 + 2e-7 * nx + 5e-7 * ny);
    for (const int j : {0, ny - 1}) {
      for (const int i : {0, nx - 1}) {
        EXPECT_NEAR(tilted_map.at(i, j) - after.at(i, j, nx, ny), map.at(i, j) - before.at(i, j, nx, ny), rounding);
      }
    }
  }
}

TEST(HeightMap, a_plane_detrends_to_nothing) {
  const int nx = 650;
  const int ny = 431;
  std::vector<double> heights(static_cast<std::size_t>(nx) * ny);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) heights[j * nx + i] = 1e-3 + 1e-6 * i - 3e-6 * j;
  }
  std::vector<double> gap(heights.size());
  const parallel::Arena arena(2);
  add_to_gap(HeightMap::contiguous(heights.data(), nx, ny), Detrend::plane, {nx, ny, 1e-6, 1e-6}, gap, arena);
  for (const double value : gap) EXPECT_NEAR(value, 0, 3 * 2.3e-16 * 2e-3);  // three roundings at 2e-3
}

TEST(HeightMap, a_flat_map_detrends_to_exact_zeros) {
  const std::vector<double> heights(35, 0.1);
  for (const Detrend detrend : {Detrend::mean, Detrend::plane}) {
    std::vector<double> gap(35);
    add_to_gap(HeightMap::contiguous(heights.data(), 7, 5), detrend, {7, 5, 1, 1}, gap, parallel::Arena(1));
    for (const double value : gap) EXPECT_EQ(value, 0.0);
  }
}

TEST(HeightMap, has_the_same_bits_for_any_number_of_threads) {
  const auto heights = pattern(333, 301);
  for (const Detrend detrend : {Detrend::none, Detrend::mean, Detrend::plane}) {
    expect_same_bits_for_any_threads([&](const parallel::Arena& arena) {
      std::vector<double> gap(heights.size(), 1e-6);
      add_to_gap(HeightMap::contiguous(heights.data(), 333, 301), detrend, {333, 301, 1, 1}, gap, arena);
      return gap;
    });
  }
}

TEST(HeightMap, refuses_heights_that_are_not_finite_with_the_first_index) {
  auto heights = pattern(300, 200);
  heights[150 * 300 + 17] = -std::numeric_limits<double>::infinity();
  heights[180 * 300 + 2] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> untouched(heights.size(), 1.0);
  for (const int threads : {1, 3}) {
    const parallel::Arena arena(threads);
    std::vector<double> gap = untouched;
    expect_refused(
        [&] {
          add_to_gap(HeightMap::contiguous(heights.data(), 300, 200), Detrend::none, {300, 200, 1, 1}, gap, arena);
        },
        {"(17, 150)", "-inf", "finite"});
    EXPECT_EQ(gap, untouched);
  }
}

TEST(HeightMap, refuses_what_does_not_fit) {
  const parallel::Arena arena(1);
  const std::vector<double> heights(6);
  std::vector<double> gap(6);
  const auto add = [&](const HeightMap& map, const Grid& grid, Detrend detrend = Detrend::none) {
    return [&, map, grid, detrend] { add_to_gap(map, detrend, grid, gap, arena); };
  };
  expect_refused(add(HeightMap::contiguous(heights.data(), 2, 3), {3, 2, 1, 1}), {"2 x 3", "3 x 2"});
  expect_refused(add(HeightMap::contiguous(nullptr, 3, 2), {3, 2, 1, 1}), {"null"});
  expect_refused(add(HeightMap::contiguous(heights.data(), 3, 1), {3, 1, 1, 1}), {"6", "3"});
  expect_refused(add(HeightMap::contiguous(heights.data(), 3, 2), {3, 2, 1, 1}, static_cast<Detrend>(9)), {"9"});
  expect_refused([&] { trend_of(HeightMap::contiguous(heights.data(), 0, 2), Detrend::mean, arena); }, {"0 x 2"});
}

}  // namespace
}  // namespace brinell::surface
