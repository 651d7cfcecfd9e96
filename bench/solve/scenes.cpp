#include "solve/scenes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "surface/roughness.h"
#include "surface/shapes.h"

namespace brinell::bench {

namespace {

constexpr double kSphereRadius = 10;
constexpr double kContactRadius = 1.0 / 6;  // a third of the half-width

// Hertz: F = 4/3 E* a³/R, on a unit area.
constexpr double kSpherePressure = 4.0 / 3 * kContactRadius * kContactRadius * kContactRadius / kSphereRadius;

// 2 kN on a flat of 5 mm, edge 1 m, E* = 210 GPa / 0.91: of the profile tilted_punch.
constexpr double kPunchPressure = 2e3 / (210e9 / 0.91 * 14e-3 * 14e-3);

}  // namespace

void SolveScene::fill_gap(const Grid& grid, std::span<double> gap, const parallel::Arena& arena) const {
  std::fill(gap.begin(), gap.end(), 0.0);
  if (name.starts_with("sphere")) {
    surface::add_to_gap(surface::Sphere{kSphereRadius}, {}, grid, gap, arena);
    return;
  }
  if (name == "punch") {
    surface::add_to_gap(surface::FlatPunch{kPunchRadius, 200 * kPunchRadius}, {}, grid, gap, arena);
    return;
  }
  surface::Roughness roughness;
  roughness.hurst = 0.8;
  roughness.rms_slope = 0.1;
  roughness.long_cutoff = 1;
  roughness.rolloff = 1.0 / 8;
  roughness.short_cutoff = 4 * grid.dx;
  roughness.seed = 1;
  surface::add_to_gap(roughness, {}, grid, gap, arena);
}

const std::vector<SolveScene>& solve_scenes() {
  static const std::vector<SolveScene> scenes{
      {"rough_5", "rough, free, load for 5 % contact", Boundary::free, 0.0025, false},
      {"rough_20", "rough, free, load for 20 % contact", Boundary::free, 0.01, false},
      {"sphere", "smooth sphere, contact radius a third of the half-width", Boundary::free, kSpherePressure, false},
      {"punch", "flat punch with a rounded edge, the flat's radius 1/1.4 of the half-width", Boundary::free,
       kPunchPressure, false},
      {"periodic_5", "rough, periodic, load for 5 % contact", Boundary::periodic, 0.0025, false},
      {"rough_5_approach", "rough_5 by its approach", Boundary::free, 0.0025, true},
      {"rough_20_approach", "rough_20 by its approach", Boundary::free, 0.01, true},
      {"sphere_approach", "sphere by its approach", Boundary::free, kSpherePressure, true},
      {"periodic_5_approach", "periodic_5 by its approach", Boundary::periodic, 0.0025, true},
  };
  return scenes;
}

const SolveScene& solve_scene(const std::string& name) {
  std::string names;
  for (const SolveScene& scene : solve_scenes()) {
    if (scene.name == name) return scene;
    names += (names.empty() ? "" : ", ") + scene.name;
  }
  throw std::invalid_argument("there is no scene '" + name + "'; there are " + names);
}

}  // namespace brinell::bench
