#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/fingerprint.h"
#include "parallel/arena.h"
#include "scene/undeformed_gap.h"
#include "subsurface/depths.h"

namespace brinell::scene {

namespace {

constexpr double kLeastTolerance = 1e-14;
constexpr double kLargestTolerance = 0.1;
constexpr double kLeastIncrementTolerance = 1e-6, kLargestIncrementTolerance = 1;

void require(bool holds, Status status, const std::string& message) {
  if (!holds) fail(status, message);
}

void require_positive(const char* name, double value, const char* unit) {
  require(std::isfinite(value) && value > 0, Status::invalid_argument,
          std::string(name) + " = " + text(value) + " " + unit + ": must be positive and finite");
}

void add_members(Fingerprint& f, const surface::Plane&) {
  f.add('p');
}
void add_members(Fingerprint& f, const surface::Sphere& s) {
  f.add(s.radius);
  f.add(static_cast<std::int32_t>(s.profile));
}
void add_members(Fingerprint& f, const surface::Ellipsoid& s) {
  f.add(s.radius_x);
  f.add(s.radius_y);
  f.add(static_cast<std::int32_t>(s.profile));
}
void add_members(Fingerprint& f, const surface::Cone& s) {
  f.add(s.half_angle);
  f.add(s.tip_radius);
}
void add_members(Fingerprint& f, const surface::FlatPunch& s) {
  f.add(s.radius);
  f.add(s.edge_radius);
  f.add(static_cast<std::int32_t>(s.profile));
}
void add_members(Fingerprint& f, const surface::Roller& s) {
  f.add(s.radius);
  f.add(s.straight_length);
  f.add(s.crown_radius);
  f.add(static_cast<std::int32_t>(s.profile));
}
void add_members(Fingerprint& f, const surface::Sinusoid& s) {
  f.add(s.amplitude);
  f.add(s.wavelength_x);
  f.add(s.wavelength_y);
}
void add_members(Fingerprint& f, const surface::Shape& shape) {
  f.add(shape.index());
  std::visit([&](const auto& s) { add_members(f, s); }, shape);
}
void add_members(Fingerprint& f, const surface::Roughness& r) {
  for (const double value : {r.hurst, r.rms_slope, r.rms_height, r.long_cutoff, r.rolloff, r.short_cutoff})
    f.add(value);
  f.add(r.seed);
}
void add_members(Fingerprint& f, const plastic::Swift& l) {
  for (const double value : {l.B, l.C, l.n, l.strain_scale}) f.add(value);
}
void add_members(Fingerprint& f, const plastic::LinearHardening& l) {
  f.add(l.yield_stress);
  f.add(l.hardening_modulus);
}
void add_members(Fingerprint& f, const plastic::PerfectPlasticity& l) {
  f.add(l.yield_stress);
}
void add_members(Fingerprint& f, const plastic::Voce& l) {
  for (const double value : {l.yield_stress, l.saturation_stress, l.rate}) f.add(value);
}
void add_members(Fingerprint& f, const plastic::RambergOsgood& l) {
  for (const double value : {l.K, l.m, l.yield_stress}) f.add(value);
}
void add_members(Fingerprint& f, const plastic::HardeningTable& l) {
  for (const double value : l.plastic_strain) f.add(value);
  for (const double value : l.stress) f.add(value);
}
void add_members(Fingerprint& f, const plastic::Hardening& hardening, const Body& body) {
  f.add(body.youngs_modulus);
  f.add(body.poissons_ratio);
  f.add(hardening.law.index());
  std::visit([&](const auto& law) { add_members(f, law); }, hardening.law);
  for (const plastic::DepthFactor& one : hardening.depth_factor) {
    f.add(one.depth);
    f.add(one.factor);
  }
}
void add_members(Fingerprint& f, const Heights& h) {
  f.add(static_cast<std::int32_t>(h.detrend));
  f.add_bytes(h.values->data(), h.values->size() * sizeof(double));
}

Which checked(Which body) {
  require(body == Which::lower || body == Which::upper, Status::invalid_argument,
          "body = " + std::to_string(static_cast<std::int32_t>(body)) + ": allowed are 0 (lower) and 1 (upper)");
  return body;
}

}  // namespace

Which usual_body(const surface::Shape& shape) {
  const bool texture =
      std::holds_alternative<surface::Plane>(shape) || std::holds_alternative<surface::Sinusoid>(shape);
  return texture ? Which::lower : Which::upper;
}

bool Subsurface::wants(Which body) const {
  return max_von_mises[static_cast<int>(body)] || std::any_of(fields.begin(), fields.end(), [&](Field field) {
           return is_stress(field) && body_of(field) == body;
         });
}

bool Subsurface::wants_max_von_mises(Which body) const {
  return max_von_mises[static_cast<int>(body)] || std::any_of(fields.begin(), fields.end(), [&](Field field) {
           return body_of(field) == body &&
                  (lower_field(field) == Field::stress || invariant_of(field) == subsurface::Invariant::von_mises);
         });
}

void Scene::set_grid(const Grid& grid, Boundary boundary) {
  for (const auto& [name, nodes] : {std::pair{"nx", grid.nx}, std::pair{"ny", grid.ny}}) {
    require(nodes >= 1, Status::invalid_argument,
            std::string(name) + " = " + std::to_string(nodes) + " nodes: must be at least 1");
  }
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max() / static_cast<std::int64_t>(sizeof(double));
  require(grid.nx <= most / grid.ny, Status::too_large,
          "nodes = " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) +
              ": the bytes of one field overflow 64 bits");
  require_positive("spacing dx", grid.dx, "m");
  require_positive("spacing dy", grid.dy, "m");
  require(std::isnormal(grid.cell_area()), Status::invalid_argument,
          "spacing = " + text(grid.dx) + " x " + text(grid.dy) + " m: the area of a cell, " + text(grid.cell_area()) +
              " m^2, is beyond what numbers can hold");
  require(boundary == Boundary::free || boundary == Boundary::periodic, Status::invalid_argument,
          "boundary = " + std::to_string(static_cast<std::int32_t>(boundary)) +
              ": allowed are 0 (free) and 1 (periodic)");
  bool holds_heights = false;
  for (const SurfaceEntry& entry : surfaces_)
    holds_heights = holds_heights || std::holds_alternative<Heights>(entry.form);
  require(!holds_heights || (grid.nx == grid_.nx && grid.ny == grid_.ny), Status::wrong_state,
          "nodes = " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) +
              ": the grid cannot change, the scene already holds heights on " + std::to_string(grid_.nx) + " x " +
              std::to_string(grid_.ny) + " nodes");
  grid_ = grid;
  boundary_ = boundary;
}

