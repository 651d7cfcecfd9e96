#include "surface/shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surface/ordered_sum.h"
#include "surface/portable_math.h"
#include "surface/surface_checks.h"

namespace brinell::surface {

namespace {

constexpr double kHalfPi = 1.57079632679489661923;

// An arc's height from q = t²/R.
double arc(double q, double radius, Profile profile) {
  if (profile == Profile::parabolic) return 0.5 * q;
  return q / (1.0 + std::sqrt(std::max(0.0, 1.0 - q / radius)));
}

// Each profile below answers with its height at (x, y) from its apex; all are even in x and y to the bit.

struct EllipsoidProfile {
  double radius_x;
  double radius_y;
  double vertical;
  Profile profile;

  explicit EllipsoidProfile(const Ellipsoid& shape)
      : radius_x(shape.radius_x),
        radius_y(shape.radius_y),
        vertical(std::min(shape.radius_x, shape.radius_y)),
        profile(std::isfinite(vertical) ? shape.profile : Profile::parabolic) {}
  explicit EllipsoidProfile(const Sphere& shape)
      : EllipsoidProfile(Ellipsoid{shape.radius, shape.radius, shape.profile}) {}

  double operator()(double x, double y) const { return arc(x * x / radius_x + y * y / radius_y, vertical, profile); }
};

struct ConeProfile {
  double tip_radius;
  double tip_reach;   // distance from the axis where tip and flank meet
  double tip_height;  // there
  double slope;

  explicit ConeProfile(const Cone& shape) : tip_radius(shape.tip_radius) {
    // Sine and cosine of the smaller of the angle and its complement.
    const bool steep = shape.half_angle <= 0.5 * kHalfPi;
    const auto angle = portable::sin_cos_of_eighth(steep ? shape.half_angle : kHalfPi - shape.half_angle);
    const double sine = steep ? angle.sin : angle.cos;
    const double cosine = steep ? angle.cos : angle.sin;
    tip_reach = tip_radius * cosine;
    tip_height = tip_radius * (cosine * cosine / (1.0 + sine));
    slope = cosine / sine;
  }

  double operator()(double x, double y) const {
    const double square = x * x + y * y;
    const double distance = std::sqrt(square);
    if (distance < tip_reach) return arc(square / tip_radius, tip_radius, Profile::exact);
    return tip_height + (distance - tip_reach) * slope;
  }
};

struct FlatPunchProfile {
  FlatPunch shape;

  double operator()(double x, double y) const {
    const double beyond = std::max(0.0, std::sqrt(x * x + y * y) - shape.radius);
    return arc(beyond * beyond / shape.edge_radius, shape.edge_radius, shape.profile);
  }
};

struct RollerProfile {
  Roller shape;

  double operator()(double x, double y) const {
    const double beyond = std::max(0.0, std::fabs(x) - 0.5 * shape.straight_length);
    const double drop = arc(beyond * beyond / shape.crown_radius, shape.crown_radius, shape.profile);
    const double across =
        shape.profile == Profile::parabolic ? shape.radius : std::max(shape.radius - drop, 0.5 * shape.radius);
    return drop + arc(y * y / across, across, shape.profile);
  }
};

/// Distances of the nodes from an entry's origin, along x and y.
struct Distances {
  std::vector<double> x, y;

