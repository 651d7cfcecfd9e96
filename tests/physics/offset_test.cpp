// An upper body that moves sideways between steps. Without friction only the places matter:
//
//   - a half-space is the same everywhere, so that the contact of a shape moves with it, and Hertz's formulas hold
//     wherever it stands (K. L. Johnson, Contact Mechanics, 1985, 4.22 - 4.24);
//   - a periodic surface moved by its period is where it was;
//   - an imprint stays where it was made: reloaded there the body retraces elastically, far away it yields anew.
//   There
//     the first imprint has changed the surface's height by what it leaves at the distance r. By reciprocity that is
//     the sum of its plastic strain times the stress that a force at r has there (Boussinesq; Johnson 3.19): the
//     parts (1 - 2 nu)/(2 pi r²) of the radial and the circumferential stress cancel for strain that is alike along x
//     and y, and 1/r³ is left.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.h"
#include "physics/nanoindentation.h"
#include "scene/run.h"
#include "subsurface/depths.h"

namespace brinell::physics {
namespace {

using scene::Field;
using scene::Scene;
using scene::Step;
using scene::StepDrive;
using scene::Which;

std::unique_ptr<scene::Engine> engine_of(int threads = 1) {
  scene::EngineOptions options;
  options.threads = threads;
  return std::make_unique<scene::Engine>(options);
}

Step press(double force, double offset_x = 0, double offset_y = 0) {
  Step step;
  step.drive = StepDrive::force;
  step.target = force;
  step.offset[0] = offset_x;
  step.offset[1] = offset_y;
  return step;
}

Step press_to(double approach, double offset_x = 0, double offset_y = 0) {
  Step step = press(approach, offset_x, offset_y);
  step.drive = StepDrive::approach;
  return step;
}

/// Steel below, a rigid body above, neither with a surface yet.
Scene bare(const Grid& grid, Boundary boundary = Boundary::free, double tolerance = 1e-8) {
  Scene scene;
  scene.set_grid(grid, boundary);
  scene.set_body(Which::lower, {false, kYoung, kPoisson});
  scene::SolverSettings solver;
  solver.tolerance = tolerance;
  scene.set_solver(solver);
  return scene;
}

Scene with(Scene scene, const std::vector<Step>& steps) {
  for (const Step& step : steps) scene.add(step);
  return scene;
}

void finish(scene::Run& run) {
  while (!run.is_finished()) ASSERT_TRUE(run.advance({}).converged);
}

std::vector<double> field(scene::Run& run, Field which = Field::pressure) {
  std::vector<double> values(run.field_size(which));
  run.copy_field(which, values);
  return values;
}

std::vector<double> pressure_after(const Scene& scene) {
  const auto engine = engine_of();
  scene::Run run(*engine, scene);
  finish(run);
  return field(run);
}

/// Moved around the grid, layer by layer.
std::vector<double> rolled(const std::vector<double>& values, const Grid& grid, std::int64_t by_i,
                           std::int64_t by_j) {
  std::vector<double> result(values.size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto at = static_cast<std::int64_t>(n);
    const std::int64_t i = (at % grid.nx + by_i + grid.nx) % grid.nx;
    const std::int64_t j = (at / grid.nx % grid.ny + by_j + grid.ny) % grid.ny;
    const std::int64_t layer = at / (grid.nx * grid.ny);
    result[static_cast<std::size_t>((layer * grid.ny + j) * grid.nx + i)] = values[n];
  }
  return result;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::fabs(value));
  return most;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, std::fabs(a[n] - b[n]));
  return most;
}

// ------------------------------------------------------------------------------------------------------- elastic

constexpr double kSpacing = 0.5e-6;
// The displacement errs by at most the certificate of the largest; a pressure that alternates from cell to cell by p
// displaces by about p dx/pi [E*], while the contact's largest displacement is about p0 times its radius, of at most
// 12 cells here: the pressure is known to 12 pi certificates in each of two solutions.
constexpr double kTight = 1e-12;
constexpr double kSameSolution = 2 * 12 * std::numbers::pi * kTight;

