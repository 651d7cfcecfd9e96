#include "scene_builder.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "errors.h"
#include "formats/formats.h"
#include "surface_file.h"

namespace brinell::cli {

namespace {

struct ShapeKind {
  const char* name;
  int kind;
};

constexpr ShapeKind kShapeKinds[] = {
    {"plane", BRN_SHAPE_PLANE},       {"sphere", BRN_SHAPE_SPHERE},         {"ellipsoid", BRN_SHAPE_ELLIPSOID},
    {"cone", BRN_SHAPE_CONE},         {"flat_punch", BRN_SHAPE_FLAT_PUNCH}, {"roller", BRN_SHAPE_ROLLER},
    {"sinusoid", BRN_SHAPE_SINUSOID},
};

template <class Struct>
struct NumberMember {
  const char* key;
  double Struct::*member;
};

constexpr NumberMember<brn_shape> kShapeNumbers[] = {
    {"radius", &brn_shape::radius},
    {"radius_x", &brn_shape::radius_x},
    {"radius_y", &brn_shape::radius_y},
    {"half_angle", &brn_shape::half_angle},
    {"tip_radius", &brn_shape::tip_radius},
    {"edge_radius", &brn_shape::edge_radius},
    {"straight_length", &brn_shape::straight_length},
    {"crown_radius", &brn_shape::crown_radius},
    {"amplitude", &brn_shape::amplitude},
};

constexpr NumberMember<brn_roughness> kRoughNumbers[] = {
    {"hurst", &brn_roughness::hurst},           {"rms_slope", &brn_roughness::rms_slope},
    {"rms_height", &brn_roughness::rms_height}, {"long_cutoff", &brn_roughness::long_cutoff},
    {"rolloff", &brn_roughness::rolloff},       {"short_cutoff", &brn_roughness::short_cutoff},
};

constexpr NumberMember<brn_hardening> kHardeningNumbers[] = {
    {"B", &brn_hardening::B},
    {"C", &brn_hardening::C},
    {"n", &brn_hardening::n},
    {"strain_scale", &brn_hardening::strain_scale},
    {"yield_stress", &brn_hardening::yield_stress},
    {"hardening_modulus", &brn_hardening::hardening_modulus},
    {"saturation_stress", &brn_hardening::saturation_stress},
    {"rate", &brn_hardening::rate},
    {"K", &brn_hardening::K},
    {"m", &brn_hardening::m},
};

struct LawKind {
  const char* name;
  int law;
};

constexpr LawKind kLaws[] = {
    {"swift", BRN_HARDENING_SWIFT},     {"linear", BRN_HARDENING_LINEAR},
    {"perfect", BRN_HARDENING_PERFECT}, {"voce", BRN_HARDENING_VOCE},
    {"table", BRN_HARDENING_TABLE},     {"ramberg-osgood", BRN_HARDENING_RAMBERG_OSGOOD},
};

template <class Struct, std::size_t size>
void fill_in(Struct& target, const std::map<std::string, double>& numbers,
             const NumberMember<Struct> (&members)[size]) {
  for (const auto& [key, member] : members) {
    const auto found = numbers.find(key);
    if (found != numbers.end()) target.*member = found->second;
  }
}

class Builder {
 public:
  explicit Builder(const SceneFile& file) : file_(file) {
    brn_scene* scene = nullptr;
    check(brn_scene_create(&scene));
    scene_.reset(scene);
  }