void Scene::set_body(Which which, const Body& body) {
  checked(which);
  if (!body.rigid) {
    require_positive("youngs_modulus", body.youngs_modulus, "Pa");
    require(body.poissons_ratio > -1 && body.poissons_ratio < 0.5, Status::invalid_argument,
            "poissons_ratio = " + text(body.poissons_ratio) + ": must lie between -1 and 0.5, both excluded");
  }
  bodies_[static_cast<int>(which)] = body;
}

void Scene::set_hardening(Which which, const std::optional<plastic::Hardening>& hardening) {
  checked(which);
  if (hardening) plastic::check(*hardening);
  hardening_[static_cast<int>(which)] = hardening;
}

void Scene::set_identical(bool identical) {
  identical_ = identical;
}

void Scene::set_layers(const plastic::Layers& layers) {
  subsurface::layer_depths(layers.count, layers.thickness);  // refuses what is out of range
  layers_ = layers;
}

void Scene::add(const surface::Shape& shape, std::optional<Which> body) {
  surface::check(shape);
  surfaces_.push_back({shape, checked(body.value_or(usual_body(shape)))});
}

void Scene::add(const surface::Roughness& roughness, Which body) {
  require(grid_.nx > 0, Status::wrong_state, "roughness needs the grid: set it first");
  surfaces_.push_back({surface::checked(roughness, grid_), checked(body)});
}

void Scene::add(const surface::HeightMap& heights, surface::Detrend detrend, Which body) {
  checked(body);
  require(grid_.nx > 0, Status::wrong_state, "heights need the grid: set it first");
  require(heights.nx == grid_.nx && heights.ny == grid_.ny, Status::invalid_argument,
          "heights have " + std::to_string(heights.nx) + " x " + std::to_string(heights.ny) +
              " nodes, the grid has " + std::to_string(grid_.nx) + " x " + std::to_string(grid_.ny));
  const parallel::Arena alone(1);
  surface::trend_of(heights, detrend, alone);  // refuses what is not finite
  auto copy = Buffer<double>::uninitialised(grid_.nodes());
  for (std::int64_t j = 0; j < heights.ny; ++j) {
    for (std::int64_t i = 0; i < heights.nx; ++i) {
      copy[static_cast<std::size_t>(j * heights.nx + i)] = heights.at(i, j);
    }
  }
  surfaces_.push_back({Heights{std::make_shared<const Buffer<double>>(std::move(copy)), detrend}, body});
}

