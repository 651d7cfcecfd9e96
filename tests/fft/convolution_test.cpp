// Convolutions against direct sums in long double. A transform of n points carries an error of about
// log2(n)·eps/2 relative to the 2-norm; with random data in [−1, 1] the largest entry of a result is then accurate
// to a small multiple of eps·log2(4·nx·ny)·‖source‖₂·‖kernel‖₂ (bounded by the Cauchy-Schwarz inequality).
#include "fft/convolution.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "fft/plan_cache.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "support/convolution_reference.h"

namespace brinell::fft {
namespace {

using support::random_values;

const std::vector<Parity> kParities{Parity::even, Parity::odd};

template <class Real>
struct Precision : testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(Precision, Precisions);

template <class Real>
double tolerance(std::int64_t nodes, double source_norm, double kernel_norm) {
  return 2.0 * std::numeric_limits<Real>::epsilon() * std::log2(8.0 * static_cast<double>(nodes)) * source_norm *
         kernel_norm;
}

/// One convolution with everything it runs on.
template <class Real>
struct Case {
  explicit Case(std::int64_t nx, std::int64_t ny, Boundary boundary, Method method = Method::fftw, int threads = 1,
                simd::Isa isa = simd::supported().back())
      : arena(threads), convolution({arena, simd::kernels(isa), plans}, nx, ny, boundary, method) {}

  std::vector<Real> apply(const Spectrum<Real>& spectrum, const std::vector<Real>& source) {
    if (workspace == nullptr) workspace = convolution.workspace();
    std::vector<Real> result(source.size());
    convolution.apply(spectrum, source.data(), result.data(), *workspace);
    return result;
  }