  BuiltScene build() {
    refuse_unsupported();
    read_height_maps();
    const brn_grid grid = set_grid();
    set_body(BRN_LOWER, file_.lower);
    set_body(BRN_UPPER, file_.upper.same_as_lower ? file_.lower : file_.upper);
    set_hardening();
    for (std::size_t k = 0; k < file_.surfaces.size(); ++k) add_surface(file_.surfaces[k], k, grid);
    for (const auto& step : file_.steps) add_step(step, grid);
    set_subsurface();
    brn_solver solver;
    brn_solver_init(&solver);
    solver.tolerance = file_.solver.tolerance;
    solver.max_iterations = file_.solver.max_iterations;
    solver.precision = file_.solver.mixed ? BRN_PRECISION_MIXED : BRN_PRECISION_DOUBLE;
    solver.increment_tolerance = file_.solver.increment_tolerance;
    accept(brn_scene_set_solver(scene_.get(), &solver), file_.solver.line, "[solver]");
    return {std::move(scene_), grid};
  }

 private:
  [[noreturn]] void fail(int line, const std::string& text) const {
    throw SceneError(file_.place(line == 0 ? 1 : line) + text);
  }

  /// What the engine refuses is told with the part's place in the file; lack of memory is no fault of the scene.
  void accept(brn_status status, int line, const std::string& part) const {
    if (status == BRN_OK) return;
    const std::string message = brn_scene_message(scene_.get());
    if (status != BRN_INVALID_ARGUMENT && status != BRN_INVALID_SCENE) throw EngineError(status, message);
    fail(line, part + ": " + message);
  }

  static std::string label_of(std::size_t surface) { return "[[surface]] " + std::to_string(surface + 1); }

  void refuse_unsupported() const {
    const std::string release = std::string(" is not supported by brinell ") + brn_version();
    for (const auto& field : file_.output.fields) {
      if (field_info(field).id != 0) continue;
      fail(file_.output.line, std::string("[output]: the field ").append(field).append(release));
    }
  }

  void read_height_maps() {
    maps_.resize(file_.surfaces.size());
    for (std::size_t k = 0; k < maps_.size(); ++k) {
      const SurfacePart& part = file_.surfaces[k];
      if (part.shape != "file") continue;
      try {
        maps_[k] = read_surface(part.path, {part.units, part.dataset, part.fill_missing});
      } catch (const SceneError& error) {
        fail(part.line, label_of(k) + ": " + error.what());
      }
    }
  }

  brn_grid set_grid() const {
    brn_grid grid;
    brn_grid_init(&grid);
    grid.boundary = file_.grid.periodic ? BRN_BOUNDARY_PERIODIC : BRN_BOUNDARY_FREE;
    for (const auto& map : maps_) {
      if (map && grid.nx == 0) {
        grid.nx = map->nx;
        grid.ny = map->ny;
      }
      if (map && grid.dx == 0 && map->dx > 0 && map->dy > 0) {
        grid.dx = map->dx;
        grid.dy = map->dy;
      }
    }
    if (file_.grid.nodes) {
      grid.nx = (*file_.grid.nodes)[0];
      grid.ny = (*file_.grid.nodes)[1];
    }
    if (file_.grid.spacing) {
      grid.dx = (*file_.grid.spacing)[0];
      grid.dy = (*file_.grid.spacing)[1];
    }
    if (grid.nx == 0)
      fail(file_.grid.line, "[grid]: the key nodes is missing, and there is no surface file that says it");
    if (grid.dx == 0)
      fail(file_.grid.line, "[grid]: the key spacing is missing, and there is no surface file that says it");
    accept(brn_scene_set_grid(scene_.get(), &grid), file_.grid.line, "[grid]");
    return grid;
  }

  void set_body(int which, const BodyPart& part) const {
    brn_body body;
    brn_body_init(&body);
    body.rigid = part.rigid ? 1 : 0;
    body.youngs_modulus = part.youngs_modulus;
    body.poissons_ratio = part.poissons_ratio;
    accept(brn_scene_set_body(scene_.get(), which, &body), part.line, which == BRN_LOWER ? "[lower]" : "[upper]");
  }

