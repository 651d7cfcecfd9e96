#include "plastic/eigenstrain_response.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "influence/eigenstrain.h"
#include "plastic/strain_case.h"

namespace brinell::plastic {
namespace {

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Every cuboid on every other, for 2 mu = 1.
TensorField direct_sum(const Box& box, const TensorField& strain, double nu) {
  const influence::Eigenstrain cuboid(box.dx, box.dy, box.dz, nu);
  TensorField stress(box, 0);
  const auto index = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return static_cast<std::size_t>((k * box.ny + j) * box.nx + i);
  };
  for (std::int64_t k = 0; k < box.nz; ++k) {
    for (std::int64_t l = 0; l < box.nz; ++l) {
      for (std::int64_t j = 1 - box.ny; j < box.ny; ++j) {
        for (std::int64_t i = 1 - box.nx; i < box.nx; ++i) {
          const auto matrix =
              cuboid.stress(static_cast<double>(i) * box.dx, static_cast<double>(j) * box.dy,
                            (static_cast<double>(k) + 0.5) * box.dz, (static_cast<double>(l) + 0.5) * box.dz);
          for (std::int64_t y = std::max<std::int64_t>(0, j); y < std::min(box.ny, box.ny + j); ++y) {
            for (std::int64_t x = std::max<std::int64_t>(0, i); x < std::min(box.nx, box.nx + i); ++x) {
              for (std::size_t a = 0; a < 6; ++a) {
                for (std::size_t b = 0; b < 6; ++b) {
                  stress.at(a, index(x, y, k)) += matrix[a][b] * strain.at(b, index(x - i, y - j, l));
                }
              }
            }
          }
        }
      }
    }
  }
  return stress;
}

constexpr Box kBoxes[] = {
    {1, 1, 1, 1, 1, 1},      {5, 7, 3, 1, 1, 1},  {2, 1, 4, 1, 1.5, 0.5},          {1, 9, 2, 2, 1, 1},
    {13, 3, 7, 1, 0.7, 1.3}, {16, 8, 6, 1, 1, 1}, {17, 5, 11, 1e-6, 1e-6, 0.5e-6}, {33, 2, 5, 1, 1, 0.25},
};

TEST(EigenstrainResponse, is_the_direct_sum) {
  for (const Box& box : kBoxes) {
    for (const double nu : {0.3, 0.0, 0.49}) {
      if (nu != 0.3 && box.nx != 5) continue;
      const TensorField strain = random_strain(box);
      const TensorField expected = direct_sum(box, strain, nu);
      for (const simd::Isa isa : simd::supported()) {
        const TensorField found = stress_of(Engine(1, isa), box, strain, 0.5, nu);
        // Coefficients beyond 28 sides are within 1e-9 of themselves, there 1e-5 of a cuboid's own; the rest is
        // rounding: some 1e-16 of the largest sums of 1e3 terms.
        const double tolerance = 2e-13 * largest(expected.memory);
        double worst = 0;
        for (std::size_t n = 0; n < found.memory.size(); ++n) {
          worst = std::max(worst, std::abs(found.memory[n] - expected.memory[n]));
          EXPECT_NEAR(found.memory[n], expected.memory[n], tolerance)
              << simd::name(isa) << ", box " << box.nx << " x " << box.ny << " x " << box.nz << ", nu " << nu
              << ", component " << n / box.cuboids() << ", cuboid " << n % box.cuboids();
          if (HasFailure()) return;
        }
        std::printf("%s %ld x %ld x %ld nu %g: %.1e\n", std::string(simd::name(isa)).c_str(), box.nx, box.ny, box.nz,
                    nu, worst / largest(expected.memory));
      }
    }
  }
}

}  // namespace
}  // namespace brinell::plastic
