#include "influence/eigenstrain.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "influence/eigenstrain_table.h"
#include "influence/stress.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "support/mindlin_quadrature.h"

namespace brinell::influence {
namespace {

constexpr int kXx = 0, kYy = 1, kZz = 2, kYz = 3, kXz = 4;

template <class Matrix>
double largest(const Matrix& matrix) {
  double most = 0;
  for (const auto& row : matrix) {
    for (const auto value : row) most = std::max(most, static_cast<double>(std::abs(value)));
  }
  return most;
}

struct Place {
  double x, y, z, depth;  // in sides of the cuboid along x
};

// Inside and outside, touching the surface and deep, near faces and edges, along axes and off them.
constexpr Place kPlaces[] = {
    {0, 0, 0.5, 0.5},      {0.1, -0.3, 0.9, 0.5}, {0, 0, 7.5, 7.5},       {0.45, 0.2, 3.1, 3},
    {1, 0, 0.5, 0.5},      {1, 1, 0.5, 1.5},      {-2, 1, 3.5, 0.5},      {0, 0, 0.5, 3.5},
    {0.5001, 0, 2.5, 2.5}, {5, -7, 2.5, 9.5},     {20, 3, 0.5, 0.5},      {27, 2, 4, 0.5},
    {30, 0, 0.5, 1.5},     {0, 31, 12.5, 0.5},    {-40, 25, 3.5, 20.5},   {0, 0, 0.5, 100.5},
    {3, 2, 99.5, 100.5},   {0, 0, 1000, 1000},    {1, 2, 998.5, 1000.5},  {500, -300, 0.5, 1000.5},
    {1000, 0, 1000, 0.5},  {0, 60, 0.5, 0.5},     {100, 100, 100, 100.5}, {0, 0, 1000.5, 0.5},
};

TEST(Eigenstrain, agrees_with_quadrature_of_point_forces) {
  const reference::MindlinQuadrature quadrature;
  int turn = 0;
  for (const Place& at : kPlaces) {
    const double nu = std::array{0.3, 0.0, 0.49}[turn % 3];
    const std::array<long double, 3> half =
        turn % 2 == 0 ? std::array{0.5L, 0.5L, 0.5L} : std::array{0.5L, 0.35L, 0.25L};
    ++turn;
    const Eigenstrain cuboid(2 * static_cast<double>(half[0]), 2 * static_cast<double>(half[1]),
                             2 * static_cast<double>(half[2]), nu);
    const auto expected = quadrature({at.x, at.y, at.z}, at.depth, half, nu);
    const StressOfStrain found = cuboid.stress(at.x, at.y, at.z, at.depth);
    const double scale = largest(expected.stress);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        const double error = std::abs(found[i][j] - static_cast<double>(expected.stress[i][j])) / scale;
        EXPECT_LE(error, 1e-9) << "at " << at.x << ", " << at.y << ", " << at.z << ", depth " << at.depth
                               << ": stress " << i << " of strain " << j << " is " << found[i][j] << ", not "
                               << static_cast<double>(expected.stress[i][j]);
      }
    }
    if (at.depth == static_cast<double>(half[2]) && std::hypot(at.x, at.y) < 0.5) continue;  // on a face
    const auto surface = quadrature({at.x, at.y, 0}, at.depth, half, nu);
    const std::array<double, 6> u = cuboid.displacement(at.x, at.y, at.depth);
    double most = 0;
    for (const auto value : surface.displacement) most = std::max(most, std::abs(static_cast<double>(value)));
    for (std::size_t j = 0; j < 6; ++j) {
      const double error = std::abs(u[j] - static_cast<double>(surface.displacement[j])) / most;
      EXPECT_LE(error, 1e-9) << "displacement at " << at.x << ", " << at.y << ", depth " << at.depth << " of strain "
                             << j;
    }
  }
}

