#include "influence/displacement.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::influence {
namespace {

struct Reference {
  std::int64_t i, j;
  double dx, dy;
  long double coefficient;
};

constexpr Reference kReferences[] = {
#include "displacement_reference.inl"
};

// Half a unit for each of the roundings of x, y, their squares, sum and root, the series and the product with the
// root: about 8 · 1.1e-16.
constexpr double kTolerance = 1e-15;

using Real = long double;

// ∫ dt/√(c² + t²) from o − h to o + h.
Real line_potential(Real c, Real o, Real h) {
  const Real upper = std::hypot(c, o + h), lower = std::hypot(c, o - h);
  return std::log1p(2 * h * (1 + 2 * o / (upper + lower)) / (o < h ? c * c / (lower + h - o) : lower + o - h));
}

// Love's form with its logarithms paired; in long double its error at d cells is about 5e-20·d.
Real love(const Real x, const Real y, const Real a, const Real b) {
  const auto edge = [](Real c, Real o, Real h) { return c * line_potential(std::abs(c), o, h); };
  return (edge(x + a, y, b) - edge(x - a, y, b) + edge(y + b, x, a) - edge(y - b, x, a)) / std::numbers::pi_v<Real>;
}

double relative_error(double value, Real reference) {
  return static_cast<double>(std::abs(static_cast<Real>(value) / reference - 1));
}

std::vector<double> filled(double dx, double dy, std::int64_t nx, std::int64_t ny, simd::Isa isa, int threads = 1) {
  std::vector<double> coefficients(static_cast<std::size_t>(nx * ny), std::numeric_limits<double>::quiet_NaN());
  Displacement(dx, dy).fill(parallel::Arena(threads), simd::kernels(isa), nx, ny, coefficients.data());
  return coefficients;
}

TEST(Displacement, agrees_with_50_digit_references_from_1_to_a_million_cells) {
  double worst = 0;
  for (const Reference& at : kReferences) {
    const double error = relative_error(Displacement(at.dx, at.dy)(at.i, at.j), at.coefficient);
    EXPECT_LE(error, kTolerance) << at.i << ", " << at.j << " of " << at.dx << " x " << at.dy;
    worst = std::max(worst, error);
  }
  RecordProperty("worst", text(worst));
}

TEST(Displacement, of_a_square_onto_itself_is_known) {
  const double h = 0.2e-6;
  EXPECT_LE(relative_error(Displacement(h, h)(0, 0), 4 * std::asinh(Real(1)) * h / std::numbers::pi_v<Real>),
            kTolerance);
}

TEST(Displacement, has_no_seams_between_its_forms_at_any_instruction_set) {
  struct Case {
    double dx, dy;
    std::int64_t nx, ny;
  };
  for (const Case& c : {Case{1, 1, 600, 150}, Case{0.7, 1, 30, 700}, Case{1e-6, 1e-5, 1500, 20},
                        Case{3, 0.3, 20, 1500}, Case{1e-3, 1, 1300, 18}, Case{1e-9, 1e-12, 18, 1300}}) {
    for (const simd::Isa isa : simd::supported()) {
      const auto coefficients = filled(c.dx, c.dy, c.nx, c.ny, isa);
      double worst = 0;
      for (std::int64_t j = 0; j < c.ny; ++j) {
        for (std::int64_t i = 0; i < c.nx; ++i) {
          const Real reference = love(static_cast<Real>(i) * c.dx, static_cast<Real>(j) * c.dy,
                                      static_cast<Real>(c.dx) / 2, static_cast<Real>(c.dy) / 2);
          worst = std::max(worst, relative_error(coefficients[j * c.nx + i], reference));
        }
      }
      EXPECT_LE(worst, kTolerance) << c.dx << " x " << c.dy << ", " << simd::name(isa);
    }
  }
}

TEST(Displacement, is_symmetric_and_scales_with_length) {
  const Displacement cell(0.3e-6, 0.5e-6), turned(0.5e-6, 0.3e-6), larger(0.3e-6 * 8, 0.5e-6 * 8);
  for (const std::int64_t i : {0, 1, 3, 5, 17, 300, 40000}) {
    for (const std::int64_t j : {0, 2, 4, 9, 33, 1000}) {
      EXPECT_EQ(cell(i, j), cell(-i, j));
      EXPECT_EQ(cell(i, j), cell(i, -j));
      EXPECT_EQ(8 * cell(i, j), larger(i, j));  // a power of two: to the bit
      EXPECT_LE(relative_error(turned(j, i), cell(i, j)), 2 * kTolerance);
    }
  }
}

TEST(Displacement, of_a_cell_is_the_sum_over_its_parts) {
  const Displacement part(1, 1);
  for (const int height : {1, 3}) {
    const Displacement whole(3, height);
    for (const std::int64_t i : {0, 1, 2, 7, 90}) {
      for (const std::int64_t j : {0, 1, 5, 8, 70}) {
        Real sum = 0;
        for (std::int64_t k = -1; k <= 1; ++k) {
          for (std::int64_t l = -(height / 2); l <= height / 2; ++l) sum += part(3 * i + k, height * j + l);
        }
        EXPECT_LE(relative_error(whole(i, j), sum), 2 * kTolerance) << i << ", " << j;
      }
    }
  }
}

TEST(Displacement, fills_grids_of_every_width_with_the_same_coefficients) {
  for (const simd::Isa isa : simd::supported()) {
    const auto wide = filled(1, 2, 70, 9, isa);
    for (const std::int64_t nx : {1, 2, 3, 5, 7, 8, 9, 13, 16, 17, 31, 33, 64, 69}) {
      for (const std::int64_t ny : {1, 2, 9}) {
        const auto narrow = filled(1, 2, nx, ny, isa);
        for (std::int64_t j = 0; j < ny; ++j) {
          EXPECT_EQ(std::memcmp(&narrow[j * nx], &wide[j * 70], nx * sizeof(double)), 0) << nx << ", " << ny;
        }
      }
    }
  }
}

TEST(Displacement, writes_nothing_beyond_the_grid) {
  for (const simd::Isa isa : simd::supported()) {
    for (std::int64_t nx = 1; nx < 40; ++nx) {
      std::vector<double> memory(static_cast<std::size_t>(3 * nx + 17), -7.0);
      Displacement(1, 1).fill(parallel::Arena(1), simd::kernels(isa), nx, 3, memory.data() + 1);
      EXPECT_EQ(memory[0], -7.0);
      for (std::size_t k = 3 * nx + 1; k < memory.size(); ++k) EXPECT_EQ(memory[k], -7.0);
    }
  }
}

TEST(Displacement, does_not_depend_on_the_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const simd::Isa isa = simd::supported().back();
  const auto one = filled(1, 1.5, 701, 503, isa, 1);
  for (const int threads : {2, 3, 8}) {
    const auto many = filled(1, 1.5, 701, 503, isa, threads);
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)), 0) << threads;
  }
}

TEST(Displacement, refuses_cells_without_positive_finite_sides) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1e-6, inf, nan}) {
    EXPECT_THROW(Displacement(bad, 1e-6), Error);
    EXPECT_THROW(Displacement(1e-6, bad), Error);
  }
}

}  // namespace
}  // namespace brinell::influence
