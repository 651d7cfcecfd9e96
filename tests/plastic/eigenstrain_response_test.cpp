#include "plastic/eigenstrain_response.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>

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

std::size_t index(const Box& box, std::int64_t i, std::int64_t j, std::int64_t k) {
  return static_cast<std::size_t>((k * box.ny + j) * box.nx + i);
}

// Every cuboid on every other, for 2 mu = 1.
TensorField direct_sum(const Box& box, const TensorField& strain, double nu) {
  const influence::Eigenstrain cuboid(box.dx, box.dy, box.dz, nu);
  TensorField stress(box, 0);
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
                  stress.at(a, index(box, x, y, k)) += matrix[a][b] * strain.at(b, index(box, x - i, y - j, l));
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
    {1, 1, 1, 1, 1, 1},      {5, 7, 3, 1, 1, 1},  {2, 1, 4, 1, 1.5, 0.5},        {1, 9, 2, 2, 1, 1},
    {13, 3, 7, 1, 0.7, 1.3}, {16, 8, 6, 1, 1, 1}, {17, 5, 11, 1e-6, 1e-6, 5e-7}, {33, 2, 5, 1, 1, 0.25},
    {3, 2, 31, 1, 1, 1},
};

/// Of a response relative to its largest stress: z² C multiplies the rounding of products in which the coefficients
/// of shallow layers are the largest, with up to (z/dz)².
double rounding(const Box& box) {
  const auto deep = static_cast<double>(box.nz);
  return 1e-14 * (1 + 0.1 * deep * deep);
}

TEST(EigenstrainResponse, is_the_direct_sum) {
  for (const Box& box : kBoxes) {
    for (const double nu : {0.3, 0.0, 0.49}) {
      if (nu != 0.3 && box.nx != 5) continue;
      const TensorField strain = random_strain(box);
      const TensorField expected = direct_sum(box, strain, nu);
      for (const simd::Isa isa : simd::supported()) {
        const TensorField found = stress_of(Engine(1, isa), box, strain, 0.5, nu);
        double worst = 0;
        for (std::size_t n = 0; n < found.memory.size(); ++n) {
          worst = std::max(worst, std::abs(found.memory[n] - expected.memory[n]));
        }
        // Not a number would not be the larger one.
        EXPECT_FALSE(std::isnan(std::accumulate(found.memory.begin(), found.memory.end(), 0.0)));
        EXPECT_LE(worst, rounding(box) * largest(expected.memory))
            << simd::name(isa) << ", box " << box.nx << " x " << box.ny << " x " << box.nz << ", nu " << nu;
      }
    }
  }
}

TEST(EigenstrainResponse, of_a_deep_wide_box_agrees_with_single_cuboids) {
  // As large as in use, with strain in three cuboids: near the surface, in the middle, in the lowest layer.
  const Box box{40, 24, 32, 1, 1, 1};
  const influence::Eigenstrain cuboid(1, 1, 1, 0.3);
  struct Source {
    std::int64_t i, j, k;
    std::size_t component;
  };
  constexpr Source kSources[] = {{3, 20, 0, kXz}, {20, 12, 16, kXy}, {39, 0, 31, kYz}, {10, 11, 3, kXx}};
  TensorField strain(box, 0);
  for (const Source& at : kSources) strain.at(at.component, index(box, at.i, at.j, at.k)) += 1;
  strain.at(kZz, index(box, 10, 11, 3)) = -1;
  const TensorField stress = stress_of(Engine(), box, strain);
  for (std::int64_t k = 0; k < box.nz; k += 3) {
    for (std::int64_t j = 0; j < box.ny; j += 4) {
      for (std::int64_t i = 0; i < box.nx; i += 5) {
        std::array<double, 6> sum{};
        for (const Source& at : kSources) {
          const auto matrix = cuboid.stress(static_cast<double>(i - at.i), static_cast<double>(j - at.j),
                                            static_cast<double>(k) + 0.5, static_cast<double>(at.k) + 0.5);
          for (std::size_t c = 0; c < 6; ++c) {
            sum[c] += matrix[c][at.component] - (at.component == kXx ? matrix[c][kZz] : 0.0);
          }
        }
        for (std::size_t c = 0; c < 6; ++c) {
          // Single nuclei have little to round: a cuboid's own stress is one.
          EXPECT_NEAR(stress.at(c, index(box, i, j, k)), sum[c], 1e-12) << c << " at " << i << ", " << j << ", " << k;
        }
      }
    }
  }
}

