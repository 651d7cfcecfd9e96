// An engine of its own for a request, and its fields in one place.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "fft/plan_cache.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"
#include "subsurface/stress_field.h"

namespace brinell::subsurface {

inline constexpr int kXx = 0, kYy = 1, kZz = 2, kYz = 3, kXz = 4, kXy = 5;
inline constexpr Sources kAllSources{Traction::pressure, Traction::shear_x, Traction::shear_y};

struct Engine {
  explicit Engine(int threads = 1, simd::Isa isa = simd::supported().back())
      : arena(threads), backend{arena, simd::kernels(isa), plans} {}
  parallel::Arena arena;
  fft::PlanCache plans;
  fft::Backend backend;
};

struct Fields {
  std::array<std::vector<double>, kComponents> component;
  std::array<std::vector<double>, kInvariants> invariant;
  std::array<std::vector<double>, 9> direction;
  Maxima maxima{};

  std::array<double, 6> at(std::size_t index) const {
    std::array<double, 6> six{};
    for (std::size_t c = 0; c < 6; ++c) six[c] = component[c].empty() ? 0.0 : component[c][index];
    return six;
  }
};

/// Everything the request names, in memory that was not a number before.
inline Fields computed(const Engine& engine, const StressRequest& request, const Tractions& tractions,
                       std::size_t spectra_limit = 0, int calls = 1) {
  const std::size_t size = request.grid.nodes() * request.depths.size();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  Fields fields;
  StressFields targets;
  for (std::size_t c = 0; c < kComponents; ++c) {
    if (!request.components.has(static_cast<int>(c))) continue;
    fields.component[c].assign(size, nothing);
    targets.component[c] = fields.component[c].data();
  }
  for (std::size_t k = 0; k < kInvariants; ++k) {
    if (!request.invariants.has(static_cast<int>(k))) continue;
    fields.invariant[k].assign(size, nothing);
    targets.invariant[k] = fields.invariant[k].data();
  }
  for (std::size_t k = 0; k < 9 && request.directions; ++k) {
    fields.direction[k].assign(size, nothing);
    targets.direction[k] = fields.direction[k].data();
  }
  StressField stress(engine.backend, request, spectra_limit);
  for (int call = 0; call < calls; ++call) fields.maxima = stress.compute(tractions, targets);
  return fields;
}

/// Three fields of tractions within ±1, and pointers to them.
struct RandomTractions {
  explicit RandomTractions(const Grid& grid, unsigned seed = 1) : nodes(grid.nodes()), values(3 * nodes) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (double& value : values) value = uniform(random);
  }
  Tractions pointers() const { return {values.data(), values.data() + nodes, values.data() + 2 * nodes}; }
  std::size_t nodes;
  std::vector<double> values;
};

/// Averages over the cells of √(1 − r²/a²), one beyond it zero: exact along y, many strips along x.
inline std::vector<double> hertz_pressure(const Grid& grid, double a) {
  constexpr int strips = 400;
  const auto primitive = [](double c, double y) {  // ∫ √(c² − y²) dy
    const double inside = std::min(1.0, std::max(-1.0, y / c));
    return 0.5 * c * c * (inside * std::sqrt(1 - inside * inside) + std::asin(inside));
  };
  std::vector<double> pressure(grid.nodes());
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      double sum = 0;
      for (int strip = 0; strip < strips; ++strip) {
        const double x = (grid.x(i) + grid.dx * ((strip + 0.5) / strips - 0.5)) / a;
        if (std::abs(x) >= 1) continue;
        const double c = std::sqrt(1 - x * x), half = 0.5 * grid.dy / a, y = grid.y(j) / a;
        sum += (primitive(c, y + half) - primitive(c, y - half)) / (2 * half);
      }
      pressure[static_cast<std::size_t>(j * grid.nx + i)] = sum / strips;
    }
  }
  return pressure;
}

}  // namespace brinell::subsurface
