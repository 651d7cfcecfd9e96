#include <brinell.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "handles.h"
#include "structs.h"
#include "subsurface/depths.h"
#include "surface/statistics.h"

using namespace brinell;
using namespace brinell::capi;

namespace {

/// An enumerator of the interface as that of the engine, whose values agree; out of range is refused.
template <class Enum>
Enum checked_enum(int32_t value, int32_t last, const char* name) {
  if (value < 0 || value > last) {
    fail(Status::invalid_argument,
         std::string(name) + " = " + std::to_string(value) + ": allowed are 0 to " + std::to_string(last));
  }
  return static_cast<Enum>(value);
}

std::optional<scene::Which> to_owner(int32_t body) {
  if (body == BRN_BODY_DEFAULT) return {};
  if (body == BRN_LOWER || body == BRN_UPPER) return static_cast<scene::Which>(body);
  fail(Status::invalid_argument,
       "body = " + std::to_string(body) + ": allowed are -1 (the default of its kind), 0 (lower) and 1 (upper)");
}

surface::Shape to_shape(const brn_shape& s) {
  const auto profile = checked_enum<surface::Profile>(s.profile, BRN_PROFILE_EXACT, "profile");
  switch (s.kind) {
    case BRN_SHAPE_PLANE: return surface::Plane{};
    case BRN_SHAPE_SPHERE: return surface::Sphere{s.radius, profile};
    case BRN_SHAPE_ELLIPSOID: return surface::Ellipsoid{s.radius_x, s.radius_y, profile};
    case BRN_SHAPE_CONE: return surface::Cone{s.half_angle, s.tip_radius};
    case BRN_SHAPE_FLAT_PUNCH: return surface::FlatPunch{s.radius, s.edge_radius, profile};
    case BRN_SHAPE_ROLLER: return surface::Roller{s.radius, s.straight_length, s.crown_radius, profile};
    case BRN_SHAPE_SINUSOID: return surface::Sinusoid{s.amplitude, s.wavelength_x, s.wavelength_y};
    default:
      fail(Status::invalid_argument,
           "kind = " + std::to_string(s.kind) + ": allowed are 0 (plane) to " + std::to_string(BRN_SHAPE_SINUSOID));
  }
}

struct CheckedHeights {
  surface::HeightMap map;
  surface::Detrend detrend;
  scene::Which body;
};

void check_stride(const char* name, std::int64_t stride, std::int64_t nodes) {
  constexpr double most = 0x1p58;  // two such offsets together, in bytes, stay within 64 bits
  if (std::fabs(static_cast<double>(stride)) * static_cast<double>(nodes) <= most) return;
  fail(Status::invalid_argument, std::string(name) + " = " + std::to_string(stride) + " for " +
                                     std::to_string(nodes) + " nodes: must stay within the memory's addresses");
}

CheckedHeights to_heights(const brn_heights* heights) {
  const auto h = read(heights, "heights", brn_heights_init, &brn_heights::values, &brn_heights::nx, &brn_heights::ny,
                      &brn_heights::stride_x, &brn_heights::stride_y, &brn_heights::detrend, &brn_heights::body);
  require(h.values, "values");
  surface::HeightMap map = surface::HeightMap::contiguous(h.values, h.nx, h.ny);
  if (h.stride_x != 0) map.stride_x = h.stride_x;
  if (h.stride_y != 0) map.stride_y = h.stride_y;
  check_stride("stride_x", map.stride_x, h.nx);
  check_stride("stride_y", map.stride_y, h.ny);
  return {map, checked_enum<surface::Detrend>(h.detrend, BRN_DETREND_PLANE, "detrend"),
          to_owner(h.body).value_or(scene::Which::lower)};
}

std::vector<double> to_depths(const brn_subsurface& s) {
  if (s.layers == 0) {
    if (s.depth_count == 0) fail(Status::invalid_argument, "there are no depths: give layers, or depth_count");
    require(s.depths, "depths");
    return {s.depths, s.depths + s.depth_count};
  }
  if (s.depth_count != 0) {
    fail(Status::invalid_argument, "layers = " + std::to_string(s.layers) + " and depth_count = " +
                                       std::to_string(s.depth_count) + ": give one of them, leave the other zero");
  }
  return subsurface::layer_depths(s.layers, s.layer_thickness);
}

}  // namespace

