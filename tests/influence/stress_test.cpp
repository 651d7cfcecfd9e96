#include "influence/stress.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "base/error.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "support/stress_quadrature.h"

namespace brinell::influence {
namespace {

struct Reference {
  int traction;
  std::int64_t i, j;
  double depth, dx, dy, nu;
  std::array<double, 6> stress;
};

constexpr Reference kReferences[] = {
#include "stress_reference.inl"
};

constexpr Traction kTractions[] = {Traction::pressure, Traction::shear_x, Traction::shear_y};
constexpr int kXx = 0, kYy = 1, kZz = 2, kYz = 3, kXz = 4, kXy = 5;

template <class Reference>
double largest(const Reference& stress) {
  double most = 0;
  for (const auto component : stress) most = std::max(most, static_cast<double>(std::abs(component)));
  return most;
}

// All six components, one grid after the other.
std::vector<double> filled(const Stress& stress, Traction traction, std::int64_t nx, std::int64_t ny, simd::Isa isa,
                           int threads = 1) {
  std::vector<double> memory(static_cast<std::size_t>(6 * nx * ny), std::numeric_limits<double>::quiet_NaN());
  std::array<double*, 6> targets{};
  for (int c = 0; c < 6; ++c) targets[c] = memory.data() + c * nx * ny;
  stress.fill(parallel::Arena(threads), simd::kernels(isa), traction, nx, ny, targets);
  return memory;
}

TEST(Stress, agrees_with_the_reference_table) {
  for (const Reference& at : kReferences) {
    const auto stress = Stress(at.dx, at.dy, at.depth, at.nu)(static_cast<Traction>(at.traction), at.i, at.j);
    for (int c = 0; c < 6; ++c) {
      EXPECT_NEAR(stress[c], at.stress[c], 1e-12 * largest(at.stress))
          << "traction " << at.traction << " at " << at.i << ", " << at.j << ", depth " << at.depth << ", component "
          << c;
    }
  }
}

// The engine's promise is 1e-10 of the largest component at the point, for cells up to 1:10. Longer cells keep the
// closed form's absolute error, a few roundings of the tractions.
TEST(Stress, agrees_with_quadrature_of_the_point_forces_at_random_points) {
  const reference::StressQuadrature quadrature;
  std::mt19937_64 generator(7);
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  for (const double dy : {1.0, 0.6, 0.1, 10.0, 1e-3}) {
    for (const double nu : {0.0, 0.3, 0.4999}) {
      for (const double reach : {5.0, 50.0, 1000.0}) {
        for (int draw = 0; draw < 12; ++draw) {
          const double longer = std::max(1.0, dy), shorter = std::min(1.0, dy);
          const double angle = draw % 4 == 0 ? 0.0 : uniform() * std::numbers::pi / 2,
                       away = uniform() * reach * longer;
          const auto i = static_cast<std::int64_t>(away * std::cos(angle));
          const auto j = static_cast<std::int64_t>(away * std::sin(angle) / dy);
          const double depth = 0.01 * shorter * std::pow(100 * reach, uniform());
          const Stress stress(1, dy, depth, nu);
          for (const Traction traction : kTractions) {
            const auto expected = quadrature(static_cast<int>(traction), static_cast<long double>(i),
                                             static_cast<long double>(j) * dy, depth, 0.5L, dy * 0.5L, nu);
            const auto found = stress(traction, i, j);
            const double tolerance = 1e-10 * largest(expected) + (shorter < 0.1 * longer ? 1e-15 : 0.0);
            for (int c = 0; c < 6; ++c) {
              EXPECT_NEAR(found[c], static_cast<double>(expected[c]), tolerance)
                  << "cell 1 x " << dy << ", nu " << nu << " at " << i << ", " << j << ", depth " << depth
                  << ", component " << c;
            }
          }
        }
      }
    }
  }
}

TEST(Stress, is_the_same_at_every_instruction_set) {
  for (const double dy : {1.0, 0.125}) {
    for (const double depth : {0.0, 0.01, 0.5, 3.0, 40.0}) {
      const Stress stress(1, dy, depth, 0.3);
      for (const Traction traction : kTractions) {
        const auto baseline = filled(stress, traction, 150, 37, simd::Isa::baseline);
        for (const simd::Isa isa : simd::supported()) {
          const auto other = filled(stress, traction, 150, 37, isa);
          for (std::size_t n = 0; n < 150 * 37; ++n) {
            double most = 0;
            for (std::size_t c = 0; c < 6; ++c) most = std::max(most, std::abs(baseline[c * 150 * 37 + n]));
            for (std::size_t c = 0; c < 6; ++c) {
              // Roundings of corner terms of order one.
              EXPECT_NEAR(other[c * 150 * 37 + n], baseline[c * 150 * 37 + n], 1e-15 + 1e-13 * most)
                  << simd::name(isa) << ", " << n << ", component " << c;
            }
          }
        }
      }
    }
  }
}

TEST(Stress, at_the_surface_is_the_traction_below_the_cell_and_free_outside) {
  for (const double dy : {1.0, 0.3, 4.0}) {
    const double nu = 0.3;
    const Stress stress(1, dy, 0, nu);
    for (std::int64_t i = -9; i <= 9; i += 3) {
      for (std::int64_t j = -40; j <= 40; j += 4) {
        const double below = i == 0 && j == 0 ? -1.0 : 0.0;
        const auto p = stress(Traction::pressure, i, j), qx = stress(Traction::shear_x, i, j),
                   qy = stress(Traction::shear_y, i, j);
        EXPECT_NEAR(p[kZz], below, 1e-15);
        EXPECT_NEAR(p[kXz], 0.0, 1e-15);
        EXPECT_NEAR(p[kYz], 0.0, 1e-15);
        EXPECT_NEAR(qx[kXz], below, 1e-15);
        EXPECT_NEAR(qx[kYz], 0.0, 1e-15);
        EXPECT_NEAR(qx[kZz], 0.0, 1e-15);
        EXPECT_NEAR(qy[kYz], below, 1e-15);
        EXPECT_NEAR(qy[kXz], 0.0, 1e-15);
        EXPECT_NEAR(qy[kZz], 0.0, 1e-15);
      }
    }
    const auto centre = stress(Traction::pressure, 0, 0);
    const double m = 1 - 2 * nu;
    EXPECT_NEAR(centre[kXx], -2 * nu - 2 * m / std::numbers::pi * std::atan(dy), 1e-15);
    EXPECT_NEAR(centre[kYy], -2 * nu - 2 * m / std::numbers::pi * std::atan(1 / dy), 1e-15);
  }
}

TEST(Stress, far_away_is_that_of_a_point_force) {
  const double dx = 2e-6, dy = 1e-6, nu = 0.3;
  for (const std::int64_t i : {0, 1000, 20000}) {
    for (const std::int64_t j : {3000, -50000}) {
      const double x = static_cast<double>(i) * dx, y = static_cast<double>(j) * dy, depth = 1e-3;
      const Stress stress(dx, dy, depth, nu);
      const auto normal = reference::normal_force(x, y, depth, nu);
      const auto tangential = reference::tangential_force(x, y, depth, nu);
      const auto p = stress(Traction::pressure, i, j), q = stress(Traction::shear_x, i, j);
      const double area = dx * dy / (2 * std::numbers::pi);
      // The next term of the multipole series is smaller by (dx/r)²; its factor is below 10.
      const double tolerance = 10 * dx * dx / (x * x + y * y + depth * depth) * area;
      const double beside = largest(reference::tangential_force(y, x, depth, nu)) + largest(tangential);
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(p[c], area * static_cast<double>(normal[c]), tolerance * largest(normal));
        EXPECT_NEAR(q[c], area * static_cast<double>(tangential[c]), tolerance * beside);
      }
    }
  }
}

TEST(Stress, is_in_equilibrium) {
  // Central differences of sixth order over the grid and over depths. Their error is f⁽⁷⁾/140, for a field that
  // falls as r⁻² about 8!/140 r⁻⁶ of stress/r, in each of three terms.
  constexpr double kWeight[] = {0.75, -0.15, 1.0 / 60};
  const double depth = 30, nu = 0.3;
  const std::int64_t i = 40, j = 25;
  const double distance = std::hypot(40.0, 25.0, depth);
  for (const Traction traction : kTractions) {
    const Stress here(1, 1, depth, nu);
    std::array<double, 6> along_x{}, along_y{}, along_z{};
    for (int k = 1; k <= 3; ++k) {
      const Stress below(1, 1, depth + k, nu), above(1, 1, depth - k, nu);
      for (int c = 0; c < 6; ++c) {
        along_x[c] += kWeight[k - 1] * (here(traction, i + k, j)[c] - here(traction, i - k, j)[c]);
        along_y[c] += kWeight[k - 1] * (here(traction, i, j + k)[c] - here(traction, i, j - k)[c]);
        along_z[c] += kWeight[k - 1] * (below(traction, i, j)[c] - above(traction, i, j)[c]);
      }
    }
    const double tolerance = 1000 * std::pow(distance, -6) * largest(here(traction, i, j)) / distance;
    EXPECT_NEAR(along_x[kXx] + along_y[kXy] + along_z[kXz], 0, tolerance);
    EXPECT_NEAR(along_x[kXy] + along_y[kYy] + along_z[kYz], 0, tolerance);
    EXPECT_NEAR(along_x[kXz] + along_y[kYz] + along_z[kZz], 0, tolerance);
  }
}

TEST(Stress, of_a_cell_is_the_sum_over_its_parts) {
  for (const double depth : {0.0, 0.2, 2.0, 7.0}) {
    const Stress part(1, 0.7, depth, 0.3), whole(5, 3 * 0.7, depth, 0.3);
    for (const Traction traction : kTractions) {
      for (const std::int64_t i : {0, 1, -2, 5}) {
        for (const std::int64_t j : {0, 1, 3, -8}) {
          std::array<double, 6> sum{};
          for (std::int64_t k = -2; k <= 2; ++k) {
            for (std::int64_t l = -1; l <= 1; ++l) {
              const auto one = part(traction, 5 * i + k, 3 * j + l);
              for (int c = 0; c < 6; ++c) sum[c] += one[c];
            }
          }
          const auto all = whole(traction, i, j);
          for (int c = 0; c < 6; ++c) EXPECT_NEAR(all[c], sum[c], 1e-14);  // fifteen sums of order one
        }
      }
    }
  }
}

TEST(Stress, turns_with_the_axes_and_keeps_its_parities) {
  const Stress cell(1, 0.7, 0.4, 0.3), turned(0.7, 1, 0.4, 0.3);
  constexpr int kTurned[] = {kYy, kXx, kZz, kXz, kYz, kXy};
  for (const std::int64_t i : {0, 1, 4, 30}) {
    for (const std::int64_t j : {0, 2, 9}) {
      const auto px = cell(Traction::pressure, i, j), py = turned(Traction::pressure, j, i);
      const auto qx = cell(Traction::shear_x, i, j), qy = turned(Traction::shear_y, j, i);
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(px[c], py[kTurned[c]], 1e-15);
        EXPECT_NEAR(qx[c], qy[kTurned[c]], 1e-15);
      }
      for (const Traction traction : kTractions) {
        for (int c = 0; c < 6; ++c) {
          const Parities parities = stress_parities(traction, static_cast<StressComponent>(c));
          const double sign_x = parities.x == fft::Parity::odd ? -1 : 1,
                       sign_y = parities.y == fft::Parity::odd ? -1 : 1;
          const double value = cell(traction, i, j)[c];
          EXPECT_EQ(cell(traction, -i, j)[c], i == 0 ? value : sign_x * value);
          EXPECT_EQ(cell(traction, i, -j)[c], j == 0 ? value : sign_y * value);
          if ((i == 0 && sign_x < 0) || (j == 0 && sign_y < 0)) {
            EXPECT_EQ(value, 0.0);
          }
        }
      }
    }
  }
}