  void set_hardening() const {
    const auto set = [&](int which, const BodyPart& part, const char* label) {
      if (!part.hardening) return;
      const HardeningPart& from = *part.hardening;
      brn_hardening hardening;
      brn_hardening_init(&hardening);
      for (const auto& [name, law] : kLaws) {
        if (from.law == name) hardening.law = law;
      }
      fill_in(hardening, from.numbers, kHardeningNumbers);
      hardening.plastic_strain = from.plastic_strain.data();
      hardening.stress = from.stress.data();
      hardening.point_count = from.stress.size();
      std::vector<double> depths, factors;
      for (const auto& [depth, factor] : from.depth_factor) {
        depths.push_back(depth);
        factors.push_back(factor);
      }
      hardening.depths = depths.data();
      hardening.depth_factors = factors.data();
      hardening.depth_count = depths.size();
      accept(brn_scene_set_hardening(scene_.get(), which, &hardening), from.line, label);
    };
    set(BRN_LOWER, file_.lower, "[lower.hardening]");
    set(BRN_UPPER, file_.upper, "[upper.hardening]");
    if (file_.upper.same_as_lower) {
      accept(brn_scene_set_identical(scene_.get(), 1), file_.upper.line, "[upper]");
    }
    if (!file_.lower.hardening && !file_.upper.hardening) return;
    const GridPart& grid = file_.grid;
    if (grid.layers == 0 || grid.layer_thickness == 0) {
      fail(grid.line, "[grid]: layers and layer_thickness are missing, which a body that hardens needs");
    }
    accept(brn_scene_set_layers(scene_.get(), grid.layers, grid.layer_thickness), grid.line, "[grid]");
  }

  static std::int32_t owner_of(const SurfacePart& part) {
    return part.body == "upper" ? BRN_UPPER : part.body == "lower" ? BRN_LOWER : BRN_BODY_DEFAULT;
  }

  void add_surface(const SurfacePart& part, std::size_t index, const brn_grid& grid) {
    const std::string label = label_of(index);
    if (part.shape == "file") {
      require_fit(part, *maps_[index], grid, label);
      brn_heights heights;
      brn_heights_init(&heights);
      heights.values = maps_[index]->heights.data();
      heights.nx = maps_[index]->nx;
      heights.ny = maps_[index]->ny;
      heights.detrend = part.detrend == "plane"  ? BRN_DETREND_PLANE
                        : part.detrend == "mean" ? BRN_DETREND_MEAN
                                                 : BRN_DETREND_NONE;
      heights.body = owner_of(part);
      accept(brn_scene_add_heights(scene_.get(), &heights), part.line, label);
      maps_[index].reset();
    } else if (part.shape == "rough") {
      brn_roughness roughness;
      brn_roughness_init(&roughness);
      fill_in(roughness, part.numbers, kRoughNumbers);
      roughness.seed = part.seed;
      roughness.body = owner_of(part);
      accept(brn_scene_add_roughness(scene_.get(), &roughness), part.line, label);
    } else {
      brn_shape shape;
      brn_shape_init(&shape);
      for (const auto& [name, kind] : kShapeKinds) {
        if (part.shape == name) shape.kind = kind;
      }
      shape.profile = part.exact ? BRN_PROFILE_EXACT : BRN_PROFILE_PARABOLIC;
      fill_in(shape, part.numbers, kShapeNumbers);
      shape.wavelength_x = part.wavelength[0];
      shape.wavelength_y = part.wavelength[1];
      shape.body = owner_of(part);
      accept(brn_scene_add_shape(scene_.get(), &shape), part.line, label);
    }
  }

