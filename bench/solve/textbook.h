// The contact solver as the papers have it, to compare with: I. A. Polonsky and L. M. Keer, "A numerical method for
// solving rough contact problems based on the multi-level multi-summation and conjugate gradient techniques" (1999),
// with the convolution by padded FFT (H. M. Stanley and T. Kato 1997; S. Liu, Q. Wang and G. Liu 2000). Two
// convolutions an iteration, K p for the gap and K t for the step; a loop for each formula; pressure from a uniform
// start (approach prescribed: from the interpenetration), rescaled to the load after every step; steepest descent
// again when nodes enter.
//
//   g = h + K p,   r = g − mean of g in contact        (approach prescribed: r = g − approach)
//   t = r + δ (G/G_old) t in contact, else 0           G = Σ r² in contact
//   q = K t, less its mean in contact                  (approach prescribed: not)
//   τ = Σ r t / Σ q t in contact,   p −= τ t, p = max(p, 0)
//   nodes with p = 0 and r < 0 enter: p −= τ r, δ = 0; else δ = 1
//   p *= prescribed / Σ p                              (approach prescribed: not)
//
// It stops on the certificate of contact/problem.h, whose displacement K p is the iteration's own: textbook pays no
// convolution for it. Pressure in units of E*.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "contact/problem.h"
#include "kernels/textbook_convolution.h"

namespace brinell::bench {

struct TextbookSolution {
  bool converged = false;
  double approach = 0;  // [m]
  contact::Certificate certificate;
  std::int32_t iterations = 0;
  std::int32_t convolutions = 0;
};

class Textbook {
 public:
  /// Plans the transforms by measure and fills the spectrum. gap [m] is copied.
  Textbook(const Grid& grid, Boundary boundary, const double* gap);

  /// Instead of the gap [m] so far. Copied.
  void set_gap(const double* gap);

  /// target: Σ p, or the approach [m]. observe, if not empty, is told the state before every
  /// iteration and at the end; pressure() belongs to it.
  TextbookSolution solve(contact::Drive drive, double target, double tolerance, std::int32_t max_iterations,
                         const std::function<void(const TextbookSolution&)>& observe = {});

  const std::vector<double>& pressure() const { return p_; }

 private:
  std::size_t nodes_;
  double unit_;  // of length: dx
  TextbookConvolution<double> compliance_;
  std::vector<double> gap_, p_, g_, r_, t_, q_, u_;
};

}  // namespace brinell::bench