TEST(Offset, moves_a_contact_by_whole_nodes) {
  const Grid grid{45, 38, kSpacing, kSpacing};
  Scene scene = bare(grid, Boundary::free, kTight);
  scene.add(surface::Sphere{kRadius});
  const std::vector<double> still = pressure_after(with(scene, {press(0.1)}));
  const std::vector<double> moved =
      pressure_after(with(scene, {press(0.1), press(0.1, 7 * kSpacing, -5 * kSpacing)}));
  ASSERT_GT(largest(moved), 0);
  EXPECT_LE(largest_difference(moved, rolled(still, grid, 7, -5)), kSameSolution * largest(still));
  // Moved in contact, moved apart, or begun there: the same gap, and a solver that knows nothing else.
  EXPECT_EQ(pressure_after(with(scene, {press(0.1), press(0), press(0.1, 7 * kSpacing, -5 * kSpacing)})), moved);
  const std::vector<double> begun = pressure_after(with(scene, {press(0.1, 7 * kSpacing, -5 * kSpacing)}));
  EXPECT_LE(largest_difference(begun, moved), kSameSolution * largest(still));
}

TEST(Offset, leaves_what_belongs_to_the_lower_body) {
  const Grid grid{40, 40, kSpacing, kSpacing};
  Scene lower = bare(grid), upper = bare(grid);
  lower.add(surface::Sphere{kRadius}, Which::lower);
  upper.add(surface::Sphere{kRadius}, Which::upper);
  EXPECT_EQ(pressure_after(with(lower, {press(0.1, 3 * kSpacing)})), pressure_after(with(lower, {press(0.1)})));
  EXPECT_NE(pressure_after(with(upper, {press(0.1, 3 * kSpacing)})), pressure_after(with(upper, {press(0.1)})));
}

TEST(Offset, hertz_holds_at_a_fraction_of_a_spacing) {
  const auto engine = engine_of();
  const double contact_radius = 6e-6;
  const double force = 4.0 / 3 * kModulus * std::pow(contact_radius, 3) / kRadius;
  const Grid grid{96, 96, contact_radius / 24, contact_radius / 24};
  const double x = 4.37 * grid.dx, y = -7.71 * grid.dy;
  Scene scene = bare(grid);
  scene.add(surface::Sphere{kRadius});
  const Scene pressed = with(scene, {press(force), press(force, x, y), press_to(-1e-9), press_to(2e-8, -x, -y)});
  scene::Run run(*engine, pressed);
  finish(run);
  const scene::Increment& moved = run.increments()[1];
  // Second order in the spacing: (1/24)² of the approach; of the centre of force, the part of the edge's ring.
  const double second_order = 1.0 / (24 * 24);
  EXPECT_NEAR(moved.approach, contact_radius * contact_radius / kRadius,
              second_order * contact_radius * contact_radius / kRadius);
  EXPECT_NEAR(moved.max_pressure, 2 * kModulus * contact_radius / (std::numbers::pi * kRadius),
              2 * second_order * moved.max_pressure);
  EXPECT_NEAR(moved.centre_of_force[0], x, second_order * contact_radius);
  EXPECT_NEAR(moved.centre_of_force[1], y, second_order * contact_radius);
  // The nearest node is off the apex by (0.13, 0.21) spacings.
  EXPECT_NEAR(moved.first_touch, std::pow(std::hypot(0.13, 0.21) * grid.dx, 2) / (2 * kRadius), 1e-6 * 2e-12);
  EXPECT_NEAR(moved.max_pressure_at[0], x, grid.dx);
  EXPECT_NEAR(moved.max_pressure_at[1], y, grid.dx);
  // Driven by the approach: apart, then back where it began.
  EXPECT_EQ(run.increments()[2].normal_force, 0);
  EXPECT_NEAR(run.increments()[3].normal_force, 4.0 / 3 * kModulus * std::sqrt(kRadius * std::pow(2e-8, 3)),
              0.02 * run.increments()[3].normal_force);  // 5.8 cells to the radius: its square is 0.03
  EXPECT_NEAR(run.increments()[3].centre_of_force[0], 0, 1e-3 * grid.dx);
  EXPECT_EQ(run.place_of_upper(1), (scene::Place{x, y}));
  EXPECT_EQ(run.place_of_upper(3), scene::Place{});
}