  /// Headers round a size to three or four digits, so that the spacing need only agree to a thousandth.
  void require_fit(const SurfacePart& part, const HeightMap& map, const brn_grid& grid,
                   const std::string& label) const {
    if (map.nx != grid.nx || map.ny != grid.ny) {
      fail(part.line, label + ": " + part.path.string() + " holds " + std::to_string(map.nx) + " x " +
                          std::to_string(map.ny) + " heights, the grid has " + std::to_string(grid.nx) + " x " +
                          std::to_string(grid.ny) + " nodes; expected the same");
    }
    const auto differs = [](double from_file, double from_grid) {
      return !std::isnan(from_file) && std::abs(from_file - from_grid) > 1e-3 * from_grid;
    };
    if (differs(map.dx, grid.dx) || differs(map.dy, grid.dy)) {
      fail(part.line, label + ": " + part.path.string() + " says that its spacing is " + number_text(map.dx) + " x " +
                          number_text(map.dy) + " m, the grid's is " + number_text(grid.dx) + " x " +
                          number_text(grid.dy) + " m; expected the same within 0.1 %");
    }
  }

  /// The engine would tell it without the line.
  void require_rotation(const StepPart& part, const brn_grid& grid, const std::string& label) const {
    const char* key = part.eccentricity ? "eccentricity" : "tilt";
    if ((part.eccentricity || part.tilt) && grid.boundary == BRN_BOUNDARY_PERIODIC) {
      fail(part.line,
           label + ": " + key + " is for boundary = \"free\" only: on a periodic grid a plane has no slope");
    }
    if (!part.eccentricity) return;
    const auto [x, y] = *part.eccentricity;
    const double last_x = 0.5 * static_cast<double>(grid.nx - 1) * grid.dx;
    const double last_y = 0.5 * static_cast<double>(grid.ny - 1) * grid.dy;
    if (std::abs(x) > last_x || std::abs(y) > last_y) {
      fail(part.line, label + ": eccentricity = [" + number_text(x) + ", " + number_text(y) +
                          "] m lies outside the grid, whose last nodes are at [" + number_text(last_x) + ", " +
                          number_text(last_y) + "] m; no contact can carry such a force");
    }
  }

  void add_step(const StepPart& part, const brn_grid& grid) const {
    const std::string label = "[[step]] " + std::to_string(&part - file_.steps.data() + 1);
    require_rotation(part, grid, label);
    brn_step step;
    brn_step_init(&step);
    step.increments = part.increments;
    step.drive = part.normal_force ? BRN_DRIVE_FORCE : part.approach ? BRN_DRIVE_APPROACH : BRN_DRIVE_MEAN_PRESSURE;
    step.target = part.normal_force ? *part.normal_force : part.approach ? *part.approach : *part.mean_pressure;
    if (part.traction_ratio) std::copy_n(part.traction_ratio->data(), 2, step.traction_ratio);
    if (part.tilt) std::copy_n(part.tilt->data(), 2, step.tilt);
    if (part.offset) std::copy_n(part.offset->data(), 2, step.offset);
    if (part.eccentricity) {
      step.rotation = BRN_ROTATION_FREE;
      std::copy_n(part.eccentricity->data(), 2, step.eccentricity);
    }
    accept(brn_scene_add_step(scene_.get(), &step), part.line, label);
  }

  /// Layers are read only if [output] asks for something below the surface.
  void set_subsurface() const {
    brn_subsurface wanted;
    brn_subsurface_init(&wanted);
    std::vector<std::int32_t> fields;
    std::string first;  // that asks
    for (const auto& name : file_.output.fields) {
      const FieldInfo info = field_info(name);
      refuse_elastic(name, info);
      if (!info.is_below_surface()) continue;
      fields.push_back(info.id);
      if (first.empty()) first = "the field " + name;
    }
    for (const auto& name : file_.output.maxima) {
      (name == "von_mises" ? wanted.max_von_mises : wanted.upper_max_von_mises) = 1;
      if (first.empty()) first = "the largest " + name;
    }
    if (first.empty()) return;

    const GridPart& grid = file_.grid;
    if (grid.layer_depths.empty() && (grid.layers == 0 || grid.layer_thickness == 0)) {
      const char* missing = grid.layers != 0            ? "layer_thickness is missing"
                            : grid.layer_thickness != 0 ? "layers is missing"
                                                        : "layers and layer_thickness, or layer_depths, are missing";
      fail(grid.line, std::string("[grid]: ") + missing + ", which " + first + " of [output] needs");
    }
    refuse_rigid(wanted, fields);
    wanted.layers = grid.layers;
    wanted.layer_thickness = grid.layer_thickness;
    wanted.depths = grid.layer_depths.data();
    wanted.depth_count = grid.layer_depths.size();
    wanted.fields = fields.data();
    wanted.field_count = fields.size();
    accept(brn_scene_set_subsurface(scene_.get(), &wanted), file_.output.line, "[output]");
  }

