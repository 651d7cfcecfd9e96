#include "benchmark_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "base/buffer.h"
#include "contact/passes.h"
#include "fft/convolution.h"
#include "influence/displacement.h"
#include "influence/spectra.h"

namespace brinell::capi {

namespace {

constexpr std::int64_t kNodes = 512;  // of the convolutions: in cache, but not in one core's own

double now(const scene::Engine& engine) {
  std::timespec time{};
  clock_gettime(engine.arena().threads() > 1 ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Body>
double time_of(const scene::Engine& engine, int turns, const Body& body) {
  body();
  const double start = now(engine);
  for (int turn = 0; turn < turns; ++turn) body();
  return (now(engine) - start) / turns;
}

/// Values between −1 and 1 in which no transform finds a pattern.
template <class Real>
Buffer<Real> scattered_values(std::int64_t size) {
  auto values = Buffer<Real>::uninitialised(static_cast<std::size_t>(size));
  std::uint64_t state = 1;
  for (Real& value : values) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    value = static_cast<Real>(static_cast<double>(state >> 11) * 0x1p-52 - 1);
  }
  return values;
}

/// Calibration: the textbook's convolution. Padded with zeros, r2c along the rows, transposed, transformed along the
/// columns, multiplied, and all the way back; FFTW's plans by estimate, one thread.
double padded_transforms(scene::Engine& engine) {
  constexpr std::int64_t n = 2 * kNodes;
  constexpr std::int64_t columns = n / 2 + 1;
  fft::PlanCache& plans = engine.resources().backend.plans;
  const auto to_frequencies = plans.transform<double>(fft::Kind::real_to_complex, n);
  const auto to_values = plans.transform<double>(fft::Kind::complex_to_real, n);
  const auto forward = plans.transform<double>(fft::Kind::complex_forward, n);
  const auto backward = plans.transform<double>(fft::Kind::complex_backward, n);
  const Buffer<double> source = scattered_values<double>(kNodes * kNodes);
  Buffer<double> rows(static_cast<std::size_t>(2 * n * (columns + 1)));
  Buffer<double> turned(rows.size());
  Buffer<double> line(2 * n), other(2 * n);
  constexpr std::int64_t stride = 2 * (columns + 1);

  return time_of(engine, 2, [&] {
    for (std::int64_t j = 0; j < n; ++j) {
      std::fill(line.begin(), line.end(), 0.0);
      if (j < kNodes) std::copy_n(source.data() + j * kNodes, kNodes, line.data());
      to_frequencies(line.data(), rows.data() + j * stride);
    }
    for (std::int64_t k = 0; k < columns; ++k) {
      for (std::int64_t j = 0; j < n; ++j) {
        line[2 * j] = rows[j * stride + 2 * k];
        line[2 * j + 1] = rows[j * stride + 2 * k + 1];
      }
      forward(line.data(), other.data());
      for (std::int64_t j = 0; j < 2 * n; ++j) other[j] *= 1e-6;
      backward(other.data(), turned.data() + k * 2 * n);
    }
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t k = 0; k < columns; ++k) {
        other[2 * k] = turned[k * 2 * n + 2 * j];
        other[2 * k + 1] = turned[k * 2 * n + 2 * j + 1];
      }
      to_values(other.data(), rows.data() + j * stride);
    }
  });
}

/// Calibration: STREAM's triad, a = b + s·c, over arrays that no cache holds.
double triad(scene::Engine& engine) {
  constexpr std::int64_t length = std::int64_t{1} << 21;
  Buffer<double> a(length);
  const Buffer<double> b = scattered_values<double>(length), c = scattered_values<double>(length);
  return time_of(engine, 3, [&] {
    engine.arena().for_chunks(length, 1 << 16, [&](std::int64_t begin, std::int64_t end, int) {
      for (std::int64_t i = begin; i < end; ++i) a[i] = b[i] + 3.0 * c[i];
    });
  });
}

/// Calibration: a loop of std::pow, one value after the other.
double scalar_powers(scene::Engine& engine) {
  constexpr std::int64_t length = 100000;
  const Buffer<double> exponents = scattered_values<double>(length);
  Buffer<double> powers(length);
  return time_of(engine, 3, [&] {
    for (std::int64_t i = 0; i < length; ++i) powers[i] = std::pow(1.5, exponents[i]);
  });
}

template <class Real>
double convolution(scene::Engine& engine) {
  const contact::Resources resources = engine.resources();
  const Grid grid{kNodes, kNodes, 1, 1};
  const fft::Convolution<Real> one(resources.backend, grid.nx, grid.ny, Boundary::free);
  const auto spectrum =
      influence::displacement_spectrum(resources.spectra, resources.backend, one, grid, Boundary::free);
  const auto workspace = one.workspace();
  const Buffer<Real> source = scattered_values<Real>(kNodes * kNodes);
  auto result = Buffer<Real>::uninitialised(source.size());
  return time_of(engine, 6, [&] { one.apply(*spectrum, source.data(), result.data(), *workspace); });
}

double coefficients(scene::Engine& engine) {
  Buffer<double> values(4 * kNodes * kNodes);
  const influence::Displacement displacement(1, 1);
  return time_of(engine, 6,
                 [&] { displacement.fill(engine.arena(), engine.kernels(), 2 * kNodes, 2 * kNodes, values.data()); });
}

/// The vector work of one iteration, a fifth of the nodes in contact, in spots.
double solver_passes(scene::Engine& engine) {
  constexpr std::int64_t n = 2 * kNodes;
  Buffer<double> p(n * n), v = scattered_values<double>(n * n), z(n * n);
  const Buffer<double> q = scattered_values<double>(n * n);
  auto g = Buffer<double>::uninitialised(n * n);
  for (std::int64_t i = 0; i < n * n; ++i) {
    const bool contact = (i % n) / 32 % 5 == (i / n) / 32 % 5;
    p[i] = contact ? 1 : 0;
    g[i] = contact ? 0 : 1;
  }
  contact::Passes<double> passes(engine.arena(), engine.kernels(), contact::PlacedGrid::centred({n, n, 1, 1}));
  const contact::LinearTrend approach{0.5, 0, 0};
  passes.open_contact();
  return time_of(engine, 2, [&] {
    passes.residual(approach, 0, 1, p.data(), g.data(), z.data());
    passes.correlate(z.data(), v.data(), q.data());
    passes.redirect(0.5, {}, 1, {}, p.data(), z.data(), v.data());
    passes.balance({}, approach, p.data(), g.data(), v.data());
    passes.curvature(p.data(), v.data(), q.data());
    passes.advance(1e-12, p.data(), v.data(), g.data(), q.data());
  });
}

constexpr std::array kBenchmarks{
    Benchmark{"calibration_transforms", 0, padded_transforms},
    Benchmark{"calibration_memory", 1, triad},
    Benchmark{"calibration_scalar", 2, scalar_powers},
    Benchmark{"convolution_double", 0, convolution<double>},
    Benchmark{"convolution_single", 0, convolution<float>},
    Benchmark{"coefficients", 2, coefficients},
    Benchmark{"solver_passes", 1, solver_passes},
};

}  // namespace

std::span<const Benchmark> benchmarks() {
  return kBenchmarks;
}

}  // namespace brinell::capi
