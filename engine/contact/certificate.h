// The proof that a state of contact solves the problem: see Certificate in contact/problem.h.
#pragma once

#include "contact/compliance.h"
#include "contact/passes.h"
#include "contact/problem.h"

namespace brinell::contact {

/// What a certificate is made of.
struct Evidence {
  double approach = 0;
  double total = 0;                 // Σ p
  double displacement = 0;          // largest
  double min_gap = 0;               // of the deformed surfaces, before the approach is taken off
  double complementarity = 0;       // Σ |p (gap − approach)|
  double tension_displacement = 0;  // that the largest tensile pressure causes
};

Certificate certificate_of(const Evidence& evidence, Drive drive, double target);

/// Recomputes the displacement of p, fills g and certifies. p must hold no tension.
struct Certified {
  double approach = 0;
  double total = 0;
  Certificate certificate;
};
Certified certify(const parallel::Arena& arena, const Compliance<double>& compliance, Passes<double>& passes,
                  std::size_t nodes, const UndeformedGap& gap, const double* p, double* g, Drive drive,
                  double target);

}  // namespace brinell::contact
