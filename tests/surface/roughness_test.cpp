#include "surface/roughness.h"

#include <cmath>
#include <limits>

#include "surface_testing.h"

namespace brinell::surface {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<double> heights_of(const Roughness& rough, const Grid& grid, Centre centre = {},
                               const parallel::Arena& arena = parallel::Arena(1)) {
  const auto heights = rough_heights(rough, centre, grid, arena);
  return {heights.begin(), heights.end()};
}

Roughness slope_of(double rms_slope, double hurst, std::uint64_t seed) {
  Roughness rough;
  rough.hurst = hurst;
  rough.rms_slope = rms_slope;
  rough.seed = seed;
  return rough;
}

// One component of the discrete spectrum, by the direct sum: |sum h·exp(−2·pi·i(kx·i/nx + ky·j/ny))| / nodes.
double amplitude_of(const std::vector<double>& heights, const Grid& grid, std::int64_t kx, std::int64_t ky) {
  double re = 0;
  double im = 0;
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      const double angle = 2 * kPi *
                           (static_cast<double>(kx * i % grid.nx) / static_cast<double>(grid.nx) +
                            static_cast<double>(ky * j % grid.ny) / static_cast<double>(grid.ny));
      re += heights[j * grid.nx + i] * std::cos(angle);
      im -= heights[j * grid.nx + i] * std::sin(angle);
    }
  }
  return std::hypot(re, im) / static_cast<double>(grid.nodes());
}

std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// The formula at the head of roughness.h as it stands there, at one point.
double direct_sum(const Roughness& rough, const Grid& grid, double x, double y) {
  const double lx = static_cast<double>(grid.nx) * grid.dx;
  const double ly = static_cast<double>(grid.ny) * grid.dy;
  double sum = 0;
  double mean_square = 0;
  for (std::int64_t ky = 0; 2 * ky < grid.ny; ++ky) {
    for (std::int64_t kx = -(grid.nx - 1) / 2; 2 * kx < grid.nx; ++kx) {
      if (ky == 0 && kx <= 0) continue;
      const double f = std::hypot(static_cast<double>(kx) / lx, static_cast<double>(ky) / ly);
      if (f * rough.long_cutoff < 1 - 1e-9 || f * rough.short_cutoff > 1 + 1e-9) continue;
      const double a = std::pow(std::max(1.0, f * rough.rolloff), -(1 + rough.hurst));
      const auto bits = mix(mix(mix(rough.seed) ^ static_cast<std::uint64_t>(kx)) ^ static_cast<std::uint64_t>(ky));
      const double u = static_cast<double>(bits >> 11) / 9007199254740992.0;
      sum += a * std::cos(2 * kPi * (static_cast<double>(kx) * x / lx + static_cast<double>(ky) * y / ly + u));
      mean_square += 0.5 * a * a * (rough.rms_height > 0 ? 1 : std::pow(2 * kPi * f, 2));
    }
  }
  return sum * (rough.rms_height > 0 ? rough.rms_height : rough.rms_slope) / std::sqrt(mean_square);
}

TEST(Roughness, is_the_documented_sum_of_waves) {
  for (const Grid grid : {Grid{12, 10, 1e-6, 1e-6}, Grid{7, 11, 1e-6, 2e-6}, Grid{1, 16, 1e-6, 1e-6},
                          Grid{17, 1, 1e-6, 1e-6}, Grid{16, 2, 1e-6, 3e-6}}) {
    for (const double offset : {0.0, 2.7e-6}) {
      const Roughness rough = checked(slope_of(0.1, 0.7, 42), grid);
      const auto heights = heights_of(rough, grid, {offset, -offset});
      for (std::int64_t j = 0; j < grid.ny; ++j) {
        for (std::int64_t i = 0; i < grid.nx; ++i) {
          // Up to 60 waves of total amplitude below 3e-6, each with a phase rounded at a few turns.
          EXPECT_NEAR(heights[j * grid.nx + i], direct_sum(rough, grid, grid.x(i) - offset, grid.y(j) + offset),
                      1e-19);
        }
      }
    }
  }
}

TEST(Roughness, has_exactly_the_height_and_slope_asked_for) {
  const Grid grid{90, 77, 1e-6, 1.5e-6};
  Roughness rough = slope_of(0, 0.6, 3);
  rough.rms_height = 2e-7;
  rough.rolloff = 40e-6;
  rough.short_cutoff = 5e-6;
  const auto heights = heights_of(rough, grid);
  double square = 0;
  double mean = 0;
  for (const double height : heights) {
    square += height * height;
    mean += height;
  }
  const auto nodes = static_cast<double>(grid.nodes());
  EXPECT_NEAR(std::sqrt(square / nodes), 2e-7, 1e-14 * 2e-7);
  EXPECT_NEAR(mean / nodes, 0, 1e-14 * 2e-7);

  // The slope by Parseval from the surface itself, asked for by slope: both directions of each wave count.
  rough.rms_height = 0;
  rough.rms_slope = 0.1;
  const Grid small{24, 20, 1e-6, 1.5e-6};
  rough.rolloff = 12e-6;
  const auto sloped = heights_of(rough, small);
  double slope_square = 0;
  for (std::int64_t ky = -9; ky <= 9; ++ky) {
    for (std::int64_t kx = -11; kx <= 11; ++kx) {
      const double f = std::hypot(static_cast<double>(kx) / 24e-6, static_cast<double>(ky) / 30e-6);
      slope_square += std::pow(2 * kPi * f * amplitude_of(sloped, small, (kx + 24) % 24, (ky + 20) % 20), 2);
    }
  }
  EXPECT_NEAR(std::sqrt(slope_square), 0.1, 1e-13);
}

