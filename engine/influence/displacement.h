// Normal surface displacement u_z of an elastic half-space under a unit uniform pressure on a rectangular cell
// |x| <= a, |y| <= b, dx = 2a, dy = 2b, at the offset (x, y) = (i·dx, j·dy) (A. E. H. Love, 1929):
//
//   u_z = K p / E*,   K(i, j) = (1/π) ∬ dξ dη / √((x − ξ)² + (y − η)²)   [m],
//
// of geometry alone, even in i and in j; E* may be that of two bodies, u_z is then their sum. u_z > 0 into the
// body. Love's closed form subtracts numbers of size d·ln d to get 1/d at d cells' distance and so loses ε·d²·ln d.
// Here each region has a form without cancellation:
//
//   i, j < 4             closed form, its differences paired in log1p, in long double
//   r < 16 longer sides  Gauss-Legendre quadrature in the direction of the larger of i and j (the integrand's
//                        nearest singularity is max(i, j) cells away in that direction, whatever dx/dy) of the
//                        exact integral across it
//   beyond               multipole series Σ_s r^(−1−2s) Q_s(x²/r²), s < 6 (fewer further out)
#pragma once

#include <cstdint>

#include "simd/influence_kernels.h"

namespace brinell::parallel {
class Arena;
}
namespace brinell::simd {
struct KernelTable;
}

namespace brinell::influence {

class Displacement {
 public:
  /// Sides of the cell [m]: positive and finite. Throws Status::invalid_argument.
  Displacement(double dx, double dy);

  /// K(i, j) [m] of one offset, any distance.
  double operator()(std::int64_t i, std::int64_t j) const;

  /// coefficients[j·nx + i] = K(i, j) for 0 <= i < nx, 0 <= j < ny.
  void fill(const parallel::Arena& arena, const simd::KernelTable& kernels, std::int64_t nx, std::int64_t ny,
            double* coefficients) const;

 private:
  void fill_row(const simd::InfluenceKernels& kernels, std::int64_t j, std::int64_t first, std::int64_t count,
                double* row) const;
  double closed_form(std::int64_t i, std::int64_t j) const;

  // Lengths in units of a power of two near the longer side: exact, and safe from overflow.
  double unit_;
  double dx_, dy_;
  double longer_;
  simd::DisplacementSeries series_;
};

}  // namespace brinell::influence