TEST(Eigenstrain, leaves_the_surface_free_of_traction) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    for (const double dz : {1.0, 0.4}) {
      const Eigenstrain cuboid(1, 0.7, dz, nu);
      for (const double depth : {0.5 * dz, 0.9, 4.5, 25.5, 300.0}) {
        for (const double x : {0.0, 1.0, -3.3, 29.0, 200.0}) {
          for (const double y : {0.0, 2.1, 40.0}) {
            const StressOfStrain stress = cuboid.stress(x, y, 0, depth);
            // The two parts that cancel are as large as the whole space's stress.
            const double scale = largest(cuboid.full_space(x, y, -depth));
            for (std::size_t j = 0; j < 6; ++j) {
              for (const int c : {kZz, kYz, kXz}) {
                EXPECT_LE(std::abs(stress[static_cast<std::size_t>(c)][j]), 1e-10 * scale)
                    << "component " << c << " of strain " << j << " at " << x << ", " << y << ", depth " << depth;
              }
            }
          }
        }
      }
    }
  }
}

TEST(Eigenstrain, of_a_dilatation_follows_its_closed_form) {
  // R. D. Mindlin & D. H. Cheng, J. Appl. Phys. 21 (1950) 931-933, integrated over the cuboid: with phi the potential
  // of the cuboid and phi' that of its mirror image, unit strain and stress in 2 mu,
  //   u_z(z = 0) = (1 + nu)/pi phi,z,   mean stress = (1 + nu)²/(3 pi (1 - nu)) phi',zz - 2/3 (1 + nu)/(1 - nu)
  //   inside;
  // the whole space's part has no mean stress outside.
  struct Derivatives {
    long double z = 0, zz = 0;
  };
  const auto potential = [](long double x, long double y, long double z) {
    Derivatives sum;
    for (const int sx : {-1, 1}) {
      for (const int sy : {-1, 1}) {
        for (const int sz : {-1, 1}) {
          const long double X = x + 0.5L * sx, Y = y + 0.5L * sy, Z = z + 0.5L * sz;
          const long double R = std::sqrt(X * X + Y * Y + Z * Z), angle = std::atan(X * Y / (Z * R));
          sum.z += sx * sy * sz * (Y * std::log(R + X) + X * std::log(R + Y) - Z * angle);
          sum.zz -= sx * sy * sz * angle;
        }
      }
    }
    return sum;
  };
  const auto mean = [](const StressOfStrain& stress) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum += stress[i][j];
    }
    return sum / 3;
  };
  for (const double nu : {0.0, 0.25, 0.45}) {
    const Eigenstrain cuboid(1, 1, 1, nu);
    const double inside = -2.0 / 3 * (1 + nu) / (1 - nu);
    for (const double depth : {0.5, 0.6, 3.5, 20.5, 5000.0}) {
      for (const double x : {0.2, 2.0, 9.0}) {
        if (depth > 0.5 && depth < 1000) {  // in double the differences of logarithms cancel farther away
          const auto u = cuboid.displacement(x, 0.4, depth);
          const double expected = static_cast<double>((1 + nu) / std::numbers::pi * potential(x, 0.4L, depth).z);
          EXPECT_NEAR(u[kXx] + u[kYy] + u[kZz], expected, 1e-12 * std::abs(expected) + 1e-15);
        }
        for (const double below : {-0.3, 0.1, 0.8, 4.0}) {
          if (depth + below < 0) continue;
          const long double image = potential(x, 0.4L, 2 * depth + below).zz;
          double expected = static_cast<double>((1 + nu) * (1 + nu) / (3 * std::numbers::pi * (1 - nu)) * image);
          if (x == 0.2 && std::abs(below) < 0.5) expected += inside;
          // Nine entries of at most 1 each, good to 1e-11 or so: see agrees_with_quadrature_of_point_forces.
          EXPECT_NEAR(mean(cuboid.stress(x, 0.4, depth + below, depth)), expected, 1e-10)
              << x << ", depth " << depth << ", " << below << " below it, nu " << nu;
        }
      }
    }
  }
}