  parallel::Arena arena;
  PlanCache plans;
  Convolution<Real> convolution;
  std::unique_ptr<Workspace<Real>> workspace;
};

/// All four parities of one free size against the direct sum.
template <class Real>
void check_free(std::int64_t nx, std::int64_t ny, Method method, simd::Isa isa) {
  Case<Real> with(nx, ny, Boundary::free, method, 1, isa);
  const auto source = random_values<Real>(nx * ny, 1);
  const auto kernel = random_values<double>(nx * ny, 2);
  for (const Parity parity_x : kParities) {
    for (const Parity parity_y : kParities) {
      const auto spectrum = with.convolution.spectrum(kernel.data(), parity_x, parity_y);
      const auto result = with.apply(spectrum, source);
      const auto expected = support::free_convolution(source, kernel, nx, ny, parity_x, parity_y);
      const double allowed = tolerance<Real>(nx * ny, support::norm(source), 2 * support::norm(kernel));
      EXPECT_LE(support::largest_difference(result, expected), allowed)
          << nx << " x " << ny << " parity " << int(parity_x) << int(parity_y) << " " << simd::name(isa);
    }
  }
}

template <class Real>
void check_periodic(std::int64_t nx, std::int64_t ny, Method method, simd::Isa isa) {
  Case<Real> with(nx, ny, Boundary::periodic, method, 1, isa);
  const auto source = random_values<Real>(nx * ny, 1);
  const auto symbol = random_values<double>((nx / 2 + 1) * (ny / 2 + 1), 3);
  const auto value = [&](std::int64_t kx, std::int64_t ky) { return symbol.at(ky * (nx / 2 + 1) + kx); };
  const auto spectrum = with.convolution.spectrum_of_symbol(value);
  const auto result = with.apply(spectrum, source);
  const auto expected = support::periodic_convolution<Real>(source, nx, ny, value);
  // |symbol| <= 1 does not lengthen the source.
  const double allowed = tolerance<Real>(nx * ny, support::norm(source), 1.0);
  EXPECT_LE(support::largest_difference(result, expected), allowed) << nx << " x " << ny << " " << simd::name(isa);
}

TYPED_TEST(Precision, free_convolution_by_fftw_is_the_direct_sum) {
  for (std::int64_t nx = 1; nx <= 20; ++nx) {
    for (std::int64_t ny = 1; ny <= 20; ++ny) check_free<TypeParam>(nx, ny, Method::fftw, simd::Isa::baseline);
  }
  for (const auto& [nx, ny] : {std::pair{37, 41}, {1, 97}, {97, 1}, {64, 31}, {31, 64}, {40, 40}}) {
    check_free<TypeParam>(nx, ny, Method::fftw, simd::Isa::baseline);
  }
}

TYPED_TEST(Precision, periodic_convolution_by_fftw_is_the_direct_sum) {
  for (std::int64_t nx = 1; nx <= 17; ++nx) {
    for (std::int64_t ny = 1; ny <= 17; ++ny) check_periodic<TypeParam>(nx, ny, Method::fftw, simd::Isa::baseline);
  }
  for (const auto& [nx, ny] : {std::pair{29, 31}, {1, 97}, {97, 1}, {64, 9}, {9, 64}}) {
    check_periodic<TypeParam>(nx, ny, Method::fftw, simd::Isa::baseline);
  }
}

TYPED_TEST(Precision, free_convolution_by_lanes_is_the_direct_sum) {
  for (const simd::Isa isa : simd::supported()) {
    for (std::int64_t nx = 1; nx <= 40; nx += 3) {
      for (std::int64_t ny = 1; ny <= 40; ny += 3) check_free<TypeParam>(nx, ny, Method::lanes, isa);
    }
    for (const auto& [nx, ny] : {std::pair{37, 41}, {1, 97}, {97, 1}, {64, 31}, {31, 64}, {128, 25}, {320, 12}}) {
      check_free<TypeParam>(nx, ny, Method::lanes, isa);
    }
  }
}

TYPED_TEST(Precision, periodic_convolution_by_lanes_is_the_direct_sum) {
  for (const simd::Isa isa : simd::supported()) {
    const std::int64_t lanes = simd::kernels(isa).of<TypeParam>().transform.lanes;
    for (const std::int64_t vectors : {1, 2, 3, 4, 5, 6, 8, 12, 15, 16, 20, 32}) {
      for (const std::int64_t ny : {1, 2, 3, 4, 5, 6, 8, 9, 10, 12, 15, 16, 18, 20, 24, 25, 32, 40}) {
        check_periodic<TypeParam>(lanes * vectors, ny, Method::lanes, isa);
      }
    }
  }
}

/// The two methods are independent of each other; FFTW's is the authority where direct sums take too long.
template <class Real>
void check_against_fftw(std::int64_t nx, std::int64_t ny, Boundary boundary, simd::Isa isa) {
  const auto source = random_values<Real>(nx * ny, 1);
  const auto kernel = random_values<double>(nx * ny, 2);
  const auto symbol = [&](std::int64_t kx, std::int64_t ky) { return kernel[ky * (nx / 2 + 1) + kx]; };
  const auto result = [&](Method method) {
    Case<Real> with(nx, ny, boundary, method, 1, isa);
    EXPECT_EQ(with.convolution.method(), method);
    return with.apply(boundary == Boundary::free ? with.convolution.spectrum(kernel.data(), Parity::odd, Parity::even)
                                                 : with.convolution.spectrum_of_symbol(symbol),
                      source);
  };
  const auto by_lanes = result(Method::lanes);
  const auto by_fftw = result(Method::fftw);
  const std::vector<long double> expected(by_fftw.begin(), by_fftw.end());
  const double allowed = 2 * tolerance<Real>(nx * ny, support::norm(source),
                                             boundary == Boundary::free ? 2 * support::norm(kernel) : 1.0);
  EXPECT_LE(support::largest_difference(by_lanes, expected), allowed)
      << nx << " x " << ny << " " << simd::name(isa) << (boundary == Boundary::free ? " free" : " periodic");
}

/// 2^a·{1, 3, 5, 9} from 48 to 4096, and neighbours: long in one direction at a time.
TYPED_TEST(Precision, lanes_agree_with_fftw_at_good_sizes_and_their_neighbours) {
  std::vector<std::int64_t> sizes;
  for (const std::int64_t odd : {1, 3, 5, 9}) {
    for (std::int64_t size = odd; size <= 4096; size *= 2) {
      if (size >= 48) sizes.push_back(size);
    }
  }
  for (const simd::Isa isa : simd::supported()) {
    for (const std::int64_t size : sizes) {
      for (const std::int64_t near : {size - 1, size, size + 1}) {
        check_against_fftw<TypeParam>(near, 3, Boundary::free, isa);
        check_against_fftw<TypeParam>(5, near, Boundary::free, isa);
      }
      if (size % 16 == 0) check_against_fftw<TypeParam>(size, 4, Boundary::periodic, isa);
      check_against_fftw<TypeParam>(16, size, Boundary::periodic, isa);
    }
    check_against_fftw<TypeParam>(1024, 768, Boundary::free, isa);
    check_against_fftw<TypeParam>(1024, 1152, Boundary::periodic, isa);
  }
}

/// Waves of a kernel that is odd along an axis are turned by a quarter: −i s e^{iqx}, of a sine −s cos, of a cosine
/// s sin.
template <class Real>
void check_odd_symbols(std::int64_t nx, std::int64_t ny, Method method, simd::Isa isa) {
  Case<Real> one(nx, ny, Boundary::periodic, method, 1, isa);
  const auto symbol = [](std::int64_t kx, std::int64_t ky) { return static_cast<double>(kx + 3 * ky + 1); };
  const double step_x = 2 * std::numbers::pi / static_cast<double>(nx);
  const double step_y = 2 * std::numbers::pi / static_cast<double>(ny);
  const std::int64_t kx = nx / 3, ky = ny / 4;
  std::vector<Real> source(static_cast<std::size_t>(nx * ny));
  for (const Parity parity_x : kParities) {
    for (const Parity parity_y : kParities) {
      // cos(a + 0.3) cos(b + 0.4) with a, b the phases; an odd axis makes sines of the cosines.
      const auto wave = [&](std::int64_t i, std::int64_t j, Parity px, Parity py) {
        const double a = static_cast<double>(kx * i) * step_x + 0.3, b = static_cast<double>(ky * j) * step_y + 0.4;
        const double at_zero_x = kx == 0 && px == Parity::odd ? 0 : 1;
        const double at_zero_y = ky == 0 && py == Parity::odd ? 0 : 1;
        return at_zero_x * at_zero_y * (px == Parity::odd ? std::sin(a) : std::cos(a)) *
               (py == Parity::odd ? std::sin(b) : std::cos(b));
      };
      for (std::int64_t n = 0; n < nx * ny; ++n) {
        source[static_cast<std::size_t>(n)] = static_cast<Real>(wave(n % nx, n / nx, Parity::even, Parity::even));
      }
      const Spectrum<Real> spectrum = one.convolution.spectrum_of_symbol(symbol, parity_x, parity_y);
      const std::vector<Real> result = one.apply(spectrum, source);
      const SourceTransform<Real> transformed = one.convolution.transform(source.data(), *one.workspace);
      std::vector<Real> sum(source.size());
      const Term<Real> terms[2] = {{&transformed, &spectrum}, {&transformed, &spectrum}};
      one.convolution.apply(std::span<const Term<Real>>(terms), sum.data(), *one.workspace);
      const double scale = symbol(kx, ky);
      const double near = 8 * std::numeric_limits<Real>::epsilon() * std::log2(8.0 * static_cast<double>(nx * ny)) *
                          symbol(nx / 2, ny / 2);
      for (std::int64_t n = 0; n < nx * ny; ++n) {
        const double expected = scale * wave(n % nx, n / nx, parity_x, parity_y);
        ASSERT_NEAR(result[static_cast<std::size_t>(n)], expected, near) << nx << " x " << ny << " at " << n;
        ASSERT_NEAR(sum[static_cast<std::size_t>(n)], 2 * expected, 2 * near) << nx << " x " << ny << " at " << n;
      }
    }
  }
}

TYPED_TEST(Precision, periodic_kernels_may_be_odd) {
  for (const auto& [nx, ny] : {std::pair<std::int64_t, std::int64_t>{1, 1}, {7, 5}, {12, 9}, {16, 8}, {30, 17}}) {
    check_odd_symbols<TypeParam>(nx, ny, Method::fftw, simd::Isa::baseline);
  }
  for (const simd::Isa isa : simd::supported()) {
    for (const auto& [nx, ny] : {std::pair<std::int64_t, std::int64_t>{16, 12}, {48, 5}, {240, 16}, {64, 1}}) {
      check_odd_symbols<TypeParam>(nx, ny, Method::lanes, isa);
    }
  }
}

TEST(Convolution, chooses_the_lane_transform_where_it_is_faster) {
  const auto method = [](std::int64_t nx, std::int64_t ny, Boundary boundary) {
    return Case<double>(nx, ny, boundary, Method::automatic).convolution.method();
  };
  EXPECT_EQ(method(512, 512, Boundary::free), Method::lanes);
  EXPECT_EQ(method(509, 521, Boundary::free), Method::lanes);
  EXPECT_EQ(method(512, 360, Boundary::periodic), Method::lanes);
  EXPECT_EQ(method(509, 512, Boundary::periodic), Method::fftw);
  EXPECT_EQ(method(512, 509, Boundary::periodic), Method::fftw);
  EXPECT_THROW(Case<double>(509, 512, Boundary::periodic, Method::lanes), Error);
}

/// Two sources, each with two kernels, all four parities: the sum equals the convolutions one by one.
template <class Real>
void check_sum(std::int64_t nx, std::int64_t ny, Boundary boundary, Method method, simd::Isa isa) {
  Case<Real> with(nx, ny, boundary, method, 1, isa);
  const auto& convolution = with.convolution;
  const auto workspace = convolution.workspace();
  std::vector<std::vector<Real>> sources;
  std::vector<SourceTransform<Real>> transforms;
  std::vector<Spectrum<Real>> spectra;
  double allowed = 0;
  for (unsigned s = 0; s < 2; ++s) {
    sources.push_back(random_values<Real>(nx * ny, 10 + s));
    transforms.push_back(convolution.transform(sources.back().data(), *workspace));
    EXPECT_EQ(transforms.back().values.bytes(), convolution.transform_bytes());
  }
  std::vector<Term<Real>> terms;
  std::vector<Real> expected(nx * ny);
  spectra.reserve(4);
  for (const Parity parity_x : kParities) {
    for (const Parity parity_y : kParities) {
      const std::size_t s = spectra.size();
      const auto kernel = random_values<double>(nx * ny, 20 + static_cast<unsigned>(s));
      if (boundary == Boundary::free) {
        spectra.push_back(convolution.spectrum(kernel.data(), parity_x, parity_y));
        allowed += tolerance<Real>(nx * ny, support::norm(sources[s % 2]), 2 * support::norm(kernel));
      } else {
        spectra.push_back(convolution.spectrum_of_symbol(
            [&](std::int64_t kx, std::int64_t ky) { return kernel[ky * (nx / 2 + 1) + kx]; }));
        allowed += tolerance<Real>(nx * ny, support::norm(sources[s % 2]), 1.0);
      }
      terms.push_back({&transforms[s % 2], &spectra[s]});
      const auto one = with.apply(spectra[s], sources[s % 2]);
      for (std::size_t i = 0; i < one.size(); ++i) expected[i] += one[i];
    }
  }
  std::vector<Real> result(nx * ny);
  convolution.apply(terms, result.data(), *workspace);
  const std::vector<long double> long_expected(expected.begin(), expected.end());
  EXPECT_LE(support::largest_difference(result, long_expected), allowed) << nx << " x " << ny;
}

TYPED_TEST(Precision, sums_of_transformed_sources_are_sums_of_convolutions) {
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    for (const auto& [nx, ny] : {std::pair{1, 1}, {1, 7}, {6, 1}, {13, 9}, {64, 48}, {30, 31}}) {
      check_sum<TypeParam>(nx, ny, boundary, Method::fftw, simd::Isa::baseline);
    }
    for (const simd::Isa isa : simd::supported()) {
      check_sum<TypeParam>(64, 48, boundary, Method::lanes, isa);
      check_sum<TypeParam>(160, 1, boundary, Method::lanes, isa);
      if (boundary == Boundary::free) check_sum<TypeParam>(13, 31, boundary, Method::lanes, isa);
    }
  }
}

TYPED_TEST(Precision, same_bits_for_any_number_of_threads_and_in_place) {
  using Real = TypeParam;
  const oneapi::tbb::global_control eight(oneapi::tbb::global_control::max_allowed_parallelism, 8);
  constexpr std::int64_t nx = 300;
  constexpr std::int64_t ny = 270;
  const auto source = random_values<Real>(nx * ny, 1);
  const auto kernel = random_values<double>(nx * ny, 2);
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    std::vector<Real> first;
    for (const int threads : {1, 2, 3, 8}) {
      Case<Real> with(nx, ny, boundary, Method::automatic, threads);
      const auto spectrum = boundary == Boundary::free
                                ? with.convolution.spectrum(kernel.data(), Parity::even, Parity::odd)
                                : with.convolution.spectrum_of_symbol([](std::int64_t kx, std::int64_t ky) {
                                    return 1.0 / static_cast<double>(1 + kx * kx + ky * ky);
                                  });
      auto result = with.apply(spectrum, source);
      if (first.empty()) first = result;
      EXPECT_EQ(std::memcmp(result.data(), first.data(), result.size() * sizeof(Real)), 0) << threads;
      std::vector<Real> in_place = source;
      with.convolution.apply(spectrum, in_place.data(), in_place.data(), *with.workspace);
      EXPECT_EQ(std::memcmp(in_place.data(), first.data(), result.size() * sizeof(Real)), 0) << threads;
    }
  }
}

