// How plastic strain follows the stress within an increment. Flow has the direction n = 3/2 s/σ_vM of the deviator s,
// which turns from n_0 where flow begins to n_1 at the end. An increment d of the plastic strain of length
// l = √(2/3 d:d) is
//
//   d = early + late,   early = (1 − θ) cos(d, n_0) l n_0,   late along n_1,   p = p_before + |early| + |late|,
//
// of second order in the increment for θ = 1/2 + O(l) (generalised trapezoidal rule: M. Ortiz & E. P. Popov, 1985;
// with θ = 1 it is the radial return, of first order), exact where the direction does not turn. While strain goes on
// in one direction the stress turns towards it with exp(−x), x = 3 mu l/σ_y; θ = 1/(1 − exp(−x)) − 1/x follows that
// exactly and goes to 1 for large increments, so that nothing oscillates (exponential fitting: W. Liniger & R. A.
// Willoughby, 1970). Flow begins at once or, after an elastic part, where the straight way from the stress
// before to the trial stress leaves the yield surface.
#pragma once

#include <array>

namespace brinell::plastic {

using PointTensor = std::array<double, 6>;  // xx yy zz yz xz xy

/// One point, by the present iterate of d.
struct PointFlow {
  PointTensor stress_before{};  // [Pa]
  PointTensor trial{};          // if d were elastic strain [Pa]
  PointTensor increment{};      // d
  double yield_stress = 0;      // before [Pa]
  double shear_modulus = 0;     // [Pa]
};

struct EarlyFlow {
  PointTensor strain{};
  double equivalent = 0;  // √(2/3 strain:strain)
};

/// No more than what the trial stress exceeds the yield stress by: none where it does not.
EarlyFlow early_flow(const PointFlow& point);

/// √(2/3 a:a)
double equivalent_strain(const PointTensor& strain);

/// One point at the end of an increment with flow.
struct FlowEnds {
  PointTensor before{}, after{};             // stress [Pa]
  PointTensor early{}, late{};               // of the increment; late is not zero
  double yield_before = 0, yield_after = 0;  // [Pa]
  double shear_modulus = 0;                  // [Pa]
};

/// Estimate of what the increment is wrong by, as stress relative to the yield stress: the larger of
/// 3 mu |early − |early| n_1|/σ_y, the distance from an increment of first order, and, where flow began within the
/// increment so that only the ends of an elastic part are known, 3 mu/2 |d|/σ_y times the sagitta e (1 − e) Δσ/σ_y of
/// a bent way, with e the elastic share. Both go with the square of the increment.
double flow_error(const FlowEnds& ends);

}  // namespace brinell::plastic
