// Convolutions by direct sums in long double: the authority for the fast ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "base/function_ref.h"
#include "fft/convolution.h"

namespace brinell::support {

template <class Real>
std::vector<Real> random_values(std::int64_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Real> values(static_cast<std::size_t>(size));
  for (Real& value : values) value = static_cast<Real>(uniform(random));
  return values;
}

template <class Real>
double norm(const std::vector<Real>& values) {
  double sum = 0;
  for (const Real value : values) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum);
}

template <class Real>
double largest_difference(const std::vector<Real>& values, const std::vector<long double>& expected) {
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = static_cast<double>(std::abs(static_cast<long double>(values[i]) - expected[i]));
    if (!(difference <= largest)) largest = difference;  // keeps a NaN
  }
  return largest;
}

/// result(i, j) = Σ K(i − k, j − l) source(k, l), K given at non-negative offsets and continued by its parities.
template <class Real>
std::vector<long double> free_convolution(const std::vector<Real>& source, const std::vector<double>& kernel,
                                          std::int64_t nx, std::int64_t ny, fft::Parity parity_x,
                                          fft::Parity parity_y) {
  const auto sign = [](std::int64_t offset, fft::Parity parity) {
    if (parity == fft::Parity::even || offset > 0) return 1;
    return offset == 0 ? 0 : -1;
  };
  std::vector<long double> result(source.size());
  for (std::int64_t j = 0; j < ny; ++j) {
    for (std::int64_t i = 0; i < nx; ++i) {
      long double sum = 0;
      for (std::int64_t l = 0; l < ny; ++l) {
        const int sign_y = sign(j - l, parity_y);
        for (std::int64_t k = 0; k < nx; ++k) {
          sum += sign_y * sign(i - k, parity_x) *
                 static_cast<long double>(kernel[std::abs(j - l) * nx + std::abs(i - k)]) * source[l * nx + k];
        }
      }
      result[j * nx + i] = sum;
    }
  }
  return result;
}

/// Discrete Fourier sums along one axis of complex values [outer][n][inner].
inline void fourier_sums(std::vector<std::complex<long double>>& values, std::int64_t outer, std::int64_t n,
                         std::int64_t inner, int sign) {
  std::vector<std::complex<long double>> roots(n), line(n);
  for (std::int64_t k = 0; k < n; ++k) {
    roots[k] = std::polar(1.0L, static_cast<long double>(sign) * 2 * std::numbers::pi_v<long double> * k / n);
  }
  for (std::int64_t o = 0; o < outer; ++o) {
    for (std::int64_t i = 0; i < inner; ++i) {
      for (std::int64_t k = 0; k < n; ++k) {
        line[k] = 0;
        for (std::int64_t j = 0; j < n; ++j) line[k] += values[(o * n + j) * inner + i] * roots[j * k % n];
      }
      for (std::int64_t k = 0; k < n; ++k) values[(o * n + k) * inner + i] = line[k];
    }
  }
}

template <class Real>
std::vector<long double> periodic_convolution(const std::vector<Real>& source, std::int64_t nx, std::int64_t ny,
                                              FunctionRef<double(std::int64_t, std::int64_t)> symbol) {
  std::vector<std::complex<long double>> values(source.begin(), source.end());
  fourier_sums(values, ny, nx, 1, -1);
  fourier_sums(values, 1, ny, nx, -1);
  for (std::int64_t ky = 0; ky < ny; ++ky) {
    for (std::int64_t kx = 0; kx < nx; ++kx) {
      values[ky * nx + kx] *=
          symbol(std::min(kx, nx - kx), std::min(ky, ny - ky)) / static_cast<long double>(nx * ny);
    }
  }
  fourier_sums(values, 1, ny, nx, 1);
  fourier_sums(values, ny, nx, 1, 1);
  std::vector<long double> result(source.size());
  std::transform(values.begin(), values.end(), result.begin(), [](const auto& value) { return value.real(); });
  return result;
}

}  // namespace brinell::support
