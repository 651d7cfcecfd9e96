// Influence coefficients of a quarter grid, ours beside the textbook, for every instruction set of this machine.
// Goal: surface displacement at 1024 x 1024, square cells, at least 30 times as fast as Love's scalar form.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "influence/displacement.h"
#include "influence/stress.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell {
namespace {

// Textbook: Love's four logarithms and eight square roots for each offset.
double love(double x, double y, double a, double b) {
  const auto edge = [](double c, double upper, double lower) {
    return c * std::log((upper + std::sqrt(c * c + upper * upper)) / (lower + std::sqrt(c * c + lower * lower)));
  };
  return (edge(x + a, y + b, y - b) + edge(y + b, x + a, x - a) + edge(x - a, y - b, y + b) +
          edge(y - b, x - a, x + a)) /
         std::numbers::pi;
}

// Textbook: the corner sums of the six stresses under pressure for each offset.
void corner_sums(double x, double y, double z, double a, double b, double nu, double* stress) {
  for (int c = 0; c < 6; ++c) stress[c] = 0;
  for (const double side_x : {1.0, -1.0}) {
    for (const double side_y : {1.0, -1.0}) {
      const double X = x + side_x * a, Y = y + side_y * b, sign = side_x * side_y / (2 * std::numbers::pi);
      const double A = X * X + z * z, B = Y * Y + z * z, rho = std::sqrt(A + Y * Y), m = 1 - 2 * nu;
      const double solid = std::atan2(X * Y, z * rho);
      stress[0] += sign * (-2 * nu * solid + z * X * Y / (A * rho) - m * std::atan2(X * Y, A + z * rho));
      stress[1] += sign * (-2 * nu * solid + z * X * Y / (B * rho) - m * std::atan2(X * Y, B + z * rho));
      stress[2] += sign * (-solid - z * X * Y / rho * (1 / A + 1 / B));
      stress[3] += sign * z * z * X / (B * rho);
      stress[4] += sign * z * z * Y / (A * rho);
      stress[5] += sign * (-m * std::log(z + rho) - z / rho);
    }
  }
}

void count_coefficients(benchmark::State& state, std::int64_t coefficients) {
  state.SetItemsProcessed(state.iterations() * coefficients);
  state.SetBytesProcessed(state.iterations() * coefficients * static_cast<std::int64_t>(sizeof(double)));
}

void bm_displacement_textbook(benchmark::State& state, std::int64_t n, double aspect) {
  std::vector<double> coefficients(static_cast<std::size_t>(n * n));
  for (auto _ : state) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) {
        coefficients[j * n + i] = love(static_cast<double>(i), static_cast<double>(j) * aspect, 0.5, 0.5 * aspect);
      }
    }
    benchmark::DoNotOptimize(coefficients.data());
  }
  count_coefficients(state, n * n);
}

void bm_displacement(benchmark::State& state, std::int64_t n, double aspect, simd::Isa isa, int threads) {
  const parallel::Arena arena(threads);
  std::vector<double> coefficients(static_cast<std::size_t>(n * n));
  for (auto _ : state) {
    influence::Displacement(1, aspect).fill(arena, simd::kernels(isa), n, n, coefficients.data());
    benchmark::DoNotOptimize(coefficients.data());
  }
  count_coefficients(state, n * n);
}

void bm_stress_textbook(benchmark::State& state, std::int64_t n) {
  std::vector<double> coefficients(static_cast<std::size_t>(6 * n * n));
  for (auto _ : state) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) {
        corner_sums(static_cast<double>(i), static_cast<double>(j), 4.5, 0.5, 0.5, 0.3,
                    &coefficients[6 * (j * n + i)]);
      }
    }
    benchmark::DoNotOptimize(coefficients.data());
  }
  count_coefficients(state, 6 * n * n);
}

void bm_stress(benchmark::State& state, std::int64_t n, influence::Traction traction, int components, simd::Isa isa,
               int threads) {
  const parallel::Arena arena(threads);
  std::vector<double> coefficients(static_cast<std::size_t>(6 * n * n));
  std::array<double*, 6> targets{};
  for (int c = 0; c < components; ++c) targets[c] = coefficients.data() + c * n * n;
  for (auto _ : state) {
    influence::Stress(1, 1, 4.5, 0.3).fill(arena, simd::kernels(isa), traction, n, n, targets);
    benchmark::DoNotOptimize(coefficients.data());
  }
  count_coefficients(state, components * n * n);
}

template <class... Arguments>
void add(const std::string& name, Arguments... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), arguments...)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

void add_all() {
  using influence::Traction;
  for (const double aspect : {1.0, 10.0, 1000.0}) {
    const std::string size = "/1024x1024/aspect:" + std::to_string(static_cast<int>(aspect));
    add("bm_displacement_textbook" + size, bm_displacement_textbook, 1024, aspect);
    for (const simd::Isa isa : simd::supported()) {
      for (const int threads : {1, 2}) {
        add("bm_displacement" + size + "/" + std::string(simd::name(isa)) + "/threads:" + std::to_string(threads),
            bm_displacement, 1024, aspect, isa, threads);
      }
    }
  }
  add("bm_stress_pressure_textbook/128x128/6", bm_stress_textbook, 128);
  for (const simd::Isa isa : simd::supported()) {
    const std::string end = "/" + std::string(simd::name(isa)) + "/threads:";
    for (const int threads : {1, 2}) {
      const std::string on = end + std::to_string(threads);
      add("bm_stress_pressure/128x128/6" + on, bm_stress, 128, Traction::pressure, 6, isa, threads);
    }
    add("bm_stress_pressure/128x128/1" + end + "1", bm_stress, 128, Traction::pressure, 1, isa, 1);
    add("bm_stress_shear_x/128x128/6" + end + "1", bm_stress, 128, Traction::shear_x, 6, isa, 1);
    add("bm_stress_shear_y/128x128/6" + end + "1", bm_stress, 128, Traction::shear_y, 6, isa, 1);
  }
}

}  // namespace
}  // namespace brinell

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  brinell::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