  Distances(Centre centre, const Grid& grid, Boundary boundary)
      : x(static_cast<std::size_t>(grid.nx)), y(static_cast<std::size_t>(grid.ny)) {
    for (std::int64_t i = 0; i < grid.nx; ++i) x[static_cast<std::size_t>(i)] = grid.x(i) - centre.x;
    for (std::int64_t j = 0; j < grid.ny; ++j) y[static_cast<std::size_t>(j)] = grid.y(j) - centre.y;
    if (boundary == Boundary::free) return;
    for (double& one : x) one = std::remainder(one, static_cast<double>(grid.nx) * grid.dx);
    for (double& one : y) one = std::remainder(one, static_cast<double>(grid.ny) * grid.dy);
  }
};

/// gap += height(i, j).
template <class Height>
void add_heights(const Grid& grid, double* gap, const parallel::Arena& arena, const Height& height) {
  arena.for_chunks(grid.ny, rows_per_chunk(grid.nx), [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      double* row = gap + j * grid.nx;
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        row[i] += height(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      }
    }
  });
}

template <class ShapeProfile>
void add_profile(const ShapeProfile& profile, const Distances& at, const Grid& grid, double* gap,
                 const parallel::Arena& arena) {
  add_heights(grid, gap, arena, [&](std::size_t i, std::size_t j) { return profile(at.x[i], at.y[j]); });
}

void add(const Plane&, const Distances&, const Grid&, double*, const parallel::Arena&) {}

void add(const Sphere& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  add_profile(EllipsoidProfile(shape), at, grid, gap, arena);
}

void add(const Ellipsoid& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  add_profile(EllipsoidProfile(shape), at, grid, gap, arena);
}

void add(const Cone& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  add_profile(ConeProfile(shape), at, grid, gap, arena);
}

void add(const FlatPunch& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  add_profile(FlatPunchProfile{shape}, at, grid, gap, arena);
}

void add(const Roller& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  add_profile(RollerProfile{shape}, at, grid, gap, arena);
}

// 1 − cos(2 pi x / wavelength), without cancellation near the crest.
double fall_from_crest(double x, double wavelength) {
  if (wavelength == 0) return 0;
  const double sine = portable::sin_cos_of_turns(0.5 * (x / wavelength)).sin;
  return 2.0 * sine * sine;
}

// With a and b the falls along x and y: 1 − (1 − a)(1 − b) = a + b·(1 − a).
void add(const Sinusoid& shape, const Distances& at, const Grid& grid, double* gap, const parallel::Arena& arena) {
  std::vector<double> along_x(at.x.size()), along_y(at.y.size());
  std::transform(at.x.begin(), at.x.end(), along_x.begin(),
                 [&](double x) { return fall_from_crest(x, shape.wavelength_x); });
  std::transform(at.y.begin(), at.y.end(), along_y.begin(),
                 [&](double y) { return fall_from_crest(y, shape.wavelength_y); });
  add_heights(grid, gap, arena, [&](std::size_t i, std::size_t j) {
    return shape.amplitude * (along_x[i] + along_y[j] * (1.0 - along_x[i]));
  });
}

constexpr std::string_view kPositive = "positive and finite [m]";

bool is_positive(double value) {
  return value > 0 && std::isfinite(value);
}

void check_profile(std::string_view argument, Profile profile) {
  if (profile != Profile::parabolic && profile != Profile::exact) {
    fail(Status::invalid_argument, std::string(argument) + " is " +
                                       std::to_string(static_cast<std::int32_t>(profile)) +
                                       "; allowed are 0 (parabolic) and 1 (exact)");
  }
}

void check_one(const Plane&) {}

void check_one(const Sphere& shape) {
  if (!is_positive(shape.radius)) refuse("sphere: radius", shape.radius, kPositive);
  check_profile("sphere: profile", shape.profile);
}

void check_one(const Ellipsoid& shape) {
  constexpr std::string_view kAllowed = "positive [m]; infinite is straight";
  if (!(shape.radius_x > 0)) refuse("ellipsoid: radius_x", shape.radius_x, kAllowed);
  if (!(shape.radius_y > 0)) refuse("ellipsoid: radius_y", shape.radius_y, kAllowed);
  check_profile("ellipsoid: profile", shape.profile);
}

void check_one(const Cone& shape) {
  if (!(shape.half_angle > 0 && shape.half_angle < kHalfPi)) {
    refuse("cone: half_angle", shape.half_angle, "between 0 and pi/2 [rad], measured from the axis");
  }
  if (!(shape.tip_radius >= 0) || !std::isfinite(shape.tip_radius)) {
    refuse("cone: tip_radius", shape.tip_radius, "finite and not negative [m]; 0 is sharp");
  }
}

void check_one(const FlatPunch& shape) {
  if (!(shape.radius >= 0) || !std::isfinite(shape.radius)) {
    refuse("flat_punch: radius", shape.radius, "finite and not negative [m]");
  }
  if (!is_positive(shape.edge_radius)) refuse("flat_punch: edge_radius", shape.edge_radius, kPositive);
  check_profile("flat_punch: profile", shape.profile);
}

void check_one(const Roller& shape) {
  if (!is_positive(shape.radius)) refuse("roller: radius", shape.radius, kPositive);
  if (!(shape.straight_length >= 0) || !std::isfinite(shape.straight_length)) {
    refuse("roller: straight_length", shape.straight_length, "finite and not negative [m]");
  }
  if (!is_positive(shape.crown_radius)) refuse("roller: crown_radius", shape.crown_radius, kPositive);
  check_profile("roller: profile", shape.profile);
}

void check_one(const Sinusoid& shape) {
  if (!(shape.amplitude >= 0) || !std::isfinite(shape.amplitude)) {
    refuse("sinusoid: amplitude", shape.amplitude, "finite and not negative [m]");
  }
  constexpr std::string_view kAllowed = "positive [m]; 0 or infinite is constant in that direction";
  if (!(shape.wavelength_x >= 0)) refuse("sinusoid: wavelength_x", shape.wavelength_x, kAllowed);
  if (!(shape.wavelength_y >= 0)) refuse("sinusoid: wavelength_y", shape.wavelength_y, kAllowed);
}

}  // namespace

void check(const Shape& shape) {
  std::visit([](const auto& one) { check_one(one); }, shape);
}

void add_to_gap(const Shape& shape, Centre centre, const Grid& grid, std::span<double> gap,
                const parallel::Arena& arena, Boundary boundary) {
  check(shape);
  check_gap(grid, gap);
  if (!std::isfinite(centre.x)) refuse("centre x of a shape", centre.x, "finite [m]");
  if (!std::isfinite(centre.y)) refuse("centre y of a shape", centre.y, "finite [m]");
  const Distances at(centre, grid, boundary);
  std::visit([&](const auto& one) { add(one, at, grid, gap.data(), arena); }, shape);
}

}  // namespace brinell::surface