TEST(Eigenstrain, deep_below_is_that_of_the_full_space) {
  const Eigenstrain cuboid(1, 1.5, 0.8, 0.3);
  for (const Place& at : {Place{0.2, 0.1, 0.3, 0}, Place{3, -1, 2, 0}, Place{0, 8, -5, 0}}) {
    const StressOfStrain full = cuboid.full_space(at.x, at.y, at.z);
    StressOfStrain deep = cuboid.stress(at.x, at.y, 2000 + at.z, 2000);
    const bool inside = at.x == 0.2;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        double own = inside && i == j ? 1.0 : 0.0;
        if (inside && i < 3 && j < 3) own += 0.3 / 0.4;
        // The image lies 4000 sides away: of order (1/4000)³.
        EXPECT_NEAR(deep[i][j], full[i][j] - own, 20 * std::pow(4000.0, -3));
      }
    }
  }
}

TEST(Eigenstrain, is_reciprocal) {
  // Work of the strain of one cuboid in the stress of the other, to leading order at their centres; the columns of
  // shears count twice. Exact for points, so far apart: (side/distance)².
  const Eigenstrain cuboid(1, 1, 1, 0.3);
  const double x = 300, y = -200;
  const StressOfStrain there = cuboid.stress(x, y, 250.5, 100.5), back = cuboid.stress(-x, -y, 100.5, 250.5);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const double twice_i = i < 3 ? 1 : 2, twice_j = j < 3 ? 1 : 2;
      EXPECT_NEAR(twice_i * there[i][j], twice_j * back[j][i], 30 * largest(there) / (x * x));
    }
  }
}

TEST(Eigenstrain, displacement_is_reciprocal_to_the_stress_of_a_pressure) {
  // u_z at a point = ∫ sigma : strain over the cuboid for a unit force there. Averaged over a cell of the surface:
  // pressure 1 on the cell at the cuboid, each integrated by the same rule.
  const double nu = 0.3, depth = 4;
  const Eigenstrain cuboid(1, 1, 1, nu);
  constexpr double kNode[] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683, 0.906179845938664};
  constexpr double kWeight[] = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                0.236926885056189};
  for (const int i : {0, 1, -3}) {
    for (const int j : {0, 2}) {
      std::array<double, 6> work{}, displacement{};
      for (int k = 0; k < 5; ++k) {
        for (int l = 0; l < 5; ++l) {
          const double weight = kWeight[k] * kWeight[l] / 4;
          const auto u = cuboid.displacement(-i + kNode[k] / 2, -j + kNode[l] / 2, depth);
          for (std::size_t c = 0; c < 6; ++c) displacement[c] += weight * u[c];
        }
      }
      // Stress of the pressure at points of the cuboid, as cells of a finer grid: the mean over the cell is the sum
      // of parts; points of the cuboid at offsets of 1/9 are enough for the smooth field at depth 4.
      constexpr int kParts = 9;
      constexpr double kTurn[] = {1, 1, 1, 2, 2, 2};
      for (int k = 0; k < 5; ++k) {
        const Stress stress(1.0 / kParts, 1.0 / kParts, depth + kNode[k] / 2, nu);
        for (int p = 0; p < kParts; ++p) {
          for (int q = 0; q < kParts; ++q) {
            for (int r = 0; r < kParts; ++r) {
              for (int s = 0; s < kParts; ++s) {
                const auto one = stress(Traction::pressure, kParts * i + p - r, kParts * j + q - s);
                for (std::size_t c = 0; c < 6; ++c) {
                  work[c] += kTurn[c] * kWeight[k] / 2 * one[c] / (kParts * kParts);
                }
              }
            }
          }
        }
      }
      // The midpoint sums over 9 × 9 parts leave second differences: (1/9)²/24 of the curvature, below 1e-3.
      for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(displacement[c], work[c], 1e-3 * std::abs(work[kZz]));
    }
  }
}