TEST(Offset, adds_up_over_steps_but_for_rounding) {
  const Grid grid{16, 16, 0.1e-6, 0.3e-6};
  Scene scene = bare(grid);
  scene.add(surface::Sphere{kRadius});
  scene = with(scene, {press(1, 0.4e-6), press(1, 0.9e-6), press(1), press(1, 0.03e-6), press(1, -1.33e-6, 0.9e-6)});
  EXPECT_NE(0.4e-6 + 0.9e-6 - 1.3e-6, 0);  // what is to be caught
  EXPECT_EQ(place_of_upper(scene, 0), (scene::Place{4 * 0.1e-6, 0}));
  EXPECT_EQ(place_of_upper(scene, 2), (scene::Place{13 * 0.1e-6, 0}));
  EXPECT_NEAR(place_of_upper(scene, 3).x, 1.33e-6, 1e-21);
  EXPECT_EQ(place_of_upper(scene, 4), (scene::Place{0, 3 * 0.3e-6}));
}

TEST(Offset, eccentricity_stays_that_of_the_grid) {
  const auto engine = engine_of();
  const Grid grid{45, 38, kSpacing, kSpacing};
  Scene scene = bare(grid);
  scene.add(surface::FlatPunch{5e-6, 1e-3});
  const double x = 3 * kSpacing, y = -2 * kSpacing;
  Step centred = press(0.02, x, y);  // the force stays where the punch was
  centred.free_rotation = true;
  Step along = centred;
  along.offset[0] = along.offset[1] = 0;
  along.eccentricity[0] = x;
  along.eccentricity[1] = y;
  const Scene pressed = with(scene, {centred, along});
  scene::Run run(*engine, pressed);
  finish(run);
  const scene::Increment &left_behind = run.increments()[0], &followed = run.increments()[1];
  // The certificate holds the place to 1e-8 of half the grid.
  EXPECT_NEAR(left_behind.centre_of_force[0], 0, 1e-8 * 12e-6);
  EXPECT_NEAR(followed.centre_of_force[0], x, 1e-8 * 12e-6);
  EXPECT_GT(left_behind.tilt[0], 1e-6) << "a force on the side of negative x from the punch";
  EXPECT_LT(std::fabs(followed.tilt[0]), 1e-3 * left_behind.tilt[0]);
}

TEST(Offset, gives_the_same_bits_for_any_number_of_threads_and_holds_in_mixed_precision) {
  const tbb::global_control three(tbb::global_control::max_allowed_parallelism, 3);
  const Grid grid{96, 80, kSpacing, kSpacing};
  for (const bool mixed : {false, true}) {
    Scene scene = bare(grid);
    scene.add(surface::Sphere{kRadius});
    scene.add(surface::Roughness{0.8, 0, 1e-9, 0, 0, 0, 7});
    scene::SolverSettings solver;
    solver.mixed_precision = mixed;
    scene.set_solver(solver);
    scene = with(scene, {press(0.1), press(0.1, 7.3 * kSpacing, -5 * kSpacing), press(0.05, 1e-6, 1e-6)});
    std::vector<double> alone;
    for (const int threads : {1, 2, 3}) {
      const auto engine = engine_of(threads);
      scene::Run run(*engine, scene);
      finish(run);
      if (alone.empty()) alone = field(run);
      EXPECT_EQ(field(run), alone) << threads;
      for (const scene::Increment& one : run.increments()) EXPECT_LE(one.worst(), 1e-8);
    }
  }
}

