#include "plastic/return_mapping.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"

namespace brinell::plastic {

namespace {

constexpr std::int64_t kChunk = 4096;  // points; its arrays stay in the second cache
static_assert(kChunk % static_cast<std::int64_t>(simd::kReturnBlock) == 0);

constexpr std::array<const char*, 6> kNames{"xx", "yy", "zz", "yz", "xz", "xy"};

void check_layers(std::size_t count, std::span<const double> layer_factor) {
  if (layer_factor.empty()) return;
  if (count % layer_factor.size() != 0) {
    fail(Status::invalid_argument, std::to_string(count) + " points in " + std::to_string(layer_factor.size()) +
                                       " layers; each layer must have as many");
  }
  for (std::size_t k = 0; k < layer_factor.size(); ++k) {
    const double factor = layer_factor[k];
    if (!(factor > 0) || !std::isfinite(factor)) {
      fail(Status::invalid_argument,
           "layer_factor[" + std::to_string(k) + "] is " + text(factor) + "; it must be positive and finite");
    }
  }
}

/// Factors of the points [begin, end) of a chunk, written into `memory`; null where all are 1.
const double* factors_of(std::size_t begin, std::size_t end, std::size_t count, std::span<const double> layer_factor,
                         double* memory) {
  if (layer_factor.empty()) return nullptr;
  const std::size_t layer_points = count / layer_factor.size();
  for (std::size_t i = begin; i < end;) {
    const std::size_t layer = i / layer_points, stop = std::min(end, (layer + 1) * layer_points);
    std::fill(memory + (i - begin), memory + (stop - begin), layer_factor[layer]);
    i = stop;
  }
  return memory;
}

double* behind(double* array, std::size_t begin) {
  return array != nullptr ? array + begin : nullptr;
}

[[noreturn]] void refuse(const TrialState& state, std::size_t i) {
  const double p = state.plastic_strain[i];
  std::string message = "point " + std::to_string(i) + ": ";
  if (!(p >= 0 && p <= 1e300)) {
    fail(Status::invalid_argument, message + "plastic_strain is " + text(p) + "; it must be at least 0 and finite");
  }
  message += "the trial stress is";
  for (std::size_t c = 0; c < 6; ++c) {
    message += std::string(c == 0 ? " " : ", ") + kNames[c] + " = " + text(state.trial[c][i]);
  }
  fail(Status::invalid_argument, message + " Pa; all must be finite, and the von Mises stress below 1e150");
}

}  // namespace

std::int64_t map_to_yield(const parallel::Arena& arena, const simd::KernelTable& kernels, const YieldCurve& law,
                          double shear_modulus, const TrialState& state, const MappedState& result) {
  if (!(shear_modulus > 0) || !std::isfinite(shear_modulus)) {
    fail(Status::invalid_argument,
         "shear_modulus is " + text(shear_modulus) + "; it must be positive and finite [Pa]");
  }
  check_layers(state.count, state.layer_factor);
  const auto n = static_cast<std::int64_t>(state.count);
  std::vector<simd::ReturnReport> reports(static_cast<std::size_t>((n + kChunk - 1) / kChunk));
  arena.for_chunks(n, kChunk, [&](std::int64_t from, std::int64_t to, int) {
    const auto begin = static_cast<std::size_t>(from), end = static_cast<std::size_t>(to);
    std::array<double, kChunk> factors;  // NOLINT(cppcoreguidelines-pro-type-member-init): written where read
    simd::ReturnPoints points;
    simd::ReturnResult target;
    for (std::size_t c = 0; c < 6; ++c) {
      points.trial[c] = state.trial[c] + begin;
      target.increment[c] = result.increment[c] + begin;
      target.stress[c] = behind(result.stress[c], begin);
    }
    points.plastic_strain = state.plastic_strain + begin;
    points.factor = factors_of(begin, end, state.count, state.layer_factor, factors.data());
    target.plastic_strain = result.plastic_strain + begin;
    target.von_mises = behind(result.von_mises, begin);
    target.theta = behind(result.theta, begin);
    target.theta_bar = behind(result.theta_bar, begin);
    target.moved = result.moved != nullptr ? result.moved + begin / simd::kReturnBlock : nullptr;
    kernels.return_mapping.map(end - begin, law.curve(), shear_modulus, points, target,
                               &reports[begin / static_cast<std::size_t>(kChunk)]);
  });
  std::int64_t plastic = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const std::size_t begin = k * static_cast<std::size_t>(kChunk);
    const std::size_t length = std::min(static_cast<std::size_t>(kChunk), state.count - begin);
    if (reports[k].refused < length) refuse(state, begin + reports[k].refused);
    plastic += static_cast<std::int64_t>(reports[k].plastic);
  }
  return plastic;
}

void yield_stresses(const parallel::Arena& arena, const simd::KernelTable& kernels, const YieldCurve& law,
                    std::size_t count, const double* plastic_strain, std::span<const double> layer_factor,
                    double* result) {
  check_layers(count, layer_factor);
  arena.for_chunks(static_cast<std::int64_t>(count), kChunk, [&](std::int64_t from, std::int64_t to, int) {
    const auto begin = static_cast<std::size_t>(from), end = static_cast<std::size_t>(to);
    std::array<double, kChunk> factors;  // NOLINT(cppcoreguidelines-pro-type-member-init): written where read
    kernels.return_mapping.yield_stress(end - begin, law.curve(), plastic_strain + begin,
                                        factors_of(begin, end, count, layer_factor, factors.data()), result + begin);
  });
}

}  // namespace brinell::plastic
