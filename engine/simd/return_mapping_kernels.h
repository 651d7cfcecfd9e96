// Radial return of many points at a time; conventions and formulas stand in engine/plastic/return_mapping.h, the laws
// in engine/plastic/hardening.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brinell::simd {

enum class HardeningForm : std::int32_t { power, linear, voce, table };

/// Yield stress over equivalent plastic strain, Y(p), never falling. Each form reads its own members.
struct HardeningCurve {
  HardeningForm form = HardeningForm::linear;
  double initial = 0;  // Y(0) [Pa]

  // power: the larger of onset and coefficient·(offset + scale·p)^exponent, 0 < exponent < 1
  double coefficient = 0, offset = 0, scale = 1, exponent = 1, onset = 0;
  // linear: initial + modulus·p
  double modulus = 0;
  // voce: initial + amplitude·(1 − exp(−rate·p))
  double amplitude = 0, rate = 1;
  // table: cubic between its points, which begin at p = 0, with these slopes there; constant beyond the last
  std::size_t count = 0;
  const double* strain = nullptr;
  const double* stress = nullptr;
  const double* slope = nullptr;
};

/// Trial stress at n points: one array of n values for each of xx yy zz yz xz xy; equivalent plastic strain before;
/// factor on the yield stress (null: 1).
struct ReturnPoints {
  const double* trial[6] = {};
  const double* plastic_strain = nullptr;
  const double* factor = nullptr;
};

/// Points that are handled together; the last may be fewer.
inline constexpr std::size_t kReturnBlock = 128;

/// Each array but increment and plastic_strain may be null, stress all six or none. plastic_strain and stress may be
/// the arrays of the points. moved, unless null, has one value for each block: 0 if in what stands there the
/// increments are zero and the plastic strain is that of the points; such blocks are not written again as long as
/// they stay elastic.
struct ReturnResult {
  double* increment[6] = {};
  double* plastic_strain = nullptr;
  double* von_mises = nullptr;
  double* stress[6] = {};
  double* theta = nullptr;
  double* theta_bar = nullptr;
  std::uint8_t* moved = nullptr;
};

struct ReturnReport {
  std::size_t plastic = 0;  // points that yielded
  std::size_t refused = 0;  // the first whose stress or plastic strain is out of range, else n; what lies in its
                            // block and behind is not written
};

struct ReturnMappingKernels {
  void (*map)(std::size_t n, const HardeningCurve& curve, double shear_modulus, const ReturnPoints& points,
              const ReturnResult& result, ReturnReport* report);

  /// factor·Y(p); factor null: 1. p >= 0.
  void (*yield_stress)(std::size_t n, const HardeningCurve& curve, const double* plastic_strain, const double* factor,
                       double* result);
};

}  // namespace brinell::simd
