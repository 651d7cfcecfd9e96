// The proof that a state of contact solves the problem: see Certificate in contact/problem.h.
#pragma once

#include "contact/compliance.h"
#include "contact/passes.h"
#include "contact/problem.h"

namespace brinell::contact {

/// What a certificate is made of.
struct Evidence {
  PlaneSums pressure;               // Σ p and, for a load with moments, Σ p x, Σ p y
  double displacement = 0;          // largest
  double depth = 0;                 // largest approach − gap of the deformed surfaces, or 0
  double complementarity = 0;       // Σ |p (gap − approach)|
  double tension_displacement = 0;  // that the largest tensile pressure causes
};

Certificate certificate_of(const Evidence& evidence, const Load& load, const Grid& grid);

/// What follows from equilibrium, and what it starts from: the prescribed approach and slopes, as far as they are.
Freedom freedom_of(const Load& load);
LinearTrend prescribed_approach(const Load& load);

/// The weighted fits below call places this close, in squares of the spacing, one point.
inline constexpr double kOnePoint = 1e-9;

/// Recomputes the displacement of p, fills g and certifies. p must hold no tension.
struct Certified {
  LinearTrend approach;
  double total = 0;
  Certificate certificate;
};
Certified certify(const parallel::Arena& arena, const Compliance<double>& compliance, Passes<double>& passes,
                  const PlacedGrid& placed, const UndeformedGap& gap, const double* p, double* g, const Load& load);

}  // namespace brinell::contact
