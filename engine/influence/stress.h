// Stress at depth z >= 0 below a cell |x| <= a, |y| <= b (dx = 2a, dy = 2b) of the surface under a unit uniform
// pressure p or shear q_x, q_y, at the offsets (x, y) = (i·dx, j·dy). Tension is positive, z points into the body;
// p > 0 presses (σ_zz = −p below the cell at z = 0), q_x > 0 pushes the surface along +x (σ_xz = −q_x there).
//
// Near the cell σ = (1/2π) S[F], S the difference of F over the corners X = x ± a, Y = y ± b (A. E. H. Love, 1929,
// for p; K. L. Johnson, Contact Mechanics, 1985, §3.6 for q), with ρ² = X² + Y² + z² and m = 1 − 2ν:
//
//        p                                                              q_x
//   xx   −2ν at(XY, zρ) + zXY/((X²+z²)ρ) − m at(XY, X²+z²+zρ)          2 ln(Y+ρ) + X²Y/((X²+z²)ρ) − mY/(ρ+z)
//   yy   −2ν at(XY, zρ) + zXY/((Y²+z²)ρ) − m at(XY, Y²+z²+zρ)          2ν ln(Y+ρ) − Y/ρ + mY/(ρ+z)
//   zz   −at(XY, zρ) − zXY/ρ (1/(X²+z²) + 1/(Y²+z²))                   z²Y/((X²+z²)ρ)
//   yz   z²X/((Y²+z²)ρ)                                                −z/ρ
//   xz   z²Y/((X²+z²)ρ)                                                −at(XY, zρ) + zXY/((X²+z²)ρ)
//   xy   −m ln(z+ρ) − z/ρ                                              ln(X+ρ) − X/ρ + mX/(ρ+z)
//
// at = atan2, never a quotient, so that z = 0 and every sign of X, Y need nothing special (on the cell's edge at
// z = 0 it gives the mean of both sides). q_y is q_x with x and y exchanged. The corner sums lose ε·d² of their
// digits at d cells; further away the point forces of Boussinesq and Cerruti (Johnson, eqs. 3.19 and 3.76, in the
// form that is finite on the axis) are integrated over the cell by Gauss-Legendre rules, fewer nodes with distance.
//
// Error: at most 1e-10 (for ν <= 0.3: 2e-13) of the largest component at the point, for cells up to 1:10. Beside
// longer cells the corner sums keep their absolute error, a few roundings of the unit traction.
#pragma once

#include <array>
#include <cstdint>

#include "fft/convolution.h"
#include "simd/influence_kernels.h"

namespace brinell::parallel {
class Arena;
}
namespace brinell::simd {
struct KernelTable;
}

namespace brinell::influence {

enum class Traction : std::int32_t { pressure = 0, shear_x = 1, shear_y = 2 };
enum class StressComponent : std::int32_t { xx = 0, yy = 1, zz = 2, yz = 3, xz = 4, xy = 5 };

struct Parities {
  fft::Parity x, y;
};

/// How a coefficient continues to negative offsets.
Parities stress_parities(Traction traction, StressComponent component);

class Stress {
 public:
  /// Sides of the cell [m] positive, depth [m] not negative, all finite; −1 < poissons_ratio < 0.5.
  /// Throws Status::invalid_argument.
  Stress(double dx, double dy, double depth, double poissons_ratio);

  /// The six components at one offset, any distance.
  std::array<double, 6> operator()(Traction traction, std::int64_t i, std::int64_t j) const;

  /// coefficients[c][j·nx + i] for 0 <= i < nx, 0 <= j < ny and every component c whose pointer is not null.
  void fill(const parallel::Arena& arena, const simd::KernelTable& kernels, Traction traction, std::int64_t nx,
            std::int64_t ny, const std::array<double*, 6>& coefficients) const;

 private:
  void fill_row(const simd::InfluenceKernels& kernels, Traction traction, std::int64_t j, std::int64_t first,
                std::int64_t count, const simd::StressRows& rows) const;

  // Lengths in units of a power of two near the longer side: exact, and safe from overflow.
  double dx_, dy_;
  simd::StressCell cell_;
};

}  // namespace brinell::influence
