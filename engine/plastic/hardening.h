// Isotropic hardening: the yield stress σ_y [Pa] over the equivalent plastic strain p >= 0. It never falls.
//
//   swift           B (C + strain_scale·p)^n                                   (H. W. Swift, 1952)
//   linear          yield_stress + hardening_modulus·p
//   perfect         yield_stress
//   voce            saturation_stress − (saturation_stress − yield_stress)·exp(−rate·p)      (E. Voce, 1948)
//   Ramberg-Osgood  p = (σ_y/K)^m; with a yield_stress the larger of both, so that the curve stays what it is and
//                   begins with a plateau; without one the body flows from zero stress on (Ramberg & Osgood, 1943)
//   table           monotone piecewise cubic through the points (Fritsch & Carlson, 1980, with the slopes of Fritsch
//                   & Butland, 1984), constant beyond the last
//
// Swift with C = 0 and Ramberg-Osgood without a yield_stress are zero at p = 0; there σ_y is that of the least strain
// a double holds well, strain_scale·p = 2^−1000. With depth_factor every law is multiplied by a factor that depends
// on the depth alone, linear between the points of its table and constant beyond them.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "simd/return_mapping_kernels.h"

namespace brinell::plastic {

struct Swift {
  double B = 0;               // [Pa] > 0
  double C = 0;               // >= 0
  double n = 0;               // 0 to 1
  double strain_scale = 1e6;  // > 0
};

struct LinearHardening {
  double yield_stress = 0;       // [Pa] > 0
  double hardening_modulus = 0;  // [Pa] d stress/d p, >= 0
};

struct PerfectPlasticity {
  double yield_stress = 0;  // [Pa] > 0
};

struct Voce {
  double yield_stress = 0;       // [Pa] > 0
  double saturation_stress = 0;  // [Pa] >= yield_stress
  double rate = 0;               // > 0
};

struct RambergOsgood {
  double K = 0;             // [Pa] > 0
  double m = 0;             // >= 1
  double yield_stress = 0;  // [Pa] >= 0; 0: flow from zero
};

struct HardeningTable {
  std::vector<double> plastic_strain;  // rising from 0
  std::vector<double> stress;          // [Pa] > 0, never falling; as many
};

using HardeningLaw = std::variant<Swift, LinearHardening, PerfectPlasticity, Voce, RambergOsgood, HardeningTable>;

struct DepthFactor {
  double depth = 0;   // [m] >= 0
  double factor = 1;  // > 0
};

struct Hardening {
  HardeningLaw law;
  std::vector<DepthFactor> depth_factor;  // rising depths; empty: 1 everywhere
};

/// Throws Status::invalid_argument with the name of the member, its value and what is allowed.
void check(const Hardening& hardening);

/// A law in the form that kernels take, with the memory of its table. Immutable.
class YieldCurve {
 public:
  /// Checks the description.
  explicit YieldCurve(const Hardening& hardening);
  YieldCurve(const YieldCurve&) = delete;
  YieldCurve& operator=(const YieldCurve&) = delete;

  const simd::HardeningCurve& curve() const { return curve_; }

  /// σ_y [Pa] for the factor 1; p >= 0.
  double yield_stress(double p) const;

  double factor_at(double depth) const;
  /// Throws for a depth that is negative or no number.
  std::vector<double> factors_at(std::span<const double> depths) const;

 private:
  void use(const Swift& law);
  void use(const LinearHardening& law);
  void use(const PerfectPlasticity& law);
  void use(const Voce& law);
  void use(const RambergOsgood& law);
  void use(const HardeningTable& law);
  void use_power(double coefficient, double offset, double scale, double exponent, double onset);

  simd::HardeningCurve curve_;
  std::vector<double> strain_, stress_, slope_;
  std::vector<DepthFactor> depth_factor_;
};

}  // namespace brinell::plastic
