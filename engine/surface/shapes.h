// Formula shapes of the gap. Each is zero at its apex and grows outwards; the gap is the plain sum of all entries.
// Every shape is finite everywhere, also where the exact solid has ended.
//
// Circular arcs of radius R at the distance t from their apex, with q = t²/R:
//   parabolic: q/2
//   exact:     R − sqrt(R² − t²), written q / (1 + sqrt(1 − q/R)), which loses no digits for t << R.
//              Beyond the end of the arc, t > R, the square root is left out: it continues as q, from the height R
//              on, without a jump.
#pragma once

#include <cstdint>
#include <span>
#include <variant>

#include "base/grid.h"
#include "parallel/arena.h"

namespace brinell::surface {

enum class Profile : std::int32_t { parabolic = 0, exact = 1 };

struct Plane {};

struct Sphere {
  double radius = 0;  // [m]
  Profile profile = Profile::parabolic;
};

/// Principal radii of curvature at the apex; infinite: straight in that direction. Parabolic:
/// x²/(2 radius_x) + y²/(2 radius_y). Exact: the ellipsoid of revolution about its longer axis, whose vertical
/// semi-axis is the smaller radius, so that equal radii give the sphere; with q = x²/radius_x + y²/radius_y and that
/// semi-axis in place of R, the formula of the arc holds.
struct Ellipsoid {
  double radius_x = 0;  // [m]
  double radius_y = 0;  // [m]
  Profile profile = Profile::parabolic;
};

/// Cone with a spherical tip that it touches tangentially, at the distance tip_radius·cos(half_angle) from the axis.
/// Zero at the apex of the tip; the tip is always an exact arc.
struct Cone {
  double half_angle = 0;  // [rad] between axis and flank, as in Sneddon 1965
  double tip_radius = 0;  // [m]; 0: sharp
};

/// Zero within radius; beyond it an arc of edge_radius that starts tangentially, t = distance from the axis − radius.
struct FlatPunch {
  double radius = 0;       // [m] of the flat
  double edge_radius = 0;  // [m]
  Profile profile = Profile::parabolic;
};

/// Roller with its axis along x: radius across it, generatrix straight over straight_length, centred, and crowned
/// beyond by arcs that start tangentially. Parabolic: the sum of the crown's drop c(x) and y²/(2 radius). Exact: the
/// solid of revolution, c(x) plus the arc across of the local radius, radius − c(x); where the crown has dropped by
/// more than half the radius, radius/2 is used, which keeps the gap finite.
struct Roller {
  double radius = 0;           // [m]
  double straight_length = 0;  // [m] the whole of it, from crown to crown
  double crown_radius = 0;     // [m]
  Profile profile = Profile::parabolic;
};

/// amplitude · (1 − cos(2 pi x / wavelength_x) · cos(2 pi y / wavelength_y)): a crest at the centre touches first,
/// and the deepest valley is 2·amplitude below it. A wavelength of 0 or infinity: constant in that direction.
struct Sinusoid {
  double amplitude = 0;     // [m] half the height from valley to crest
  double wavelength_x = 0;  // [m]
  double wavelength_y = 0;  // [m]
};

using Shape = std::variant<Plane, Sphere, Ellipsoid, Cone, FlatPunch, Roller, Sinusoid>;

/// Where an entry's origin lies relative to the centre of the grid [m].
struct Centre {
  double x = 0;
  double y = 0;
};

/// Throws Status::invalid_argument for parameters that describe no such shape.
void check(const Shape& shape);

/// gap += shape, at every node. On a periodic boundary what leaves the grid on one side comes back on the other.
void add_to_gap(const Shape& shape, Centre centre, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena, Boundary boundary = Boundary::free);

}  // namespace brinell::surface