TEST(EigenstrainResponse, works_symmetrically) {
  // The energy of two strains in each other's stress: exact for uniform cuboids only if stresses are averaged over
  // them; at centres it holds to the second difference of the stress. Smooth strains make it small.
  const Box box{24, 20, 12, 1, 1, 1};
  TensorField one(box, 0), other(box, 0);
  for (std::int64_t k = 0; k < box.nz; ++k) {
    for (std::int64_t j = 0; j < box.ny; ++j) {
      for (std::int64_t i = 0; i < box.nx; ++i) {
        const auto bell = [&](double x, double y, double z) {
          const double r2 = (std::pow(static_cast<double>(i) - x, 2) + std::pow(static_cast<double>(j) - y, 2) +
                             std::pow(static_cast<double>(k) - z, 2)) /
                            9;
          return std::exp(-r2);
        };
        const std::size_t n = index(box, i, j, k);
        one.at(kXx, n) = bell(8, 8, 3);
        one.at(kZz, n) = -one.at(kXx, n);
        one.at(kXz, n) = bell(9, 7, 5);
        other.at(kYy, n) = bell(14, 12, 6);
        other.at(kZz, n) = -other.at(kYy, n);
        other.at(kXy, n) = 0.5 * bell(13, 9, 4);
      }
    }
  }
  const Engine engine;
  const TensorField of_one = stress_of(engine, box, one), of_other = stress_of(engine, box, other);
  const auto work = [&](const TensorField& stress, const TensorField& strain) {
    double sum = 0;
    for (std::size_t c = 0; c < 6; ++c) {
      for (std::size_t n = 0; n < box.cuboids(); ++n) sum += (c < 3 ? 1 : 2) * stress.at(c, n) * strain.at(c, n);
    }
    return sum;
  };
  const double there = work(of_one, other), back = work(of_other, one);
  EXPECT_NEAR(there, back, 5e-3 * std::abs(there));
  EXPECT_LT(work(of_one, one), 0);  // elastic energy is stored
}

TEST(EigenstrainResponse, is_linear_and_scales_with_the_modulus) {
  const Box box{7, 6, 5, 1, 2, 1};
  const Engine engine;
  const TensorField one = random_strain(box, 1), other = random_strain(box, 2);
  TensorField both(box, 0);
  for (std::size_t n = 0; n < both.memory.size(); ++n) both.memory[n] = 3 * one.memory[n] - 2 * other.memory[n];
  const TensorField of_one = stress_of(engine, box, one), of_other = stress_of(engine, box, other, 1e9),
                    of_both = stress_of(engine, box, both);
  const double scale = largest(of_both.memory);
  for (std::size_t n = 0; n < both.memory.size(); ++n) {
    EXPECT_NEAR(of_both.memory[n], 3 * of_one.memory[n] - 2 * of_other.memory[n] * 0.5e-9, rounding(box) * scale);
  }
}

TEST(EigenstrainResponse, moves_with_the_strain_and_stays_in_a_larger_box) {
  const Box box{12, 10, 6, 1, 1, 1}, larger{15, 14, 9, 1, 1, 1};
  const TensorField strain = random_strain(box);
  TensorField moved(larger, 0);
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::int64_t k = 0; k < box.nz; ++k) {
      for (std::int64_t j = 0; j < box.ny; ++j) {
        for (std::int64_t i = 0; i < box.nx; ++i) {
          moved.at(c, index(larger, i + 2, j + 3, k)) = strain.at(c, index(box, i, j, k));
        }
      }
    }
  }
  const Engine engine;
  const TensorField here = stress_of(engine, box, strain), there = stress_of(engine, larger, moved);
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::int64_t k = 0; k < box.nz; ++k) {
      for (std::int64_t j = 0; j < box.ny; ++j) {
        for (std::int64_t i = 0; i < box.nx; ++i) {
          EXPECT_NEAR(there.at(c, index(larger, i + 2, j + 3, k)), here.at(c, index(box, i, j, k)),
                      rounding(larger) * largest(here.memory));
        }
      }
    }
  }
}