  void refuse_elastic(const std::string& name, const FieldInfo& info) const {
    if (!info.is_plastic()) return;
    const BodyPart& body = info.is_upper() && !file_.upper.same_as_lower ? file_.upper : file_.lower;
    if (body.hardening) return;
    fail(file_.output.line, "[output]: the field " + name + " is asked for, but that body has no hardening; add [" +
                                (info.is_upper() ? "upper" : "lower") + ".hardening] or leave the field out");
  }

  void refuse_rigid(const brn_subsurface& wanted, const std::vector<std::int32_t>& fields) const {
    bool lower = wanted.max_von_mises != 0;
    bool upper = wanted.upper_max_von_mises != 0;
    for (const std::int32_t field : fields) (field < BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT ? lower : upper) = true;
    const std::string reason = " body's stress is asked for, but that body is rigid; expected ";
    if (lower && file_.lower.rigid) {
      fail(file_.output.line, "[output]: the lower" + reason + "the upper body's, with the prefix upper_");
    }
    if (upper && file_.upper.rigid && !file_.upper.same_as_lower)
      fail(file_.output.line, "[output]: the upper" + reason + "the lower body's");
  }

  const SceneFile& file_;
  Scene scene_;
  std::vector<std::optional<HeightMap>> maps_;  ///< one for each surface
};

}  // namespace

BuiltScene build_scene(const SceneFile& file) {
  return Builder(file).build();
}

FieldInfo field_info(const std::string& name) {
  if (name == "pressure") return {BRN_FIELD_PRESSURE, "Pa"};
  if (name == "gap") return {BRN_FIELD_GAP, "m"};
  if (name == "displacement") return {BRN_FIELD_DISPLACEMENT, "m"};
  if (name == "undeformed_gap") return {BRN_FIELD_UNDEFORMED_GAP, "m"};
  if (name == "residual_displacement") return {BRN_FIELD_RESIDUAL_DISPLACEMENT, "m"};
  if (name == "upper_residual_displacement") return {BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT, "m"};
  const bool is_upper = name.starts_with("upper_");
  const std::string of_body = is_upper ? name.substr(6) : name;
  constexpr const char* kStresses[] = {"stress",      "von_mises",   "tresca",     "hydrostatic",
                                       "principal_1", "principal_2", "principal_3"};
  if (of_body == "principal_directions") {
    return {is_upper ? BRN_FIELD_UPPER_PRINCIPAL_DIRECTIONS : BRN_FIELD_PRINCIPAL_DIRECTIONS, "1"};
  }
  for (int k = 0; k < 7; ++k) {
    if (of_body == kStresses[k]) return {(is_upper ? BRN_FIELD_UPPER_STRESS : BRN_FIELD_STRESS) + k, "Pa"};
  }
  const int body = is_upper ? BRN_FIELD_UPPER_STRESS - BRN_FIELD_STRESS : 0;
  if (of_body == "plastic_strain") return {BRN_FIELD_PLASTIC_STRAIN + body, "1"};
  if (of_body == "equivalent_plastic_strain") return {BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN + body, "1"};
  if (of_body == "residual_stress") return {BRN_FIELD_RESIDUAL_STRESS + body, "Pa"};
  return {0, ""};
}

}  // namespace brinell::cli
