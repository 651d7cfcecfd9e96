// Conjugate gradients for the constrained problem on one grid.
//
// A node is in contact where its pressure is more than what its gap r would let it lose: p > c r, c a part of the
// cell's own stiffness (the active set of M. Hintermueller, K. Ito & K. Kunisch, 2002, with c small: it is asked in
// every iteration). The direction is kept conjugate to the last one across small changes of that set (E. A. H.
// Vollebregt, "The bound-constrained conjugate gradient method for non-negative matrices", 2014), after I. A.
// Polonsky and L. M. Keer (1999). Each iteration costs one convolution:
//
//   r = gap − approach; a prescribed force makes the approach the mean gap, weighted by the
//       pressure: nodes that are about to leave hardly count; prescribed moments make it the
//       linear trend of the gap, weighted alike
//   z = preconditioner · r in contact, less its mean there if the force is prescribed,
//       or its linear trend if its moments are as well
//   w = max(β w − λ z, −p) in contact, else −p: all that a node has when it leaves
//   w is shifted where it is free, w > −p, so that p + w meets the load
//   q = K w,  α = −r·w / w·q over the free part, or 1 where what leaves has more work, |r·w|, than that
//   p += α w, gap += α q
//
// What leaves the contact is part of the direction, so that the displacement needs no second convolution for it; and
// since the step is that of the free part alone, the residual it leaves is orthogonal to that part, which is what
// conjugacy asks. λ is what the steps before wanted. A step longer than one takes more pressure than nodes had; that
// tension is part of the next direction like all that is out of contact. Before convergence is declared it is
// clipped, which a factor on the pressure makes up for, linear in the place where moments are prescribed, and the
// certificate that is reported comes from a fresh convolution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/buffer.h"
#include "contact/certificate.h"
#include "contact/compliance.h"
#include "contact/passes.h"
#include "contact/preconditioner.h"
#include "contact/problem.h"

namespace brinell::contact {

/// What a level starts from and ends with, borrowed: pressure p [E*], and the gap of the deformed surfaces before the
/// approach is taken off, g = h + K p.
struct Fields {
  double* p;
  double* g;
};

struct LevelResult {
  bool converged = false;
  LinearTrend approach;
  double total = 0;  // Σ p
  Certificate certificate;
  std::int32_t iterations = 0;
  std::int32_t convolutions = 0;
};

/// Real = float: directions in single precision, pressure, gap and certificate in double.
template <class Real>
class Level {
 public:
  /// exact is the compliance of this grid.
  Level(const Resources& resources, const Compliance<double>& exact, const PlacedGrid& placed, Boundary boundary,
        const UndeformedGap& gap, Fields fields);

  /// One preconditioned step from a start whose displacement is known approximately: on entry p is the pressure and g
  /// that displacement. It brings in what a coarser grid could not know.
  void correct_start(const Load& load);

  /// load.target: Σ p > 0, or the approach. Starts from fields.p.
  LevelResult solve(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);

  /// Bytes of one on such a grid, without the exact compliance.
  static std::size_t bytes(const fft::Backend& backend, const Grid& grid, Boundary boundary);

 private:
  void prescribe(const Load& load);
  void add_uniform_pressure();
  bool meet_load();
  void refresh(LevelResult& result);
  PlaneSums pressure() const;
  simd::SlopeSums redirect(double beta, const LinearTrend& trend_v, double scale, const LinearTrend& trend_z);
  Certificate estimate(const simd::ResidualSums& residual) const;

  const parallel::Arena& arena_;
  PlacedGrid placed_;
  UndeformedGap gap_;
  Fields fields_;
  double self_compliance_;

  const Compliance<double>& exact_;
  std::unique_ptr<Compliance<float>> fast_;  // Real = float
  Preconditioner<Real> preconditioner_;
  Passes<Real> passes_;
  Buffer<Real> v_, q_, z_;

  // Of the present state:
  Load load_;
  Freedom freedom_ = Freedom::none;
  double displacement_ = 0;  // largest, as of the last fresh convolution
  LinearTrend approach_;
  AdvanceTotals sums_;
};

}  // namespace brinell::contact