extern "C" {

brn_status brn_scene_create(brn_scene** out) {
  if (out != nullptr) *out = nullptr;
  return guarded(nullptr, [&] {
    require(out, "out");
    *out = new brn_scene();
  });
}

void brn_scene_destroy(brn_scene* scene) {
  delete scene;
}

const char* brn_scene_message(const brn_scene* scene) {
  return scene != nullptr ? scene->messages.get() : brn_last_message();
}

brn_status brn_scene_set_grid(brn_scene* scene, const brn_grid* grid) {
  return guarded_use(scene, "scene", [&] {
    const auto g = read(grid, "grid", brn_grid_init, &brn_grid::nx, &brn_grid::ny, &brn_grid::dx, &brn_grid::dy,
                        &brn_grid::boundary);
    scene->scene.set_grid({g.nx, g.ny, g.dx, g.dy},
                          checked_enum<Boundary>(g.boundary, BRN_BOUNDARY_PERIODIC, "boundary"));
  });
}

brn_status brn_scene_set_body(brn_scene* scene, int32_t which, const brn_body* body) {
  return guarded_use(scene, "scene", [&] {
    const auto b =
        read(body, "body", brn_body_init, &brn_body::youngs_modulus, &brn_body::poissons_ratio, &brn_body::rigid);
    const int32_t rigid = checked_enum<int32_t>(b.rigid, 1, "rigid");
    scene->scene.set_body(checked_enum<scene::Which>(which, BRN_UPPER, "which"),
                          {rigid != 0, b.youngs_modulus, b.poissons_ratio});
  });
}

brn_status brn_scene_add_shape(brn_scene* scene, const brn_shape* shape) {
  return guarded_use(scene, "scene", [&] {
    const auto s = read(shape, "shape", brn_shape_init, &brn_shape::kind, &brn_shape::profile, &brn_shape::radius,
                        &brn_shape::radius_x, &brn_shape::radius_y, &brn_shape::half_angle, &brn_shape::tip_radius,
                        &brn_shape::edge_radius, &brn_shape::straight_length, &brn_shape::crown_radius,
                        &brn_shape::amplitude, &brn_shape::wavelength_x, &brn_shape::wavelength_y, &brn_shape::body);
    scene->scene.add(to_shape(s), to_owner(s.body));
  });
}

brn_status brn_scene_add_roughness(brn_scene* scene, const brn_roughness* roughness) {
  return guarded_use(scene, "scene", [&] {
    const auto r = read(roughness, "roughness", brn_roughness_init, &brn_roughness::hurst, &brn_roughness::rms_slope,
                        &brn_roughness::rms_height, &brn_roughness::long_cutoff, &brn_roughness::rolloff,
                        &brn_roughness::short_cutoff, &brn_roughness::seed, &brn_roughness::body);
    scene->scene.add(
        surface::Roughness{r.hurst, r.rms_slope, r.rms_height, r.long_cutoff, r.rolloff, r.short_cutoff, r.seed},
        to_owner(r.body).value_or(scene::Which::lower));
  });
}

brn_status brn_scene_add_heights(brn_scene* scene, const brn_heights* heights) {
  return guarded_use(scene, "scene", [&] {
    const CheckedHeights checked = to_heights(heights);
    scene->scene.add(checked.map, checked.detrend, checked.body);
  });
}

brn_status brn_height_statistics(const brn_heights* heights, double dx, double dy, brn_statistics* out) {
  return guarded(nullptr, [&] {
    check_size(out, "out");
    const CheckedHeights checked = to_heights(heights);
    const auto s =
        surface::height_statistics(checked.map, dx, dy, checked.detrend, Boundary::free, parallel::Arena(1));
    brn_statistics result;
    brn_statistics_init(&result);
    result.sa = s.sa;
    result.sq = s.sq;
    result.ssk = s.ssk;
    result.sku = s.sku;
    result.sp = s.sp;
    result.sv = s.sv;
    result.sz = s.sz;
    result.sdq = s.sdq;
    write(result, out, &brn_statistics::sa, &brn_statistics::sq, &brn_statistics::ssk, &brn_statistics::sku,
          &brn_statistics::sp, &brn_statistics::sv, &brn_statistics::sz, &brn_statistics::sdq);
  });
}

brn_status brn_scene_add_step(brn_scene* scene, const brn_step* step) {
  return guarded_use(scene, "scene", [&] {
    const auto s = read(step, "step", brn_step_init, &brn_step::drive, &brn_step::increments, &brn_step::target,
                        &brn_step::traction_ratio, &brn_step::rotation, &brn_step::eccentricity, &brn_step::tilt,
                        &brn_step::offset);
    scene::Step checked;
    checked.drive = checked_enum<scene::StepDrive>(s.drive, BRN_DRIVE_MEAN_PRESSURE, "drive");
    checked.increments = s.increments;
    checked.target = s.target;
    checked.free_rotation = checked_enum<int32_t>(s.rotation, BRN_ROTATION_FREE, "rotation") == BRN_ROTATION_FREE;
    std::copy_n(s.traction_ratio, 2, checked.traction_ratio);
    std::copy_n(s.eccentricity, 2, checked.eccentricity);
    std::copy_n(s.tilt, 2, checked.tilt);
    std::copy_n(s.offset, 2, checked.offset);
    scene->scene.add(checked);
  });
}

brn_status brn_scene_set_solver(brn_scene* scene, const brn_solver* solver) {
  return guarded_use(scene, "scene", [&] {
    const auto s = read(solver, "solver", brn_solver_init, &brn_solver::tolerance, &brn_solver::max_iterations,
                        &brn_solver::precision, &brn_solver::increment_tolerance);
    const int32_t precision = checked_enum<int32_t>(s.precision, BRN_PRECISION_MIXED, "precision");
    scene->scene.set_solver({s.tolerance, s.max_iterations, precision == BRN_PRECISION_MIXED, s.increment_tolerance});
  });
}

brn_status brn_scene_set_subsurface(brn_scene* scene, const brn_subsurface* subsurface) {
  return guarded_use(scene, "scene", [&] {
    const auto s =
        read(subsurface, "subsurface", brn_subsurface_init, &brn_subsurface::layers, &brn_subsurface::layer_thickness,
             &brn_subsurface::depths, &brn_subsurface::depth_count, &brn_subsurface::fields,
             &brn_subsurface::field_count, &brn_subsurface::max_von_mises, &brn_subsurface::upper_max_von_mises);
    scene::Subsurface wanted;
    wanted.depths = to_depths(s);
    if (s.field_count > 0) require(s.fields, "fields");
    for (std::size_t k = 0; k < s.field_count; ++k) {
      const auto field = scene::field_of(s.fields[k]);
      if (!field || !scene::is_below_surface(*field)) {
        fail(Status::invalid_argument,
             "fields[" + std::to_string(k) + "] = " + std::to_string(s.fields[k]) +
                 ": allowed are 20 (stress) to 27 (principal_directions), 30 (plastic_strain) to 32 "
                 "(residual_stress), and each "
                 "plus 100 for the upper body");
      }
      if (std::find(wanted.fields.begin(), wanted.fields.end(), *field) == wanted.fields.end()) {
        wanted.fields.push_back(*field);
      }
    }
    wanted.max_von_mises[BRN_LOWER] = checked_enum<int32_t>(s.max_von_mises, 1, "max_von_mises") != 0;
    wanted.max_von_mises[BRN_UPPER] = checked_enum<int32_t>(s.upper_max_von_mises, 1, "upper_max_von_mises") != 0;
    scene->scene.set_subsurface(wanted);
  });
}
}