TEST(Roughness, spectrum_has_plateau_exponent_and_cutoffs) {
  const Grid grid{64, 64, 1e-6, 1e-6};
  for (const double hurst : {0.3, 0.8, 1.0}) {
    Roughness rough = slope_of(0.1, hurst, 11);
    rough.long_cutoff = 32e-6;
    rough.rolloff = 16e-6;
    rough.short_cutoff = 4e-6;
    const auto heights = heights_of(rough, grid);
    const double plateau = amplitude_of(heights, grid, 3, 0);
    EXPECT_GT(plateau, 0);
    const double rounding = 1e-13 * plateau;
    EXPECT_NEAR(amplitude_of(heights, grid, 2, 0), plateau, rounding);  // long_cutoff itself is in
    EXPECT_NEAR(amplitude_of(heights, grid, 0, 4), plateau, rounding);
    EXPECT_NEAR(amplitude_of(heights, grid, 1, 1), 0, rounding);  // longer than long_cutoff
    EXPECT_NEAR(amplitude_of(heights, grid, 0, 17), 0, rounding);
    EXPECT_NEAR(amplitude_of(heights, grid, 12, 12), 0, rounding);
    // The density, amplitude squared, falls by 2^(−2(1 + hurst)) from f = 8/L to 16/L.
    const double a8 = amplitude_of(heights, grid, 0, 8);
    const double a16 = amplitude_of(heights, grid, 16, 0);
    EXPECT_NEAR(2 * std::log2(a16 / a8), -2 * (1 + hurst), 1e-10);
    EXPECT_NEAR(amplitude_of(heights, grid, 6, 8) / plateau, std::pow(10.0 / 4, -(1 + hurst)), 1e-12);
  }
}

TEST(Roughness, keeps_its_surface_when_the_grid_is_refined) {
  // Three times as fine: every node of the coarse grid is one of the fine grid.
  Roughness rough = slope_of(0.1, 0.8, 5);
  rough.short_cutoff = 4e-6;
  const Grid coarse{50, 34, 1e-6, 1.5e-6};
  const Grid fine{150, 102, 1e-6 / 3, 0.5e-6};
  const auto wide = heights_of(rough, coarse);
  const auto dense = heights_of(rough, fine);
  double largest = 0;
  for (const double height : wide) largest = std::max(largest, std::fabs(height));
  for (std::int64_t j = 0; j < coarse.ny; ++j) {
    for (std::int64_t i = 0; i < coarse.nx; ++i) {
      EXPECT_NEAR(dense[(3 * j + 1) * fine.nx + 3 * i + 1], wide[j * coarse.nx + i], 2e-14 * largest);
    }
  }
}

TEST(Roughness, is_periodic_and_moves_with_its_centre) {
  const Grid grid{36, 30, 1e-6, 1e-6};
  const Roughness rough = slope_of(0.1, 0.8, 9);
  const auto still = heights_of(rough, grid);
  const auto moved = heights_of(rough, grid, {5e-6, -7e-6});
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      EXPECT_NEAR(moved[j * 36 + i], still[(j + 7) % 30 * 36 + (i + 31) % 36], 1e-19);
    }
  }
}

TEST(Roughness, differs_from_seed_to_seed) {
  const Grid grid{64, 64, 1e-6, 1e-6};
  const auto one = heights_of(slope_of(0.1, 0.8, 1), grid);
  const auto two = heights_of(slope_of(0.1, 0.8, 2), grid);
  double product = 0;
  double square = 0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    product += one[k] * two[k];
    square += one[k] * one[k];
  }
  EXPECT_LT(std::fabs(product / square), 0.9);  // a few long waves dominate, so chance correlation is large
}

TEST(Roughness, adds_to_the_gap_as_heights) {
  const Grid grid{40, 20, 1e-6, 1e-6};
  const Roughness rough = slope_of(0.1, 0.8, 1);
  const auto heights = heights_of(rough, grid);
  std::vector<double> gap(grid.nodes(), 0.0);
  add_to_gap(rough, {}, grid, gap, parallel::Arena(1));
  for (std::size_t k = 0; k < gap.size(); ++k) EXPECT_EQ(gap[k], -heights[k]);
}

