// Radial return of rate-independent von Mises plasticity with isotropic hardening (M. L. Wilkins, 1964; J. C. Simo &
// R. L. Taylor, 1985), for many points at a time. At each point, with the trial stress that holds if the strain
// increment is elastic, s its deviator, q = √(3/2 s:s), p the equivalent plastic strain before and f the factor on
// the yield stress:
//
//   q <= f σ_y(p):  elastic, nothing changes
//   else:           f σ_y(p + flow) + 3 mu flow = q                 flow > 0, the increment of p
//                   increment = 3/2 flow s/q                        plastic strain: tensor components, deviatoric
//                   stress    = trial − 2 mu increment              whose von Mises stress is f σ_y(p + flow)
//
// In an elastic-plastic contact the total strain is held fixed while a point returns, so that with the increment d of
// the last iteration the trial stress is (contact stress) + (residual stress of plastic strain before + d) + 2 mu d.
//
// Linearised, with the unit direction N = s/|s| (that of the increment where there is one), P the deviatoric part and
// strain the total strain of the step:
//
//   d stress          = K tr(d strain) 1 + 2 mu (theta P − theta_bar N N) : d strain
//   2 mu d increment  = ((1 − theta) P + theta_bar N N) : d trial
//   theta = (q after)/q,  theta_bar = 3 mu/(3 mu + f dσ_y/dp) − (1 − theta);  1 and 0 where elastic
//
// Components in the order xx yy zz yz xz xy, SI units. A stress within 2^−46 above the yield stress lies on it. The
// yield condition holds to some 1e-15 of the yield stress, 1e-13 at the ends of the range of doubles; in a law so
// steep that neighbouring doubles p differ by more, it holds at the p returned. von Mises stresses from 1e-150 to
// 1e150 Pa; below they are zero. Each point's result is a function of its own data alone: for one instruction set the
// same bits wherever it stands and for any number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "parallel/arena.h"
#include "plastic/hardening.h"
#include "plastic/tensor_fields.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

/// count points in layer_factor.size() layers of equally many points, one layer after the other.
struct TrialState {
  std::size_t count = 0;
  TensorView trial{};                      // [Pa]
  const double* plastic_strain = nullptr;  // equivalent, before; >= 0
  std::span<const double> layer_factor{};  // on the yield stress, > 0; empty: one layer with the factor 1
};

/// For loops that return the same points again and again, most of them elastic: one value for each block of points, 0
/// if the block's increments are zero and its plastic strain after is the one before. The caller sets it so for what
/// stands in the arrays at first (1 is always right); the return keeps it, and leaves blocks that were and stay 0
/// unwritten, which saves half of their memory traffic.
constexpr std::size_t moved_size(std::size_t count) {
  return (count + simd::kReturnBlock - 1) / simd::kReturnBlock;
}

/// Arrays of count values. increment may not overlap what is read; plastic_strain and stress may be arrays of the
/// TrialState, which they then replace. Null but for the first two: not wanted; stress all six or none.
struct MappedState {
  TensorArrays increment{};          // of plastic strain
  double* plastic_strain = nullptr;  // equivalent, after
  double* von_mises = nullptr;       // after [Pa]
  TensorArrays stress{};             // after [Pa]
  double* theta = nullptr;           // of the tangent
  double* theta_bar = nullptr;
  std::uint8_t* moved = nullptr;  // moved_size(count) values, 0 or 1
};

/// Returns how many points yielded. Throws Status::invalid_argument with the index of the first point whose trial
/// stress or plastic strain is not finite or out of range; what is written is then incomplete.
std::int64_t map_to_yield(const parallel::Arena& arena, const simd::KernelTable& kernels, const YieldCurve& law,
                          double shear_modulus, const TrialState& state, const MappedState& result);

/// The yield stress f σ_y(p) [Pa] of points arranged like those of TrialState; plastic strains are not checked.
void yield_stresses(const parallel::Arena& arena, const simd::KernelTable& kernels, const YieldCurve& law,
                    std::size_t count, const double* plastic_strain, std::span<const double> layer_factor,
                    double* result);

}  // namespace brinell::plastic