TEST(Offset, periodic_surfaces_repeat_themselves) {
  // Spacings and wavelengths that are powers of two: the same waves to the bit.
  const double spacing = 0x1p-20;
  const Grid grid{32, 32, spacing, spacing};
  Scene scene = bare(grid, Boundary::periodic);
  scene.add(surface::Sinusoid{2e-9, 16 * spacing, 8 * spacing}, Which::upper);
  scene.add(surface::Roughness{0.8, 0, 1e-9, 0, 0, 0, 7});  // stays
  const std::vector<double> still = pressure_after(with(scene, {press(0.02)}));
  const std::vector<double> repeated = pressure_after(with(scene, {press(0.02, 16 * spacing, -8 * spacing)}));
  const std::vector<double> turned = pressure_after(with(scene, {press(0.02, 8 * spacing, 0)}));
  EXPECT_EQ(repeated, still);
  EXPECT_GT(largest_difference(turned, still), 0.1 * largest(still));
}

TEST(Offset, periodic_boundaries_pass_everything_on) {
  const Grid grid{30, 24, kSpacing, kSpacing};
  std::vector<double> heights(grid.nodes());
  for (std::size_t n = 0; n < heights.size(); ++n) heights[n] = 2e-9 * std::sin(1.7 * static_cast<double>(n));
  const auto move_by = [&](const std::function<void(Scene&)>& add, std::int64_t i, std::int64_t j) {
    Scene scene = bare(grid, Boundary::periodic, kTight);
    add(scene);
    const double way[2] = {static_cast<double>(i) * grid.dx, static_cast<double>(j) * grid.dy};
    const std::vector<double> still = pressure_after(with(scene, {press(0.05)}));
    const std::vector<double> moved = pressure_after(with(scene, {press(0.05), press(0.05, way[0], way[1])}));
    EXPECT_LE(largest_difference(moved, rolled(still, grid, i, j)), kSameSolution * largest(still));
    EXPECT_GT(largest_difference(moved, still), 0.1 * largest(still));
  };
  const auto map = [&](Scene& scene) {
    scene.add(surface::HeightMap::contiguous(heights.data(), grid.nx, grid.ny), surface::Detrend::plane,
              Which::upper);
  };
  const auto rough = [](Scene& scene) { scene.add(surface::Roughness{0.8, 0, 2e-9, 0, 0, 0, 3}, Which::upper); };
  const auto ball = [](Scene& scene) { scene.add(surface::Sphere{kRadius}); };
  for (const auto& [i, j] : {std::pair{11, -7}, std::pair{-29, 0}, std::pair{4, 23}}) {
    move_by(map, i, j);
    move_by(rough, i, j);
    move_by(ball, i, j);
  }
}

// ------------------------------------------------------------------------------------------------ elastic-plastic

constexpr plastic::Layers kLayers{14, 0.6e-6};
constexpr double kCell = 0.6e-6;  // [m], about five to the radius of contact
constexpr double kForce = 0.12;   // [N]
constexpr double kTolerance = 1e-8;

Grid wide_grid() {
  return {60, 24, kCell, kCell};
}

Scene plastic_scene(Which which, const Grid& grid = wide_grid()) {
  Scene scene = bare(grid, Boundary::free, kTolerance);
  if (which == Which::upper) {
    scene.set_body(Which::upper, {false, kYoung, kPoisson});
    scene.set_body(Which::lower, {});
  }
  scene.set_hardening(which, plastic::Hardening{kSteel, {}});
  scene.set_layers(kLayers);
  scene.add(surface::Sphere{kRadius});
  return scene;
}

std::vector<Step> at(double nodes, const std::vector<double>& forces) {
  std::vector<Step> steps;
  for (const double force : forces) steps.push_back(press(force));
  steps.front().offset[0] = nodes * kCell;
  return steps;
}