void Scene::add(const Step& step) {
  require(
      step.drive == StepDrive::force || step.drive == StepDrive::approach || step.drive == StepDrive::mean_pressure,
      Status::invalid_argument,
      "drive = " + std::to_string(static_cast<std::int32_t>(step.drive)) +
          ": a step needs exactly one of 1 (force), 2 (approach), 3 (mean pressure)");
  require(step.increments >= 1, Status::invalid_argument,
          "increments = " + std::to_string(step.increments) + ": must be at least 1");
  const char* name = step.drive == StepDrive::force      ? "target (normal_force)"
                     : step.drive == StepDrive::approach ? "target (approach)"
                                                         : "target (mean_pressure)";
  require(std::isfinite(step.target), Status::invalid_argument,
          std::string(name) + " = " + text(step.target) + ": must be finite");
  require(step.drive == StepDrive::approach || step.target >= 0, Status::invalid_argument,
          std::string(name) + " = " + text(step.target) + (step.drive == StepDrive::force ? " N" : " Pa") +
              ": must not be negative: bodies press on each other, they do not stick");
  for (const double slope : step.tilt) {
    require(std::isfinite(slope), Status::invalid_argument, "tilt = " + text(slope) + " rad: must be finite");
  }
  for (const double place : step.eccentricity) {
    require(std::isfinite(place), Status::invalid_argument, "eccentricity = " + text(place) + " m: must be finite");
  }
  for (const double ratio : step.traction_ratio) {
    require(std::isfinite(ratio), Status::invalid_argument, "traction_ratio = " + text(ratio) + ": must be finite");
  }
  for (const double way : step.offset) {
    require(std::isfinite(way), Status::invalid_argument, "offset = " + text(way) + " m: must be finite");
  }
  steps_.push_back(step);
}

void Scene::set_solver(const SolverSettings& solver) {
  require(solver.tolerance >= kLeastTolerance && solver.tolerance <= kLargestTolerance, Status::invalid_argument,
          "tolerance = " + text(solver.tolerance) + ": must lie between " + text(kLeastTolerance) + " and " +
              text(kLargestTolerance));
  require(solver.max_iterations >= 1, Status::invalid_argument,
          "max_iterations = " + std::to_string(solver.max_iterations) + ": must be at least 1");
  require(solver.increment_tolerance == 0 || (solver.increment_tolerance >= kLeastIncrementTolerance &&
                                              solver.increment_tolerance <= kLargestIncrementTolerance),
          Status::invalid_argument,
          "increment_tolerance = " + text(solver.increment_tolerance) + ": must be 0 or lie between " +
              text(kLeastIncrementTolerance) + " and " + text(kLargestIncrementTolerance));
  solver_ = solver;
}

void Scene::set_subsurface(const Subsurface& wanted) {
  subsurface::check_depths(wanted.depths);
  for (const Field field : wanted.fields) {
    require(is_below_surface(field), Status::invalid_argument,
            "fields: " + name(field) + " lies on the surface and is always there; name fields below it");
  }
  require(wanted.wants(Which::lower) || wanted.wants(Which::upper) || !wanted.fields.empty(),
          Status::invalid_argument,
          "nothing is asked for below the surface: name fields, or set max_von_mises or upper_max_von_mises");
  subsurface_ = wanted;
}

double Scene::contact_modulus() const {
  double compliance = 0;
  for (const Which which : {Which::lower, Which::upper}) {
    const Body& one = body(which);
    if (!one.rigid) compliance += (1 - one.poissons_ratio * one.poissons_ratio) / one.youngs_modulus;
  }
  require(compliance > 0, Status::invalid_scene,
          "both bodies are rigid: give at least one of them youngs_modulus and poissons_ratio");
  return 1 / compliance;
}

void Scene::check_complete() const {
  require(grid_.nx > 0, Status::invalid_scene, "the scene has no grid: set its nodes and spacing");
  require(!steps_.empty(), Status::invalid_scene, "the scene has no step: give it a force or an approach");
  contact_modulus();
  for (std::size_t n = 0; n < steps_.size(); ++n) {
    require(
        steps_[n].drive != StepDrive::mean_pressure || boundary_ == Boundary::periodic, Status::invalid_scene,
        "step " + std::to_string(n) + ": mean_pressure needs a periodic boundary; prescribe normal_force instead");
    check_rotation(n);
  }
  check_hardening();
  check_offsets(*this);
  for (const Which which : {Which::lower, Which::upper}) {
    const std::string label = which == Which::lower ? "lower" : "upper";
    require(!subsurface_.wants(which) || !body(which).rigid, Status::invalid_scene,
            "the stress below the " + label + " body's surface is asked for, but that body is rigid: give it " +
                "youngs_modulus and poissons_ratio, or ask for the other body's");
  }
}

