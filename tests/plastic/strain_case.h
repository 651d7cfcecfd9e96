// Random plastic strain in a box, and six fields in one place.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "fft/plan_cache.h"
#include "parallel/arena.h"
#include "plastic/eigenstrain_response.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

inline constexpr std::size_t kXx = 0, kYy = 1, kZz = 2, kYz = 3, kXz = 4, kXy = 5;

struct Engine {
  explicit Engine(int threads = 1, simd::Isa isa = simd::supported().back())
      : arena(threads), backend{arena, simd::kernels(isa), plans} {}
  parallel::Arena arena;
  fft::PlanCache plans;
  fft::Backend backend;
};

struct TensorField {
  TensorField(const Box& box, double value) : cuboids(box.cuboids()), memory(6 * cuboids, value) {}

  TensorArrays pointers() {
    TensorArrays tensor{};
    for (std::size_t c = 0; c < 6; ++c) tensor[c] = memory.data() + c * cuboids;
    return tensor;
  }
  TensorView pointers() const {
    TensorView tensor{};
    for (std::size_t c = 0; c < 6; ++c) tensor[c] = memory.data() + c * cuboids;
    return tensor;
  }
  double& at(std::size_t component, std::size_t cuboid) { return memory[component * cuboids + cuboid]; }
  double at(std::size_t component, std::size_t cuboid) const { return memory[component * cuboids + cuboid]; }

  std::size_t cuboids;
  std::vector<double> memory;
};

/// Without trace, within ±1.
inline TensorField random_strain(const Box& box, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  TensorField strain(box, 0);
  for (double& value : strain.memory) value = uniform(random);
  for (std::size_t n = 0; n < strain.cuboids; ++n) strain.at(kZz, n) = -strain.at(kXx, n) - strain.at(kYy, n);
  return strain;
}

inline TensorField stress_of(const Engine& engine, const Box& box, const TensorField& strain, double mu = 0.5,
                             double nu = 0.3) {
  TensorField stress(box, std::numeric_limits<double>::quiet_NaN());
  EigenstrainResponse response(engine.backend, box, mu, nu);
  const TensorField& given = strain;
  response.stress(given.pointers(), stress.pointers());
  return stress;
}

}  // namespace brinell::plastic