TEST(EigenstrainResponse, leaves_planes_of_equal_depth_without_force) {
  // Nothing pulls at the half-space, so the traction over a whole plane z = const has no resultant. That of a strain
  // in one cuboid, summed over a box of half width w, is what is beyond: it falls as w^-3, from 20.5 to 40.5 by 7.7.
  const auto resultants = [](std::int64_t width, std::size_t component) {
    const Box box{width, width, 6, 1, 1, 1};
    TensorField strain(box, 0);
    strain.at(component, index(box, width / 2, width / 2, 2)) = 1;
    if (component == kXx) strain.at(kZz, index(box, width / 2, width / 2, 2)) = -1;
    const TensorField stress = stress_of(Engine(), box, strain);
    std::vector<double> sums;
    for (const std::size_t traction : {kZz, kYz, kXz}) {
      for (std::int64_t k = 0; k < box.nz; ++k) {
        double sum = 0;
        for (std::size_t n = index(box, 0, 0, k); n < index(box, 0, 0, k + 1); ++n) sum += stress.at(traction, n);
        sums.push_back(sum);
      }
    }
    return sums;
  };
  for (const std::size_t component : {kXx, kYz, kXz, kXy}) {
    const std::vector<double> near = resultants(41, component), far = resultants(81, component);
    for (std::size_t n = 0; n < far.size(); ++n) {
      EXPECT_LE(std::abs(far[n]), 0.01) << "strain " << component << ", " << n;
      EXPECT_LE(std::abs(far[n]), std::abs(near[n]) / 5 + 1e-14) << "strain " << component << ", " << n;
    }
  }
}

TEST(EigenstrainResponse, of_no_strain_is_nothing_and_zero_parts_change_nothing) {
  const Box box{9, 8, 7, 1, 1, 1};
  const Engine engine;
  const TensorField none = stress_of(engine, box, TensorField(box, 0));
  for (const double value : none.memory) EXPECT_EQ(value, 0.0);
  // Strain in two layers and two components alone: the rest is left out, and the sum is the same.
  TensorField some(box, 0);
  const TensorField all = random_strain(box);
  for (std::int64_t k = 2; k < 4; ++k) {
    for (std::size_t n = index(box, 0, 0, k); n < index(box, 0, 0, k + 1); ++n) {
      for (const std::size_t c : {kYz, kXy}) some.at(c, n) = all.at(c, n);
    }
  }
  const TensorField found = stress_of(engine, box, some), expected = direct_sum(box, some, 0.3);
  for (std::size_t n = 0; n < found.memory.size(); ++n) {
    EXPECT_NEAR(found.memory[n], expected.memory[n], rounding(box) * largest(expected.memory));
  }
}

TEST(EigenstrainResponse, may_overwrite_its_strain_and_be_asked_again) {
  const Box box{6, 5, 4, 1, 1, 1};
  const Engine engine;
  EigenstrainResponse response(engine.backend, box, 0.5, 0.3);
  TensorField strain = random_strain(box), again = strain;
  TensorField stress(box, 0);
  response.stress(static_cast<const TensorField&>(strain).pointers(), stress.pointers());
  response.stress(static_cast<const TensorField&>(strain).pointers(), strain.pointers());
  EXPECT_EQ(strain.memory, stress.memory);
  response.stress(static_cast<const TensorField&>(again).pointers(), again.pointers());
  EXPECT_EQ(again.memory, stress.memory);
}

