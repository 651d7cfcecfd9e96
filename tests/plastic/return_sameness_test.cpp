// A point's result is the same bits wherever it stands, whatever stands beside it, in place or not, and for any
// number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "plastic/return_case.h"

namespace brinell::plastic {
namespace {

bool same_bits(const double* a, const double* b, std::size_t count) {
  return std::memcmp(a, b, count * sizeof(double)) == 0;
}

TEST(ReturnSameness, of_a_point_anywhere) {
  const parallel::Arena arena(1);
  for (const auto& [name, law] : laws()) {
    const YieldCurve curve({law, {}});
    const std::vector<Point> points = points_for(law, 1, 11);
    for (const simd::Isa isa : simd::supported()) {
      const auto map = [&](Field& field) {
        map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, field.state(), field.result());
        EXPECT_TRUE(field.canaries_live());
      };
      Field whole(points);
      map(whole);
      for (std::size_t size = 1; size <= 70; ++size) {
        Field part(size);
        const std::size_t first = (13 * size) % points.size();
        for (std::size_t i = 0; i < size; ++i) part.set(i, points[(first + i) % points.size()]);
        map(part);
        for (std::size_t i = 0; i < size; ++i) {
          for (std::size_t k = 0; k < 16; ++k) {
            ASSERT_TRUE(same_bits(part.output(k) + i, whole.output(k) + (first + i) % points.size(), 1))
                << name << " size " << size << " point " << i << " array " << k;
          }
        }
      }
    }
  }
}

std::vector<Point> many_points(const HardeningLaw& law, std::size_t count) {
  const std::vector<Point> few = points_for(law, 1, 12);
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    if ((i / 300) % 3 != 1) points[i] = few[i % few.size()];
  }
  return points;
}

TEST(ReturnSameness, for_any_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const HardeningLaw law = Swift{1240e6, 30, 0.085, 1e6};
  const YieldCurve curve({law, {}});
  const std::vector<Point> points = many_points(law, 40000);
  const std::vector<double> factors(100, 0.9);
  for (const simd::Isa isa : simd::supported()) {
    Field one(points);
    const std::int64_t yielded =
        map_to_yield(parallel::Arena(1), simd::kernels(isa), curve, kShearModulus, one.state(factors), one.result());
    EXPECT_GT(yielded, 10000);
    for (const int threads : {2, 3, 8}) {
      Field other(points);
      EXPECT_EQ(map_to_yield(parallel::Arena(threads), simd::kernels(isa), curve, kShearModulus, other.state(factors),
                             other.result()),
                yielded);
      EXPECT_TRUE(same_bits(one.outputs().data(), other.outputs().data(), one.outputs().size()));
    }
  }
}

TEST(ReturnSameness, in_place_and_over_old_results) {
  const parallel::Arena arena(1);
  const HardeningLaw law = Voce{300e6, 700e6, 12};
  const YieldCurve curve({law, {}});
  const std::vector<Point> points = many_points(law, 5001);
  for (const simd::Isa isa : simd::supported()) {
    Field apart(points), in_place(points);
    map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, apart.state(), apart.result());
    MappedState result = in_place.result();
    for (std::size_t c = 0; c < 6; ++c) result.stress[c] = in_place.input(c);
    result.plastic_strain = in_place.input(6);
    result.von_mises = result.theta = result.theta_bar = nullptr;
    map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, in_place.state(), result);
    for (std::size_t c = 0; c < 6; ++c) {
      EXPECT_TRUE(same_bits(apart.output(10 + c), in_place.input(c), points.size()));
      EXPECT_TRUE(same_bits(apart.output(c), in_place.output(c), points.size()));
    }
    EXPECT_TRUE(same_bits(apart.output(6), in_place.input(6), points.size()));

    Field other(points);  // unloaded, over the results of a load
    map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, other.state(), other.result());
    for (std::size_t c = 0; c < 6; ++c) std::fill(other.input(c), other.input(c) + points.size(), 0.0);
    EXPECT_EQ(map_to_yield(arena, simd::kernels(isa), curve, kShearModulus, other.state(), other.result()), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t c = 0; c < 6; ++c) ASSERT_EQ(other.output(c)[i], 0.0);
      ASSERT_EQ(other.output(6)[i], points[i].plastic_strain);
    }
  }
}

TEST(ReturnSameness, of_blocks_that_are_left_unwritten) {
  const parallel::Arena arena(2);
  const HardeningLaw law = Swift{1240e6, 30, 0.085, 1e6};
  const YieldCurve curve({law, {}});
  for (const std::size_t count : {std::size_t{5}, std::size_t{640}, std::size_t{9001}}) {
    const std::vector<Point> points = many_points(law, count);
    const simd::KernelTable& kernels = simd::best_kernels();
    Field kept(points);
    std::vector<std::uint8_t> moved(moved_size(count) + 1, 1);
    for (const double scale : {0.1, 1.0, 0.1, 0.7, 1.0, 0.0}) {
      Field fresh(points);
      for (std::size_t c = 0; c < 6; ++c) {
        for (std::size_t i = 0; i < count; ++i) {
          fresh.input(c)[i] *= i % 1024 < 512 ? scale : 0;
          kept.input(c)[i] = fresh.input(c)[i];
        }
      }
      MappedState result = kept.result();
      result.moved = moved.data();
      EXPECT_EQ(map_to_yield(arena, kernels, curve, kShearModulus, kept.state(), result),
                map_to_yield(arena, kernels, curve, kShearModulus, fresh.state(), fresh.result()));
      EXPECT_TRUE(same_bits(kept.outputs().data(), fresh.outputs().data(), fresh.outputs().size()));
      EXPECT_EQ(moved.back(), 1);
      if (scale == 0.0) {
        EXPECT_TRUE(std::all_of(moved.begin(), moved.end() - 1, [](std::uint8_t one) { return one == 0; }));
      }
    }
    kept.output(0)[count - 1] = 5;  // an unmoved block is the caller's word
    MappedState result = kept.result();
    result.moved = moved.data();
    map_to_yield(arena, kernels, curve, kShearModulus, kept.state(), result);
    EXPECT_EQ(kept.output(0)[count - 1], count % simd::kReturnBlock == 0 ? 5 : 0);
  }
}

}  // namespace
}  // namespace brinell::plastic