/// Large results at whole cache lines are written past the caches, and a workspace's contents are nobody's.
TYPED_TEST(Precision, same_bits_wherever_the_result_lies_and_whatever_the_workspace_holds) {
  using Real = TypeParam;
  const auto symbol = [](std::int64_t kx, std::int64_t ky) { return 1.0 / static_cast<double>(1 + kx + 2 * ky); };
  const auto check = [&](std::int64_t n, Boundary boundary, Method method, simd::Isa isa) {
    Case<Real> with(n, n, boundary, method, 2, isa);
    const auto source = random_values<Real>(n * n, 1);
    const auto kernel = random_values<double>(n * n, 2);
    const auto spectrum = boundary == Boundary::free
                              ? with.convolution.spectrum(kernel.data(), Parity::even, Parity::odd)
                              : with.convolution.spectrum_of_symbol(symbol);
    const auto expected = with.apply(spectrum, source);
    for (const std::size_t shift : {0, 1}) {
      std::fill(with.workspace->field.begin(), with.workspace->field.end(), std::numeric_limits<Real>::quiet_NaN());
      std::fill(with.workspace->scratch.begin(), with.workspace->scratch.end(),
                std::numeric_limits<Real>::quiet_NaN());
      Buffer<Real> result(source.size() + 64);
      with.convolution.apply(spectrum, source.data(), result.data() + shift, *with.workspace);
      EXPECT_EQ(std::memcmp(result.data() + shift, expected.data(), expected.size() * sizeof(Real)), 0)
          << n << " " << simd::name(isa) << " shift " << shift;
      for (std::size_t i = shift + source.size(); i < result.size(); ++i) EXPECT_EQ(result[i], Real{0});
    }
  };
  for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
    for (const simd::Isa isa : simd::supported()) {
      check(32, boundary, Method::lanes, isa);
      check(boundary == Boundary::free ? 512 : 1024, boundary, Method::lanes, isa);  // a field of 2 MB and more
    }
    check(33, boundary, Method::fftw, simd::Isa::baseline);
  }
}