TEST(Roughness, has_the_same_bits_for_any_number_of_threads) {
  for (const Grid grid : {Grid{128, 96, 1e-6, 1e-6}, Grid{101, 67, 1e-6, 1e-6}, Grid{1, 300, 1e-6, 1e-6}}) {
    expect_same_bits_for_any_threads(
        [&](const parallel::Arena& arena) { return heights_of(slope_of(0.1, 0.8, 7), grid, {}, arena); });
  }
}

// The promise to users: these surfaces are the same on every machine, for good. A change of these hashes breaks it.
TEST(Roughness, has_the_pinned_bits) {
  struct Pinned {
    Grid grid;
    std::uint64_t seed;
    std::uint64_t hash;
  };
  for (const auto& [grid, seed, hash] : {
           Pinned{{256, 256, 1e-6, 1e-6}, 1, 0x28e3c987fa72d0b7ULL},
           Pinned{{256, 256, 1e-6, 1e-6}, 0xffffffffffffffffULL, 0x518e184740dac77dULL},
           Pinned{{243, 125, 1e-6, 2e-6}, 2, 0x66b19cfeb341f4faULL},
           Pinned{{67, 650, 2e-6, 1e-6}, 3, 0x9d44cd7272995617ULL},
           Pinned{{1, 64, 1e-6, 1e-6}, 4, 0x3e52d2d7c150145fULL},
       }) {
    EXPECT_EQ(hash_of(heights_of(slope_of(0.1, 0.8, seed), grid)), hash)
        << std::hex << hash_of(heights_of(slope_of(0.1, 0.8, seed), grid));
  }
  Roughness rough = slope_of(0, 0.55, 99);
  rough.rms_height = 3e-7;
  rough.long_cutoff = 100e-6;
  rough.rolloff = 50e-6;
  rough.short_cutoff = 6e-6;
  EXPECT_EQ(hash_of(heights_of(rough, {200, 150, 1e-6, 1e-6}, {1e-6, 2e-6})), 0x81c9bfa63f272080ULL)
      << std::hex << hash_of(heights_of(rough, {200, 150, 1e-6, 1e-6}, {1e-6, 2e-6}));
}

TEST(Roughness, fills_in_its_defaults) {
  const Grid grid{64, 100, 1e-6, 3e-6};
  Roughness rough = checked(slope_of(0.1, 0.8, 1), grid);
  EXPECT_DOUBLE_EQ(rough.long_cutoff, 300e-6);
  EXPECT_EQ(rough.rolloff, rough.long_cutoff);
  EXPECT_EQ(rough.short_cutoff, 6e-6);
  rough = slope_of(0.1, 0.8, 1);
  rough.rolloff = 1e-3;
  EXPECT_EQ(checked(rough, grid).long_cutoff, 1e-3);
}

TEST(Roughness, refuses_what_is_not_allowed) {
  const Grid grid{64, 64, 1e-6, 1e-6};
  const auto refused = [&](auto change, std::initializer_list<const char*> words) {
    Roughness rough = slope_of(0.1, 0.8, 1);
    change(rough);
    expect_refused([&] { heights_of(rough, grid); }, words);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](Roughness& r) { r.hurst = 0; }, {"hurst is 0", "at most 1"});
  refused([](Roughness& r) { r.hurst = 1.1; }, {"hurst is 1.1"});
  refused([&](Roughness& r) { r.hurst = nan; }, {"hurst is nan"});
  refused([](Roughness& r) { r.rms_height = 1e-6; }, {"rms_slope is 0.1", "rms_height is 1e-06", "exactly one"});
  refused([](Roughness& r) { r.rms_slope = 0; }, {"rms_slope is 0", "exactly one"});
  refused([](Roughness& r) { r.rms_slope = -1; }, {"rms_slope is -1"});
  refused([&](Roughness& r) { r.rms_height = nan; }, {"rms_height is nan"});
  refused([](Roughness& r) { r.short_cutoff = 1.9e-6; }, {"short_cutoff is 1.9e-06", "2e-06"});
  refused([](Roughness& r) { r.rolloff = 1.5e-6; }, {"rolloff is 1.5e-06", "at least short_cutoff"});
  refused([](Roughness& r) { r.long_cutoff = 1e-5, r.rolloff = 2e-5; }, {"long_cutoff is 1e-05", "2e-05"});
  refused([&](Roughness& r) { r.long_cutoff = nan; }, {"long_cutoff is nan"});
  refused([](Roughness& r) { r.long_cutoff = r.rolloff = r.short_cutoff = 1e-4; }, {"no wave"});
  expect_refused([] { heights_of(slope_of(0.1, 0.8, 1), {1, 1, 1e-6, 1e-6}); }, {"no wave"});
  expect_refused([] { heights_of(slope_of(0.1, 0.8, 1), {8, 8, 1e-6, 1e-6}, {std::nan(""), 0}); }, {"centre x"});
  std::vector<double> gap(5);
  expect_refused([&] { add_to_gap(slope_of(0.1, 0.8, 1), {}, grid, gap, parallel::Arena(1)); }, {"5", "4096"});
}

}  // namespace
}  // namespace brinell::surface