TEST(Eigenstrain, of_a_cuboid_is_the_sum_over_its_parts) {
  const Eigenstrain part(1, 0.7, 0.5, 0.3), whole(3, 1.4, 1, 0.3);
  for (const Place& at : {Place{0.3, 0.1, 2.2, 2}, Place{4, 1, 0.6, 1}, Place{0, 33, 5, 2}, Place{80, 10, 2, 0.5}}) {
    StressOfStrain sum{};
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-0.35, 0.35}) {
        for (const double z : {-0.25, 0.25}) {
          const StressOfStrain one = part.stress(at.x - x, at.y - y, at.z, at.depth + z);
          for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = 0; j < 6; ++j) sum[i][j] += one[i][j];
          }
        }
      }
    }
    const StressOfStrain all = whole.stress(at.x, at.y, at.z, at.depth);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(all[i][j], sum[i][j], 2e-9 * largest(all) + 1e-15);
    }
  }
}

TEST(Eigenstrain, scales_with_its_lengths) {
  const Eigenstrain unit(1, 0.7, 0.5, 0.3), small(0.3e-6, 0.21e-6, 0.15e-6, 0.3);
  for (const Place& at : {Place{0.3, 0.1, 2.2, 2}, Place{4, 1, 0.6, 1}, Place{80, 10, 2, 0.5}}) {
    const StressOfStrain one = unit.stress(at.x, at.y, at.z, at.depth);
    const double s = 0.3e-6;
    const StressOfStrain other = small.stress(s * at.x, s * at.y, s * at.z, s * at.depth);
    const auto u = unit.displacement(at.x, at.y, at.depth), v = small.displacement(s * at.x, s * at.y, s * at.depth);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(v[i], s * u[i], 1e-12 * s);
      for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(other[i][j], one[i][j], 1e-12);
    }
  }
}

TEST(Eigenstrain, fills_the_same_at_every_instruction_set_with_its_parities) {
  const Eigenstrain cuboid(1, 1.25, 0.75, 0.3);
  const std::int64_t nx = 45, ny = 3;
  const auto filled = [&](simd::Isa isa, int which, double z) {
    std::vector<double> values(static_cast<std::size_t>(simd::kImagePotentials * nx * ny),
                               std::numeric_limits<double>::quiet_NaN());
    const auto& kernels = simd::kernels(isa).eigenstrain;
    if (which == 0) cuboid.fill_kelvin(kernels, z, nx, ny, values.data());
    if (which == 1) cuboid.fill_image(kernels, z, nx, ny, values.data());
    if (which == 2) cuboid.fill_displacement(kernels, z, nx, ny, values.data());
    return values;
  };
  for (const int which : {0, 1, 2}) {
    const int count = which == 0   ? simd::kKelvinPotentials
                      : which == 1 ? simd::kImagePotentials
                                   : simd::kSurfacePotentials;
    for (const double z : {0.75, 30.0}) {
      const auto baseline = filled(simd::Isa::baseline, which, z);
      for (const simd::Isa isa : simd::supported()) {
        const auto other = filled(isa, which, z);
        for (std::int64_t n = 0; n < count * nx * ny; ++n) {
          const auto at = static_cast<std::size_t>(n);
          const double distance = std::hypot(static_cast<double>(n % nx), z);
          // Sums of 27 points with alternating terms, a few roundings of the leading one.
          EXPECT_NEAR(other[at], baseline[at], 1e-13 / distance) << simd::name(isa) << ", " << n;
        }
      }
      for (int k = 0; k < count; ++k) {
        const Parities odd = which == 0 ? kelvin_parities(k) : which == 1 ? image_parities(k) : surface_parities(k);
        if (odd.x == fft::Parity::odd || odd.y == fft::Parity::odd) {
          EXPECT_EQ(baseline[static_cast<std::size_t>(k * nx * ny)], 0.0);
        }
      }
    }
  }
}

