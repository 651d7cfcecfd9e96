#include "surface/portable_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace brinell::surface {
namespace {

std::vector<Complex> sample(std::int64_t n) {
  std::vector<Complex> values(static_cast<std::size_t>(n));
  std::uint32_t state = 12345;
  const auto next = [&] {
    state = state * 1664525U + 1013904223U;
    return state / 4294967296.0 - 0.5;
  };
  for (Complex& value : values) value = {next(), next()};
  return values;
}

std::vector<Complex> transformed(std::vector<Complex> values) {
  const PortableTransform transform(static_cast<std::int64_t>(values.size()));
  std::vector<Complex> scratch(transform.scratch_size());
  transform(values.data(), scratch.data());
  return values;
}

std::complex<long double> direct_sum(const std::vector<Complex>& x, std::int64_t k) {
  const auto n = static_cast<std::int64_t>(x.size());
  std::complex<long double> sum = 0;
  for (std::int64_t j = 0; j < n; ++j) {
    const long double angle = 2 * 3.14159265358979323846264338327950288L * static_cast<long double>((j * k) % n) /
                              static_cast<long double>(n);
    sum += std::complex<long double>(x[j].re, x[j].im) * std::polar(1.0L, angle);
  }
  return sum;
}

// The root mean square error of a transform grows like eps·sqrt(log2 n) relative to the norm of the result; a
// Bluestein transform is three of them. 3·2.2e-16·sqrt(12) = 2.3e-15 bounds every length here, largest element
// against the norm.
TEST(PortableTransform, agrees_with_the_direct_sum) {
  std::vector<std::int64_t> lengths = {81, 125, 128, 243, 343, 500, 650, 1009, 1021, 1024, 1331, 2048, 2197};
  for (std::int64_t n = 1; n <= 70; ++n) lengths.push_back(n);
  for (const std::int64_t n : lengths) {
    const auto x = sample(n);
    const auto result = transformed(x);
    double norm = 0;
    for (const Complex& value : x) norm += value.re * value.re + value.im * value.im;
    norm = std::sqrt(norm * static_cast<double>(n));
    const std::int64_t step = n > 300 ? 17 : 1;
    for (std::int64_t k = 0; k < n; k += step) {
      const auto exact = direct_sum(x, k);
      EXPECT_NEAR(result[k].re, static_cast<double>(exact.real()), 2.3e-15 * norm) << n << " " << k;
      EXPECT_NEAR(result[k].im, static_cast<double>(exact.imag()), 2.3e-15 * norm) << n << " " << k;
    }
  }
}

TEST(PortableTransform, of_its_conjugate_is_its_inverse) {
  for (const std::int64_t n : {4096, 4099, 5000, 6750}) {
    const auto x = sample(n);
    auto y = transformed(x);
    for (Complex& value : y) value.im = -value.im;
    y = transformed(y);
    for (std::int64_t k = 0; k < n; ++k) {
      EXPECT_NEAR(y[k].re / static_cast<double>(n), x[k].re, 1e-14);  // elements are O(1): 2·2.3e-15 and a margin
      EXPECT_NEAR(-y[k].im / static_cast<double>(n), x[k].im, 1e-14);
    }
  }
}

}  // namespace
}  // namespace brinell::surface
