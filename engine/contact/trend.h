// Linear functions of the place on the surface, and their least-squares fit: the approach of bodies that may tilt,
// the trend of a residual, the factor that makes a pressure meet its force and moments.
//
// With φ = (1, x, y), weights w and values f at the nodes, the fit a minimises Σ w (f − a·φ)², that is
//
//   (Σ w φ φᵀ) a = Σ w f φ.
//
// Two slopes take the trend of a residual out in each iteration (S. Spinu, "Numerical simulation of elastic
// contact under tilting torque", 2008, eq. 11-13, there along one axis).
#pragma once

#include <cstdint>

#include "simd/contact_kernels.h"

namespace brinell::contact {

/// constant + x·X + y·Y at the place (X, Y), in unit lengths from the centre of the whole grid.
struct LinearTrend {
  double constant = 0, x = 0, y = 0;

  double at(double place_x, double place_y) const { return constant + x * place_x + y * place_y; }

  /// Along a row at the height place_y, from place_x on.
  simd::Line along(double place_x, double place_y, double spacing) const {
    return {at(place_x, place_y), x * spacing};
  }
};

/// Which of its coefficients follow from the equilibrium of force and moments.
enum class Freedom : std::int32_t { none, constant, linear };

/// Σ s φ.
struct PlaneSums {
  double one = 0, x = 0, y = 0;
};

/// Σ s a·φ.
inline double dot(const LinearTrend& a, const PlaneSums& s) {
  return a.constant * s.one + a.x * s.x + a.y * s.y;
}

/// Σ w φ φᵀ.
struct PlaneWeights {
  double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  /// Of these weights times the trend: Σ w a·φ φ.
  PlaneSums times(const LinearTrend& a) const;
};

/// The trend a with weights·a = sums that differs from start in its free coefficients alone, and from start's slopes
/// not at all where the weights lie on a point or a line that leaves them undetermined. least_variance: of the places
/// [unit lengths²], below which they count as a point. weights.one > 0.
LinearTrend fit(Freedom freedom, const PlaneWeights& weights, const PlaneSums& sums, const LinearTrend& start,
                double least_variance);

}  // namespace brinell::contact
