// One convolution with everything it runs on and a random source, for the benchmarks.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "fft/convolution.h"
#include "fft/plan_cache.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::bench {

template <class Real>
struct ConvolutionCase {
  ConvolutionCase(std::int64_t n, Boundary boundary, fft::Method method, simd::Isa isa, int threads)
      : arena(threads),
        convolution({arena, simd::kernels(isa), plans}, n, n, boundary, method),
        spectrum(make_spectrum(n, boundary)),
        workspace(convolution.workspace()) {}

  void apply(const Real* source, Real* result) { convolution.apply(spectrum, source, result, *workspace); }

  parallel::Arena arena;
  fft::PlanCache plans;
  fft::Convolution<Real> convolution;
  fft::Spectrum<Real> spectrum;
  std::unique_ptr<fft::Workspace<Real>> workspace;

 private:
  fft::Spectrum<Real> make_spectrum(std::int64_t n, Boundary boundary) const {
    const auto value = [](std::int64_t x, std::int64_t y) { return 1.0 / static_cast<double>(1 + x + y); };
    if (boundary == Boundary::periodic) return convolution.spectrum_of_symbol(value);
    std::vector<double> kernel(static_cast<std::size_t>(n * n));
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) kernel[static_cast<std::size_t>(j * n + i)] = value(i, j);
    }
    return convolution.spectrum(kernel.data(), fft::Parity::even, fft::Parity::even);
  }
};

/// Never the result of an earlier convolution: repeated in place, values run into denormal numbers.
template <class Real>
std::vector<Real> random_source(std::int64_t n) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Real> values(static_cast<std::size_t>(n * n));
  for (Real& value : values) value = static_cast<Real>(uniform(random));
  return values;
}

}  // namespace brinell::bench