TEST(EigenstrainResponse, does_not_depend_on_the_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const Box box{37, 19, 9, 1, 1.5, 0.5};
  const TensorField strain = random_strain(box);
  for (const simd::Isa isa : simd::supported()) {
    const TensorField one = stress_of(Engine(1, isa), box, strain);
    for (const int threads : {2, 3, 8}) {
      const TensorField many = stress_of(Engine(threads, isa), box, strain);
      EXPECT_EQ(std::memcmp(one.memory.data(), many.memory.data(), one.memory.size() * sizeof(double)), 0)
          << simd::name(isa) << ", " << threads << " threads";
    }
  }
}

TEST(EigenstrainResponse, resized_gives_the_bits_of_a_new_one) {
  const Engine engine(3);
  EigenstrainResponse response(engine.backend, {4, 3, 2, 1, 0.8, 1.2}, 0.5, 0.3);
  for (const Box& box : {Box{9, 6, 5, 1, 0.8, 1.2}, Box{33, 10, 7, 1, 0.8, 1.2}, Box{33, 10, 7, 1, 0.8, 1.2},
                         Box{8, 12, 3, 1, 0.8, 1.2}}) {
    response.resize(box);
    EXPECT_TRUE(response.box() == box);
    const TensorField strain = random_strain(box);
    TensorField stress(box, std::numeric_limits<double>::quiet_NaN());
    response.stress(strain.pointers(), stress.pointers());
    EXPECT_EQ(stress.memory, stress_of(engine, box, strain).memory);
    EigenstrainResponse other(response, box);
    other.stress(strain.pointers(), stress.pointers());
    EXPECT_EQ(stress.memory, stress_of(engine, box, strain).memory);
  }
  EXPECT_THROW(response.resize({8, 12, 3, 1, 0.8, 1.3}), Error);
  EXPECT_THROW(response.resize({8, 0, 3, 1, 0.8, 1.2}), Error);
}

TEST(EigenstrainResponse, announces_its_bytes) {
  const Engine engine;
  const auto bytes = EigenstrainResponse::bytes(engine.backend, {64, 64, 32, 1, 1, 1});
  EXPECT_LE(bytes.spectra, 110'000'000u);
  EXPECT_GT(bytes.work, std::size_t{6} * 64 * 64 * 32 * sizeof(double));
}

TEST(EigenstrainResponse, refuses_what_is_no_box_field_or_material) {
  const Engine engine;
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto status = [&](const Box& box, double mu, double nu) {
    try {
      EigenstrainResponse response(engine.backend, box, mu, nu);
    } catch (const Error& error) {
      return error.status();
    }
    return Status::ok;
  };
  const Box good{2, 2, 2, 1, 1, 1};
  EXPECT_EQ(status(good, 1, 0.3), Status::ok);
  EXPECT_EQ(status({0, 2, 2, 1, 1, 1}, 1, 0.3), Status::invalid_argument);
  EXPECT_EQ(status({2, -1, 2, 1, 1, 1}, 1, 0.3), Status::invalid_argument);
  EXPECT_EQ(status({2, 2, std::int64_t{1} << 60, 1, 1, 1}, 1, 0.3), Status::invalid_argument);
  EXPECT_EQ(status({1 << 19, 1 << 19, 1 << 19, 1, 1, 1}, 1, 0.3), Status::too_large);
  for (const double bad : {0.0, -1.0, inf, nan}) {
    EXPECT_EQ(status({2, 2, 2, bad, 1, 1}, 1, 0.3), Status::invalid_argument);
    EXPECT_EQ(status({2, 2, 2, 1, 1, bad}, 1, 0.3), Status::invalid_argument);
    EXPECT_EQ(status(good, bad, 0.3), Status::invalid_argument);
  }
  for (const double bad : {-1.0, 0.5, inf, nan}) EXPECT_EQ(status(good, 1, bad), Status::invalid_argument);
  EigenstrainResponse response(engine.backend, good, 1, 0.3);
  TensorField field(good, 0);
  TensorArrays missing = field.pointers();
  missing[3] = nullptr;
  EXPECT_THROW(response.stress(static_cast<const TensorField&>(field).pointers(), missing), Error);
}

}  // namespace
}  // namespace brinell::plastic