/// All layers that a box needs, by the table of potentials near the cuboid.
std::vector<double> by_table(const EigenstrainTable& table, std::int64_t nx, std::int64_t ny, std::int64_t nz) {
  const auto& kernels = simd::kernels(simd::Isa::baseline).eigenstrain;
  const auto kelvin = static_cast<std::size_t>(simd::kKelvinPotentials * nx * ny);
  const auto image = static_cast<std::size_t>(simd::kImagePotentials * nx * ny);
  std::vector<double> values(static_cast<std::size_t>(nz) * kelvin + static_cast<std::size_t>(2 * nz - 1) * image,
                             std::numeric_limits<double>::quiet_NaN());
  double* place = values.data();
  for (std::int64_t k = 0; k < nz; ++k, place += kelvin) table.fill_kelvin(kernels, k, nx, ny, place);
  for (std::int64_t k = 1; k < 2 * nz; ++k, place += image) table.fill_image(kernels, k, nx, ny, place);
  return values;
}

TEST(EigenstrainTable, has_the_potentials_of_one_cuboid) {
  const Eigenstrain cuboid(1, 1.25, 0.75, 0.3);
  const std::int64_t nx = 40, ny = 5, nz = 26;  // beyond the closed forms in x and in z
  const parallel::Arena arena(1);
  EigenstrainTable table(cuboid);
  table.cover(arena, nx, ny, nz);
  const std::vector<double> found = by_table(table, nx, ny, nz);
  std::vector<double> expected(static_cast<std::size_t>(simd::kImagePotentials * nx * ny));
  const auto& kernels = simd::kernels(simd::Isa::baseline).eigenstrain;
  const double* place = found.data();
  for (std::int64_t layer = 0; layer < 3 * nz - 1; ++layer) {
    const bool image = layer >= nz;
    const double z = static_cast<double>(image ? layer - nz + 1 : layer) * 0.75;
    if (image) cuboid.fill_image(kernels, z, nx, ny, expected.data());
    if (!image) cuboid.fill_kelvin(kernels, z, nx, ny, expected.data());
    const std::int64_t count = (image ? simd::kImagePotentials : simd::kKelvinPotentials) * nx * ny;
    for (std::int64_t n = 0; n < count; ++n, ++place) {
      // Sums of eight terms up to 40³ in long double, 5e-20 each, and one rounding to double.
      ASSERT_NEAR(*place, expected[static_cast<std::size_t>(n)],
                  3e-14 + 2e-16 * std::abs(expected[static_cast<std::size_t>(n)]))
          << layer << ", " << n;
    }
  }
}

TEST(EigenstrainTable, gives_the_same_bits_in_steps_and_for_any_number_of_threads) {
  const Eigenstrain cuboid(1, 0.8, 1.1, 0.25);
  const parallel::Arena one(1), three(3);
  EigenstrainTable at_once(cuboid), in_steps(cuboid);
  at_once.cover(one, 34, 21, 12);
  in_steps.cover(three, 5, 21, 2);
  in_steps.cover(three, 34, 8, 10);
  in_steps.cover(three, 34, 21, 12);
  in_steps.cover(three, 3, 3, 3);
  EXPECT_EQ(by_table(at_once, 34, 21, 12), by_table(in_steps, 34, 21, 12));
  EigenstrainTable small(cuboid);
  small.cover(three, 7, 6, 3);
  EXPECT_EQ(by_table(at_once, 7, 6, 3), by_table(small, 7, 6, 3));
}

TEST(Eigenstrain, refuses_what_is_no_cuboid_place_or_material) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, inf, nan}) {
    EXPECT_THROW(Eigenstrain(bad, 1, 1, 0.3), Error);
    EXPECT_THROW(Eigenstrain(1, bad, 1, 0.3), Error);
    EXPECT_THROW(Eigenstrain(1, 1, bad, 0.3), Error);
  }
  for (const double bad : {-1.0, 0.5, inf, nan}) EXPECT_THROW(Eigenstrain(1, 1, 1, bad), Error);
  const Eigenstrain cuboid(1, 1, 1, 0.3);
  EXPECT_THROW(cuboid.stress(0, 0, -0.1, 1), Error);
  EXPECT_THROW(cuboid.stress(0, 0, 0, 0.4), Error);
  EXPECT_THROW(cuboid.stress(nan, 0, 0, 1), Error);
}

}  // namespace
}  // namespace brinell::influence