TEST(Stress, fills_grids_of_every_width_and_nothing_beyond) {
  const Stress stress(1, 1, 0.5, 0.3);
  for (const simd::Isa isa : simd::supported()) {
    const auto wide = filled(stress, Traction::shear_x, 40, 3, isa);
    for (std::int64_t nx = 1; nx < 40; ++nx) {
      std::vector<double> memory(static_cast<std::size_t>(3 * nx + 17), -7.0);
      std::array<double*, 6> targets{};
      targets[kXx] = memory.data() + 1;
      stress.fill(parallel::Arena(1), simd::kernels(isa), Traction::shear_x, nx, 3, targets);
      EXPECT_EQ(memory[0], -7.0);
      for (std::size_t k = 3 * nx + 1; k < memory.size(); ++k) EXPECT_EQ(memory[k], -7.0);
      for (std::int64_t j = 0; j < 3; ++j) {
        for (std::int64_t i = 0; i < nx; ++i) EXPECT_NEAR(memory[1 + j * nx + i], wide[j * 40 + i], 1e-15);
      }
    }
  }
}

TEST(Stress, of_one_component_is_the_same_as_among_all) {
  const Stress stress(1, 0.5, 0.7, 0.3);
  for (const simd::Isa isa : simd::supported()) {
    for (const Traction traction : kTractions) {
      const auto all = filled(stress, traction, 33, 20, isa);
      for (int c = 0; c < 6; ++c) {
        std::vector<double> one(33 * 20);
        std::array<double*, 6> targets{};
        targets[c] = one.data();
        stress.fill(parallel::Arena(1), simd::kernels(isa), traction, 33, 20, targets);
        for (std::size_t n = 0; n < one.size(); ++n) EXPECT_NEAR(one[n], all[c * one.size() + n], 1e-15);
      }
    }
  }
}

TEST(Stress, does_not_depend_on_the_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const simd::Isa isa = simd::supported().back();
  const Stress stress(1, 1.5, 2, 0.3);
  for (const Traction traction : kTractions) {
    const auto one = filled(stress, traction, 101, 97, isa, 1);
    for (const int threads : {2, 3, 8}) {
      const auto many = filled(stress, traction, 101, 97, isa, threads);
      EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)), 0) << threads;
    }
  }
}

TEST(Stress, refuses_what_is_no_cell_depth_or_material) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, inf, nan}) {
    EXPECT_THROW(Stress(bad, 1, 1, 0.3), Error);
    EXPECT_THROW(Stress(1, bad, 1, 0.3), Error);
  }
  for (const double bad : {-1e-9, inf, nan}) EXPECT_THROW(Stress(1, 1, bad, 0.3), Error);
  for (const double bad : {-1.0, 0.5, inf, nan}) EXPECT_THROW(Stress(1, 1, 1, bad), Error);
}

}  // namespace
}  // namespace brinell::influence
