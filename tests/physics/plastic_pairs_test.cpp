// Two bodies of which one or both yield: the two spheres of V. Boucly, D. Nélias, S. Liu, Q. J. Wang & L. M. Keer
// (2006, profiles/two_spheres), and what must hold for any pair: bodies may change places, and an elastic one that
// hardly deforms is a rigid one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "scene/run.h"
#include "support/workbench.h"

namespace brinell::physics {
namespace {

using scene::Which;

struct Material {
  scene::Body body;
  std::optional<plastic::HardeningLaw> law;
};

/// One step for each force, after an empty scene.
scene::Scene pressed(const Grid& grid, const plastic::Layers& layers, const Material& lower, const Material& upper,
                     const std::vector<double>& radii, const std::vector<double>& forces, double tolerance) {
  scene::Scene scene;
  scene.set_grid(grid, Boundary::free);
  for (const Which which : {Which::lower, Which::upper}) {
    const Material& material = which == Which::lower ? lower : upper;
    scene.set_body(which, material.body);
    if (material.law) scene.set_hardening(which, plastic::Hardening{*material.law, {}});
  }
  scene.set_layers(layers);
  for (const double radius : radii) scene.add(surface::Shape{surface::Sphere{radius}});
  for (const double force : forces) {
    scene::Step step;
    step.drive = scene::StepDrive::force;
    step.target = force;
    scene.add(step);
  }
  scene::SolverSettings solver;
  solver.tolerance = tolerance;
  scene.set_solver(solver);
  return scene;
}

void want(scene::Scene& scene, const std::vector<scene::Field>& fields) {
  scene::Subsurface wanted;
  for (std::int64_t k = 0; k < scene.layers().count; ++k) {
    wanted.depths.push_back((static_cast<double>(k) + 0.5) * scene.layers().thickness);
  }
  wanted.fields = fields;
  scene.set_subsurface(wanted);
}

void advance(scene::Run& run, int increments) {
  for (int n = 0; n < increments; ++n) {
    const scene::Increment& increment = run.advance([](const scene::Progress&) { return true; });
    ASSERT_TRUE(increment.converged);
    ASSERT_LE(increment.yield, run.tolerance());
  }
}

std::vector<double> field(scene::Run& run, scene::Field which) {
  std::vector<double> values(run.field_size(which));
  run.copy_field(which, values);
  return values;
}

// ------------------------------------------------------------------------------------ two spheres of bearing steel

constexpr double kYoung = 210e9, kPoisson = 0.3, kRadius = 15e-3, kForce = 11179;
constexpr double kModulus = kYoung / (1 - kPoisson * kPoisson) / 2;
const plastic::Swift kBearingSteel{945e6, 20, 0.121, 1e6};

double hertz_radius() {
  return std::cbrt(3 * kForce * (kRadius / 2) / (4 * kModulus));
}
double hertz_pressure() {
  return 1.5 * kForce / (std::numbers::pi * hertz_radius() * hertz_radius());
}

struct Extreme {
  double value = 0, depth = 0;  // in Hertz pressures and radii
};

struct TwoSpheres {
  double largest_pressure = 0;  // at the highest load [Pa]
  double strain = 0;
  Extreme compressive, tensile_above, tensile_below;  // hydrostatic stress on the axis, unloaded
};

/// The vertex of the parabola through the k-th and the two beside it.
Extreme vertex(const std::vector<double>& values, std::size_t k, double thickness) {
  const double left = values[k - 1], middle = values[k], right = values[k + 1];
  const double curvature = left - 2 * middle + right, shift = 0.5 * (left - right) / curvature;
  return {(middle - 0.25 * (left - right) * shift) / hertz_pressure(),
          (static_cast<double>(k) + 0.5 + shift) * thickness / hertz_radius()};
}

TwoSpheres press_two_spheres(bool both) {
  // An eighth and a sixteenth of the contact radius, for the thin tensile layer; an odd number of nodes has one on
  // the axis.
  constexpr double side = 100e-6, thickness = 50e-6;
  const Grid grid{29, 29, side, side};
  const plastic::Layers layers{44, thickness};
  const Material hardens{{false, kYoung, kPoisson}, kBearingSteel}, elastic{{false, kYoung, kPoisson}, {}};
  const std::vector<double> forces{200, 900, 2000, 4000, 6500, 9000, kForce, 0.0};
  scene::Scene scene = pressed(grid, layers, hardens, elastic, {kRadius, kRadius}, forces, 1e-5);
  scene.set_identical(both);
  want(scene, {scene::Field::residual_stress});
  scene::EngineOptions options;
  options.threads = 1;
  scene::Engine engine(options);
  scene::Run run(engine, scene);
  TwoSpheres result;
  advance(run, static_cast<int>(forces.size()));
  const std::vector<scene::Increment>& increments = run.increments();
  result.largest_pressure = increments[forces.size() - 2].max_pressure;
  result.strain = increments.back().plastic[0].largest;
  const std::vector<double> stress = field(run, scene::Field::residual_stress);
  std::vector<double> mean(static_cast<std::size_t>(layers.count));
  for (std::size_t k = 0; k < mean.size(); ++k) {
    const std::size_t at = 6 * (k * grid.nodes() + grid.nodes() / 2);
    mean[k] = (stress[at] + stress[at + 1] + stress[at + 2]) / 3;
  }
  const auto place = [&](auto extreme) { return static_cast<std::size_t>(extreme - mean.begin()); };
  const std::size_t least = place(std::min_element(mean.begin() + 1, mean.end() - 1));
  const auto middle = mean.begin() + static_cast<std::ptrdiff_t>(least);
  result.compressive = vertex(mean, least, thickness);
  result.tensile_below = vertex(mean, place(std::max_element(middle, mean.end() - 1)), thickness);
  const std::size_t above = place(std::max_element(mean.begin(), middle));
  result.tensile_above = {mean[above] / hertz_pressure(),
                          (static_cast<double>(above) + 0.5) * thickness / hertz_radius()};
  return result;
}

TEST(PlasticPairs, of_two_spheres_keep_the_stress_that_the_paper_describes) {
  const TwoSpheres both = press_two_spheres(true), one = press_two_spheres(false);
  // On finer grids in more increments (profiles/two_spheres): 5.61 and 6.20 GPa. Seven increments and the pressure's
  // first order: 3 % of each, of which the difference keeps a tenth. Paper: up to 11 %.
  EXPECT_NEAR(both.largest_pressure, 5.61e9, 0.03 * 5.61e9);
  EXPECT_NEAR(one.largest_pressure, 6.20e9, 0.03 * 6.20e9);
  EXPECT_NEAR(one.largest_pressure / both.largest_pressure - 1, 0.106, 0.01);
  EXPECT_GT(one.strain, 1.3 * both.strain);
  // Paper: compressive extreme near z/a = 0.68, read from a figure to 0.05; a layer is 0.06 a.
  for (const TwoSpheres& spheres : {both, one}) {
    EXPECT_NEAR(spheres.compressive.depth, 0.69, 0.05);
    EXPECT_LT(spheres.tensile_above.depth, 0.481) << "between surface and Hertzian depth";
    EXPECT_GT(spheres.tensile_above.value, 0.01);
    EXPECT_GT(spheres.tensile_below.depth, 1.5);
    EXPECT_GT(spheres.tensile_below.value, 0.005);
  }
  EXPECT_NEAR(both.compressive.value, -0.0634, 0.005);
  EXPECT_NEAR(one.compressive.value, -0.0783, 0.005);
}

// ------------------------------------------------------------------------------------------------------ any pair

const Grid kGrid{20, 20, 0.6e-6, 0.6e-6};
constexpr plastic::Layers kLayers{14, 0.6e-6};
constexpr double kSmallRadius = 50e-6;
const std::vector<double> kHistory{0.04, 0.08, 0.12, 0.06, 0.0};

TEST(PlasticPairs, may_change_places) {
  constexpr double tolerance = 1e-8;
  const Material steel{{false, 210e9, 0.3}, plastic::Swift{1240e6, 30, 0.085, 1e6}},
      bronze{{false, 120e9, 0.34}, plastic::LinearHardening{1600e6, 20e9}};
  scene::EngineOptions options;
  options.threads = 1;
  scene::Engine engine(options);
  scene::Run run(engine, pressed(kGrid, kLayers, steel, bronze, {kSmallRadius}, kHistory, tolerance));
  scene::Run other(engine, pressed(kGrid, kLayers, bronze, steel, {kSmallRadius}, kHistory, tolerance));
  for (std::size_t n = 0; n < kHistory.size(); ++n) {
    advance(run, 1);
    advance(other, 1);
    const scene::Increment &a = run.increments().back(), &b = other.increments().back();
    // Both solved to the tolerance, which the approach keeps and strain multiplies by stress over its hardening.
    EXPECT_NEAR(a.approach, b.approach, 1e2 * tolerance * a.approach);
    EXPECT_NEAR(a.max_pressure, b.max_pressure, 1e-5 * a.max_pressure);
    for (const int which : {0, 1}) {
      EXPECT_NEAR(a.plastic[which].largest, b.plastic[1 - which].largest, 1e-5 * a.plastic[which].largest);
      EXPECT_EQ(a.plastic[which].cuboids, b.plastic[1 - which].cuboids);
    }
  }
  for (const int which : {0, 1}) EXPECT_GT(run.increments().back().plastic[which].largest, 5e-4);
}

TEST(PlasticPairs, with_a_stiff_elastic_body_are_one_on_a_rigid_body) {
  constexpr double tolerance = 1e-8;
  const Material steel{{false, 210e9, 0.3}, plastic::Swift{1240e6, 30, 0.085, 1e6}},
      stiff{{false, 210e9 * 1e7, 0.3}, {}}, rigid{{true, 0, 0}, {}};
  scene::EngineOptions options;
  options.threads = 1;
  scene::Engine engine(options);
  scene::Run on_stiff(engine, pressed(kGrid, kLayers, steel, stiff, {kSmallRadius}, kHistory, tolerance));
  scene::Run on_rigid(engine, pressed(kGrid, kLayers, steel, rigid, {kSmallRadius}, kHistory, tolerance));
  advance(on_stiff, static_cast<int>(kHistory.size()));
  advance(on_rigid, static_cast<int>(kHistory.size()));
  for (std::size_t n = 0; n < kHistory.size(); ++n) {
    const scene::Increment &a = on_stiff.increments()[n], &b = on_rigid.increments()[n];
    EXPECT_NEAR(a.approach, b.approach, 2e-6 * b.approach);  // 1e-7 of the compliance, and the tolerance
    EXPECT_NEAR(a.max_pressure, b.max_pressure, 1e-5 * b.max_pressure);
    EXPECT_NEAR(a.plastic[0].largest, b.plastic[0].largest, 1e-5 * b.plastic[0].largest);
  }
}

}  // namespace
}  // namespace brinell::physics
