// Invariants of the stress tensor, tension positive, components in the order xx yy zz yz xz xy.
//
//   von Mises    √( ((σ_xx − σ_yy)² + (σ_yy − σ_zz)² + (σ_zz − σ_xx)²)/2 + 3 (σ_yz² + σ_xz² + σ_xy²) )
//   Tresca       σ_1 − σ_3, twice the largest shear stress
//   hydrostatic  (σ_xx + σ_yy + σ_zz)/3, negative under pressure
//   principal    σ_1 >= σ_2 >= σ_3, with unit directions at right angles to each other, their signs without meaning
//
// Principal values come from Jacobi rotations (C. G. J. Jacobi, 1846): an absolute error of a few roundings of the
// largest component, also where two or all three coincide; there the directions are some orthonormal choice.
// Stresses may reach 1e150: their squares are formed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "simd/subsurface_kernels.h"

namespace brinell::simd {
struct KernelTable;
}

namespace brinell::subsurface {

enum class Invariant : std::int32_t {
  von_mises = 0,
  tresca = 1,
  hydrostatic = 2,
  principal_1 = 3,  // the largest
  principal_2 = 4,
  principal_3 = 5,
};
inline constexpr int kInvariants = 6;

using Tensor = std::array<double, 6>;

struct Principal {
  std::array<double, 3> value;                     // falling
  std::array<std::array<double, 3>, 3> direction;  // direction[k] belongs to value[k]
};

double von_mises(const Tensor& stress);
double tresca(const Tensor& stress);
double hydrostatic(const Tensor& stress);
Principal principal(const Tensor& stress);

/// Where the invariants of n tensors go; null: not wanted, not computed. Directions are wanted all nine or none.
struct InvariantArrays {
  std::array<double*, kInvariants> invariant{};  // by Invariant
  std::array<double*, 9> direction{};            // [3·k + axis]
};

/// Each value is a function of its own tensor alone, whatever n.
void fill_invariants(const simd::KernelTable& kernels, std::size_t n, const simd::StressArrays& stress,
                     const InvariantArrays& result);

}  // namespace brinell::subsurface
