// A force that acts beside the centre as the older paper has it, to compare with: Newton's method for the tilt around
// the centric solver (S. Spinu and E. Diaconescu, "Numerical simulation of elastic conforming contacts under
// eccentric loading", IJTC 2008; S. Spinu and C. Suciu, "Numerical simulation of elastic finite length line contact
// under eccentric loading", 2008, eq. 5 to 12). The slope s along x is added to the gap as a plane; the tilt about
// the other axis is left out, which saves the textbook a third of its solutions:
//
//   F(s) = force·x0 − Σ p(s) x,   s −= F(s)·Δ / (F(s + Δ) − F(s))
//
// Each step costs two centric solutions, each from a uniform pressure, and one more tells that the last step
// suffices.
#pragma once

#include <cstdint>
#include <vector>

#include "solve/textbook.h"

namespace brinell::bench {

struct NestedSolution {
  bool converged = false;
  double slope = 0;
  contact::Certificate certificate;  // the moment included
  std::int32_t steps = 0;            // of Newton's method
  std::int32_t solutions = 0;        // centric ones
  std::int32_t iterations = 0;       // in all of them
  std::int32_t convolutions = 0;
};

class NestedNewton {
 public:
  /// gap [m] is copied.
  NestedNewton(const Grid& grid, const double* gap);

  /// target: Σ p; x0: where the force acts [m]; tolerance: on the certificate.
  NestedSolution solve(double target, double x0, double tolerance, std::int32_t max_iterations);

  const std::vector<double>& pressure() const { return centric_.pressure(); }

 private:
  double miss(double slope, double target, double x0, double tolerance, std::int32_t max_iterations,
              NestedSolution& result);

  Grid grid_;
  std::vector<double> gap_, tilted_;
  Textbook centric_;
};

}  // namespace brinell::bench