void Scene::check_hardening() const {
  for (const Field field : subsurface_.fields) {
    require(!is_plastic(field) || hardens(body_of(field)), Status::invalid_scene,
            "the field " + name(field) + " is asked for, but that body does not harden: give it a hardening law");
  }
  if (!hardens()) return;
  for (const Which which : {Which::lower, Which::upper}) {
    require(!hardens(which) || !body(which).rigid, Status::invalid_scene,
            std::string("the ") + (which == Which::lower ? "lower" : "upper") +
                " body hardens, but is rigid: give it youngs_modulus and poissons_ratio");
  }
  require(boundary_ == Boundary::free, Status::invalid_scene,
          "a body that hardens needs a free boundary: the response to plastic strain is that of a half-space");
  require(layers_.count > 0, Status::invalid_scene,
          "a body that hardens is divided into layers: set their number and thickness");
  require(
      subsurface_.depths.empty() || subsurface_.depths == subsurface::layer_depths(layers_.count, layers_.thickness),
      Status::invalid_scene,
      "beside a body that hardens the depths asked for must be those of its layers, (k + 1/2) times " +
          text(layers_.thickness) + " m for " + std::to_string(layers_.count) + " layers");
  for (std::size_t n = 0; n < steps_.size(); ++n) {
    const double* ratio = steps_[n].traction_ratio;
    require(
        !identical_ || (ratio[0] == 0 && ratio[1] == 0), Status::invalid_scene,
        "step " + std::to_string(n) + ": traction_ratio = [" + text(ratio[0]) + ", " + text(ratio[1]) +
            "] pushes bodies that are each other's mirror image (same_as_lower) in opposite directions: where " +
            "they harden they are solved as one; give the upper body its own youngs_modulus, poissons_ratio and " +
            "hardening");
  }
}

/// Of step n.
void Scene::check_rotation(std::size_t n) const {
  const Step& step = steps_[n];
  if (!step.free_rotation && step.tilt[0] == 0 && step.tilt[1] == 0) return;
  const char* name = step.free_rotation ? "eccentricity" : "tilt";
  require(boundary_ == Boundary::free, Status::invalid_scene,
          "step " + std::to_string(n) + ": " + name +
              " needs a free boundary: on a periodic one a plane has no slope; leave it out");
  if (!step.free_rotation) return;
  const double last[2] = {grid_.x(grid_.nx - 1), grid_.y(grid_.ny - 1)};
  for (int k = 0; k < 2; ++k) {
    require(std::fabs(step.eccentricity[k]) <= last[k], Status::invalid_scene,
            "step " + std::to_string(n) + ": eccentricity = [" + text(step.eccentricity[0]) + ", " +
                text(step.eccentricity[1]) + "] m lies outside the grid, whose last nodes are at [" + text(last[0]) +
                ", " + text(last[1]) + "] m: no contact can carry such a force");
  }
}

std::uint64_t Scene::fingerprint() const {
  Fingerprint f;
  f.add(grid_.nx);
  f.add(grid_.ny);
  f.add(grid_.dx);
  f.add(grid_.dy);
  f.add(static_cast<std::int32_t>(boundary_));
  f.add(contact_modulus());
  for (const SurfaceEntry& entry : surfaces_) {
    f.add(entry.form.index());
    f.add(static_cast<std::int32_t>(entry.body));
    std::visit([&](const auto& e) { add_members(f, e); }, entry.form);
  }
  for (const Step& step : steps_) {
    f.add(static_cast<std::int32_t>(step.drive));
    f.add(step.increments);
    f.add(step.target);
    for (const double ratio : step.traction_ratio) f.add(ratio);
    f.add(step.free_rotation);
    for (const double value : step.free_rotation ? step.eccentricity : step.tilt) f.add(value);
    for (const double way : step.offset) f.add(way);
  }
  f.add(solver_.tolerance);
  f.add(solver_.max_iterations);
  f.add(solver_.mixed_precision);
  if (hardens()) f.add(solver_.increment_tolerance);
  for (const double depth : subsurface_.depths) f.add(depth);
  for (const Field field : subsurface_.fields) f.add(static_cast<std::int32_t>(field));
  for (const Which which : {Which::lower, Which::upper}) {
    f.add(subsurface_.max_von_mises[static_cast<int>(which)]);
    if (subsurface_.wants(which)) f.add(body(which).poissons_ratio);
    if (hardens(which)) add_members(f, *hardening(which), body(which));
  }
  if (hardens()) {
    f.add(identical_);
    f.add(layers_.count);
    f.add(layers_.thickness);
  }
  return f.value();
}

}  // namespace brinell::scene