TYPED_TEST(Precision, writes_nothing_but_the_result) {
  using Real = TypeParam;
  for (const std::int64_t nx : {1, 7, 33, 64}) {
    constexpr std::int64_t ny = 5;
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      Case<Real> with(nx, ny, boundary, Method::automatic);
      const std::vector<double> ones(nx * ny, 1.0);
      const auto spectrum = boundary == Boundary::free
                                ? with.convolution.spectrum(ones.data(), Parity::even, Parity::even)
                                : with.convolution.spectrum_of_symbol([](std::int64_t, std::int64_t) { return 1.0; });
      std::vector<Real> memory(nx * ny + 2, Real{42});
      const std::vector<Real> source(nx * ny, Real{1});
      const auto workspace = with.convolution.workspace();
      with.convolution.apply(spectrum, source.data(), memory.data() + 1, *workspace);
      EXPECT_EQ(memory.front(), Real{42});
      EXPECT_EQ(memory.back(), Real{42});
    }
  }
}

TEST(Convolution, refuses_what_it_cannot_do) {
  EXPECT_THROW(Case<double>(0, 4, Boundary::free), Error);
  EXPECT_THROW(Case<double>(4, -1, Boundary::free), Error);
  EXPECT_THROW(Case<double>(std::int64_t{1} << 40, 1, Boundary::periodic), Error);
  Case<double> free(4, 4, Boundary::free);
  EXPECT_THROW(free.convolution.spectrum_of_symbol([](std::int64_t, std::int64_t) { return 1.0; }), Error);
  Case<double> periodic(4, 4, Boundary::periodic);
  const std::vector<double> kernel(16, 1.0);
  EXPECT_THROW(periodic.convolution.spectrum(kernel.data(), Parity::even, Parity::even), Error);

  const auto spectrum = free.convolution.spectrum(kernel.data(), Parity::even, Parity::even);
  Case<double> other(40, 40, Boundary::free);
  const auto transform = free.convolution.transform(kernel.data(), *free.convolution.workspace());
  const auto workspace = other.convolution.workspace();
  std::vector<double> result(1600);
  const std::vector<Term<double>> terms{{&transform, &spectrum}};
  EXPECT_THROW(other.convolution.apply(terms, result.data(), *workspace), Error);
  EXPECT_THROW(other.convolution.apply(std::span<const Term<double>>{}, result.data(), *workspace), Error);
  EXPECT_THROW(other.apply(spectrum, std::vector<double>(1600)), Error);
}

}  // namespace
}  // namespace brinell::fft