std::vector<Step> one_after_the_other(const std::vector<std::vector<Step>>& parts) {
  std::vector<Step> all;
  for (const std::vector<Step>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Of the second of two indentations so far from each other, less the first one.
struct Change {
  double approach = 0, pressure = 0;  // relative
};

Change change_by_the_first(double nodes) {
  const auto engine = engine_of();
  const std::vector<double> forces{0.5 * kForce, kForce, 0};
  const std::vector<Step> steps = one_after_the_other({at(-nodes / 2, forces), at(nodes, forces)});
  scene::Run run(*engine, with(plastic_scene(Which::lower), steps));
  finish(run);
  const scene::Increment &first = run.increments()[1], &second = run.increments()[4];
  EXPECT_EQ(run.increments()[2].contact_nodes, 0);
  EXPECT_NEAR(first.centre_of_force[0], -nodes / 2 * kCell, 1e-6 * kCell);
  EXPECT_NEAR(second.centre_of_force[0], nodes / 2 * kCell, 1e-2 * kCell);
  EXPECT_EQ(second.contact_nodes, first.contact_nodes);
  EXPECT_EQ(run.increments()[5].plastic[0].cuboids, 2 * first.plastic[0].cuboids);
  return {std::fabs(second.approach / first.approach - 1), std::fabs(second.max_pressure / first.max_pressure - 1)};
}

TEST(Offset, a_second_imprint_far_away_is_like_the_first) {
  const Change near = change_by_the_first(20), far = change_by_the_first(34);
  // Of the imprint's own depth, about a tenth of the approach, (1/4)³ is left at four radii of contact, times the
  // share of the strain's square of its depth.
  EXPECT_LE(near.approach, 0.1 / 64);
  EXPECT_LE(near.pressure, 0.1 / 64);
  // The next power of the distance is smaller by the imprint's size over it, squared: (5/20)² of the exponent.
  EXPECT_NEAR(std::log(near.approach / far.approach) / std::log(34.0 / 20), 3, 3 * 0.0625);
}

TEST(Offset, an_imprint_waits_where_it_was_made) {
  const auto engine = engine_of();
  const std::vector<double> cycle{0.5 * kForce, kForce, 0};
  // 8 nodes there, in contact there within the elastic range, and back.
  const std::vector<Step> steps =
      one_after_the_other({at(-4, cycle), at(8, {0.002, 0}), at(-8, {0.5 * kForce, kForce})});
  scene::Run run(*engine, with(plastic_scene(Which::lower), steps));
  finish(run);
  const scene::Increment &first = run.increments()[1], &again = run.increments().back();
  EXPECT_GT(run.increments()[3].normal_force, 0);
  // Retraced: the yield condition is met within the tolerance, flow is of its size.
  EXPECT_NEAR(again.plastic[0].largest, first.plastic[0].largest, 1e2 * kTolerance * first.plastic[0].largest);
  EXPECT_NEAR(again.approach, first.approach, 1e1 * kTolerance * first.approach);
  EXPECT_NEAR(again.max_pressure, first.max_pressure, 1e-6 * first.max_pressure);
  EXPECT_GT(again.first_touch, 0) << "the imprint";
}

TEST(Offset, there_and_back_is_as_if_nothing_had_moved_to_the_bit) {
  const auto engine = engine_of();
  const std::vector<double> cycle{0.5 * kForce, kForce, 0}, reload{0.7 * kForce, kForce};
  for (const Which which : {Which::lower, Which::upper}) {
    scene::Run still(*engine,
                     with(plastic_scene(which), one_after_the_other({at(0, cycle), at(0, {0, 0}), at(0, reload)})));
    scene::Run moved(*engine, with(plastic_scene(which),
                                   one_after_the_other({at(0, cycle), at(9, {0}), at(-9, {0}), at(0, reload)})));
    finish(still);
    finish(moved);
    EXPECT_EQ(field(moved), field(still));
    EXPECT_EQ(field(moved, Field::gap), field(still, Field::gap));
    EXPECT_EQ(moved.increments().back().plastic[static_cast<int>(which)].largest,
              still.increments().back().plastic[static_cast<int>(which)].largest);
  }
}

TEST(Offset, only_the_motion_against_each_other_matters) {
  const auto engine = engine_of();
  const std::vector<double> cycle{0.5 * kForce, kForce, 0};
  const std::vector<Step> steps = one_after_the_other({at(0, cycle), at(7, {0.5 * kForce, kForce})});
  // Below: the sphere leaves the imprint. Above: the imprint leaves the sphere, to the other side.
  Scene below = plastic_scene(Which::lower), above = bare(wide_grid());
  above.set_body(Which::upper, below.body(Which::lower));
  above.set_body(Which::lower, {});
  above.set_hardening(Which::upper, below.hardening(Which::lower));
  above.set_layers(kLayers);
  above.add(surface::Sphere{kRadius}, Which::lower);
  scene::Run lower(*engine, with(below, steps)), upper(*engine, with(above, steps));
  finish(lower);
  finish(upper);
  const scene::Increment &a = lower.increments().back(), &b = upper.increments().back();
  EXPECT_NEAR(b.approach, a.approach, 1e1 * kTolerance * a.approach);
  EXPECT_NEAR(b.plastic[1].largest, a.plastic[0].largest, 1e3 * kTolerance * a.plastic[0].largest);
  EXPECT_NEAR(b.centre_of_force[0], 7 * kCell - a.centre_of_force[0], 1e-4 * kCell);
  EXPECT_EQ(b.plastic[1].cuboids, a.plastic[0].cuboids);
}

TEST(Offset, an_upper_body_takes_its_imprint_along) {
  const auto engine = engine_of();
  const std::vector<double> cycle{0.5 * kForce, kForce, 0};
  constexpr int kBy = 11;
  // The sphere is the upper body's own: below it lies a plane, the same everywhere.
  Scene scene = plastic_scene(Which::upper);
  const Field strain = *scene::field_of(131), heave = *scene::field_of(110);
  scene::Subsurface wanted;
  wanted.fields = {strain};
  wanted.depths = subsurface::layer_depths(kLayers.count, kLayers.thickness);
  scene.set_subsurface(wanted);
  const auto run_with = [&](double nodes) {
    return with(scene, one_after_the_other({at(0, cycle), at(nodes, {0}), at(0, {kForce})}));
  };
  scene::Run still(*engine, run_with(0)), moved(*engine, run_with(kBy));
  for (int n = 0; n < 4; ++n) {
    ASSERT_TRUE(still.advance({}).converged);
    ASSERT_TRUE(moved.advance({}).converged);
  }
  // Moved, and not yet pressed: the same strain, elsewhere.
  EXPECT_EQ(field(moved, strain), rolled(field(still, strain), wide_grid(), kBy, 0));
  // Its displacement is a convolution, of other rounding, and does not come back on the other side.
  const std::vector<double> here = field(moved, heave), before = field(still, heave);
  for (std::size_t n = 0; n < here.size(); ++n) {
    if (n % 60 < kBy) continue;
    ASSERT_NEAR(here[n], before[n - kBy], 1e-13 * largest(before)) << n;
  }
  finish(still);
  finish(moved);
  const scene::Increment &a = still.increments().back(), &b = moved.increments().back();
  EXPECT_NEAR(b.plastic[1].at[0], a.plastic[1].at[0] + kBy * kCell, 1e-6 * kCell);
  EXPECT_NEAR(b.plastic[1].largest, a.plastic[1].largest, 1e2 * kTolerance * a.plastic[1].largest);
  EXPECT_NEAR(b.approach, a.approach, 1e1 * kTolerance * a.approach);
}

}  // namespace
}  // namespace brinell::physics
