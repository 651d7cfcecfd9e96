#include "scene_file.h"

#include <limits>
#include <sstream>

#include "errors.h"
#include "formats/formats.h"
#include "toml_table.h"

namespace brinell::cli {

namespace {

constexpr std::int64_t kMostInt32 = std::numeric_limits<std::int32_t>::max();

/// What one kind of surface or hardening law takes.
struct NumberKey {
  const char* name;
  Allowed allowed;
  bool required;
};

struct Kind {
  const char* name;
  std::vector<NumberKey> numbers;
};

const std::vector<Kind>& shapes() {
  static const std::vector<Kind> kShapes{
      {"plane", {}},
      {"sphere", {{"radius", Allowed::positive, true}}},
      {"ellipsoid", {{"radius_x", Allowed::positive, true}, {"radius_y", Allowed::positive, true}}},
      {"cone", {{"half_angle", Allowed::positive, true}, {"tip_radius", Allowed::not_negative, false}}},
      {"flat_punch", {{"radius", Allowed::positive, true}, {"edge_radius", Allowed::positive, true}}},
      {"roller",
       {{"radius", Allowed::positive, true},
        {"straight_length", Allowed::not_negative, true},
        {"crown_radius", Allowed::positive, true}}},
      {"sinusoid", {{"amplitude", Allowed::any, true}}},
      {"rough",
       {{"hurst", Allowed::positive, true},
        {"rms_slope", Allowed::positive, false},
        {"rms_height", Allowed::positive, false},
        {"long_cutoff", Allowed::positive, false},
        {"rolloff", Allowed::positive, false},
        {"short_cutoff", Allowed::positive, false}}},
      {"file", {}},
  };
  return kShapes;
}

const std::vector<Kind>& laws() {
  static const std::vector<Kind> kLaws{
      {"swift",
       {{"B", Allowed::positive, true},
        {"C", Allowed::not_negative, true},
        {"n", Allowed::not_negative, true},
        {"strain_scale", Allowed::positive, false}}},
      {"linear", {{"yield_stress", Allowed::positive, true}, {"hardening_modulus", Allowed::not_negative, true}}},
      {"perfect", {{"yield_stress", Allowed::positive, true}}},
      {"voce",
       {{"yield_stress", Allowed::positive, true},
        {"saturation_stress", Allowed::positive, true},
        {"rate", Allowed::positive, true}}},
      {"ramberg-osgood",
       {{"K", Allowed::positive, true}, {"m", Allowed::positive, true}, {"yield_stress", Allowed::positive, false}}},
      {"table", {}},
  };
  return kLaws;
}

std::vector<std::string> names(const std::vector<Kind>& kinds) {
  std::vector<std::string> list;
  list.reserve(kinds.size());
  for (const auto& kind : kinds) list.emplace_back(kind.name);
  return list;
}

/// Reads `key` as the name of a kind, and the numbers that this kind takes.
std::string read_kind(TomlTable& table, const std::string& key, const std::vector<Kind>& kinds,
                      std::map<std::string, double>& numbers) {
  if (!table.has(key)) table.fail("the key " + key + " is missing");
  std::string name = *table.choice(key, names(kinds));
  for (const auto& kind : kinds) {
    if (kind.name != name) continue;
    for (const auto& number : kind.numbers) {
      const auto value = table.number(number.name, number.allowed);
      if (number.required) {
        numbers[number.name] = table.required(number.name, value);
      } else if (value) {
        numbers[number.name] = *value;
      }
    }
  }
  return name;
}

GridPart read_grid(TomlTable& table) {
  GridPart grid;
  grid.line = table.line();
  grid.nodes = table.integer_pair("nodes", 1, kMostInt32);
  grid.spacing = table.number_pair("spacing", Allowed::positive);
  grid.layers = table.integer("layers", 1, kMostInt32).value_or(0);
  grid.layer_thickness = table.number("layer_thickness", Allowed::positive).value_or(0);
  grid.layer_depths = table.numbers("layer_depths", Allowed::not_negative);
  for (std::size_t k = 1; k < grid.layer_depths.size(); ++k) {
    if (!(grid.layer_depths[k] > grid.layer_depths[k - 1]))
      table.fail_key("layer_depths", "expected increasing depths");
  }
  if (table.has("layer_depths") && (table.has("layers") || table.has("layer_thickness"))) {
    table.fail_key("layer_depths", "expected either this, or layers and layer_thickness");
  }
  grid.periodic = table.choice("boundary", {"free", "periodic"}).value_or("free") == "periodic";
  table.finish();
  return grid;
}

HardeningPart read_hardening(TomlTable& table) {
  HardeningPart hardening;
  hardening.line = table.line();
  hardening.law = read_kind(table, "law", laws(), hardening.numbers);
  hardening.depth_factor = table.number_pairs("depth_factor");
  if (hardening.law == "table") {
    hardening.plastic_strain = table.numbers("plastic_strain", Allowed::not_negative);
    hardening.stress = table.numbers("stress", Allowed::positive);
    table.finish();
    if (hardening.stress.empty()) table.fail("the key stress is missing or empty");
    if (hardening.plastic_strain.size() != hardening.stress.size()) {
      table.fail("plastic_strain has " + std::to_string(hardening.plastic_strain.size()) + " values, stress has " +
                 std::to_string(hardening.stress.size()) + ", expected as many");
    }
  }
  table.finish();
  return hardening;
}

BodyPart read_body(TomlTable& table, bool is_upper) {
  BodyPart body;
  body.line = table.line();
  body.rigid = table.boolean("rigid").value_or(false);
  body.same_as_lower = is_upper && table.boolean("same_as_lower").value_or(false);
  const auto modulus = table.number("youngs_modulus", Allowed::positive);
  const auto ratio = table.number("poissons_ratio");
  auto hardening = table.table("hardening");
  if (body.rigid || body.same_as_lower) {
    const std::string reason = body.rigid ? "rigid = true" : "same_as_lower = true";
    for (const char* key : {"youngs_modulus", "poissons_ratio", "hardening"}) {
      if (table.has(key)) table.fail_key(key, "has no meaning beside " + reason);
    }
    if (body.rigid && body.same_as_lower) table.fail_key("same_as_lower", "has no meaning beside rigid = true");
  } else {
    body.youngs_modulus = table.required("youngs_modulus", modulus);
    body.poissons_ratio = table.required("poissons_ratio", ratio);
    table.finish();
    if (!(body.poissons_ratio > -1 && body.poissons_ratio < 0.5)) {
      table.fail_key("poissons_ratio", "expected above -1 and below 0.5");
    }
    if (hardening) body.hardening = read_hardening(*hardening);
  }
  table.finish();
  return body;
}

SurfacePart read_surface_part(TomlTable& table, const std::filesystem::path& folder) {
  SurfacePart surface;
  surface.line = table.line();
  surface.shape = read_kind(table, "shape", shapes(), surface.numbers);
  surface.body = table.choice("body", {"lower", "upper"}).value_or("");
  const std::string& shape = surface.shape;
  if (shape == "sphere" || shape == "ellipsoid" || shape == "roller") {
    surface.exact = table.choice("profile", {"parabolic", "exact"}).value_or("parabolic") == "exact";
  } else if (shape == "sinusoid") {
    surface.wavelength = table.required("wavelength", table.number_pair("wavelength", Allowed::not_negative));
  } else if (shape == "rough") {
    surface.seed =
        static_cast<std::uint64_t>(table.integer("seed", 0, std::numeric_limits<std::int64_t>::max()).value_or(0));
    if (table.has("rms_slope") == table.has("rms_height")) {
      table.finish();
      table.fail("expected exactly one of rms_slope and rms_height, found " +
                 std::string(table.has("rms_slope") ? "both" : "neither"));
    }
  } else if (shape == "file") {
    surface.path = folder / table.required("path", table.text("path"));
    surface.units = table.text("units").value_or("");
    if (table.has("units") && !(metres_per(surface.units) > 0)) {
      table.fail_key("units", "expected a unit of length: m, mm, um, nm or pm");
    }
    surface.dataset = table.text("dataset").value_or("");
    surface.fill_missing = table.boolean("fill_missing").value_or(false);
    surface.detrend = table.choice("detrend", {"none", "mean", "plane"}).value_or("none");
  }
  table.finish();
  return surface;
}

StepPart read_step(TomlTable& table, bool periodic) {
  StepPart step;
  step.line = table.line();
  step.normal_force = table.number("normal_force", Allowed::not_negative);
  step.mean_pressure = table.number("mean_pressure", Allowed::not_negative);
  step.approach = table.number("approach");
  step.increments = static_cast<std::int32_t>(table.integer("increments", 1, kMostInt32).value_or(1));
  step.eccentricity = table.number_pair("eccentricity");
  step.tilt = table.number_pair("tilt");
  step.offset = table.number_pair("offset");
  step.traction_ratio = table.number_pair("traction_ratio");
  table.finish();
  const int drives = table.has("normal_force") + table.has("mean_pressure") + table.has("approach");
  if (drives != 1) {
    table.fail("expected exactly one of normal_force, approach" + std::string(periodic ? ", mean_pressure" : "") +
               "; found " + (drives == 0 ? "none" : std::to_string(drives)));
  }
  if (step.mean_pressure && !periodic) {
    table.fail_key("mean_pressure", "is for boundary = \"periodic\" only; expected normal_force or approach");
  }
  if (step.eccentricity && step.tilt) table.fail_key("tilt", "expected either eccentricity or tilt, found both");
  return step;
}

SolverPart read_solver(TomlTable& table) {
  SolverPart solver;
  solver.line = table.line();
  solver.tolerance = table.number("tolerance", Allowed::positive).value_or(solver.tolerance);
  if (!(solver.tolerance >= 1e-14 && solver.tolerance <= 0.1)) table.fail_key("tolerance", "expected 1e-14 to 0.1");
  solver.max_iterations =
      static_cast<std::int32_t>(table.integer("max_iterations", 1, kMostInt32).value_or(solver.max_iterations));
  solver.mixed = table.choice("precision", {"double", "mixed"}).value_or("double") == "mixed";
  if (const auto allowed = table.number("increment_tolerance", Allowed::positive)) {
    if (!(*allowed >= 1e-6 && *allowed <= 1)) table.fail_key("increment_tolerance", "expected 1e-6 to 1");
    solver.increment_tolerance = *allowed;
  }
  solver.threads = static_cast<std::int32_t>(table.integer("threads", 0, 1024).value_or(0));
  table.finish();
  return solver;
}

OutputPart read_output(TomlTable& table) {
  static const std::vector<std::string> kFields{"pressure",
                                                "gap",
                                                "displacement",
                                                "undeformed_gap",
                                                "stress",
                                                "von_mises",
                                                "tresca",
                                                "hydrostatic",
                                                "principal_1",
                                                "principal_2",
                                                "principal_3",
                                                "principal_directions",
                                                "upper_stress",
                                                "upper_von_mises",
                                                "upper_tresca",
                                                "upper_hydrostatic",
                                                "upper_principal_1",
                                                "upper_principal_2",
                                                "upper_principal_3",
                                                "upper_principal_directions",
                                                "plastic_strain",
                                                "equivalent_plastic_strain",
                                                "residual_stress",
                                                "residual_displacement",
                                                "upper_plastic_strain",
                                                "upper_equivalent_plastic_strain",
                                                "upper_residual_stress",
                                                "upper_residual_displacement"};
  OutputPart output;
  output.line = table.line();
  const auto fields = table.texts("fields", kFields);
  if (table.has("fields")) output.fields = fields;
  output.maxima = table.texts("maxima", {"von_mises", "upper_von_mises"});
  const std::string increments = table.choice("increments", {"last", "all", "steps"}).value_or("last");
  output.increments = increments == "all"     ? StoredIncrements::all
                      : increments == "steps" ? StoredIncrements::steps
                                              : StoredIncrements::last;
  table.finish();
  return output;
}

/// Reads an optional table with its reader, or keeps the defaults.
template <class Part, class Read>
void read_part(TomlTable& root, const char* key, Part& part, Read read) {
  if (auto table = root.table(key)) part = read(*table);
}

}  // namespace

std::string SceneFile::place(int line) const {
  return path.string() + ":" + std::to_string(line) + ": ";
}

std::filesystem::path scene_path(const std::filesystem::path& scene) {
  std::error_code error;
  return std::filesystem::is_directory(scene, error) ? scene / "scene.toml" : scene;
}

SceneFile read_scene(const std::filesystem::path& scene) {
  const auto path = scene_path(scene);
  return parse_scene(path, read_bytes(path));
}

SceneFile parse_scene(const std::filesystem::path& path, std::string bytes) {
  toml::table document;
  try {
    document = toml::parse(std::string_view(bytes), path.string());
  } catch (const toml::parse_error& error) {
    throw SceneError(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description()));
  }
  SceneFile scene;
  scene.path = path;
  scene.bytes = std::move(bytes);

  TomlTable root(document, path.string(), "");
  scene.title = root.text("title").value_or("");
  read_part(root, "grid", scene.grid, read_grid);
  scene.upper.rigid = true;
  read_part(root, "upper", scene.upper, [](TomlTable& table) { return read_body(table, true); });
  scene.lower.rigid = true;
  read_part(root, "lower", scene.lower, [](TomlTable& table) { return read_body(table, false); });
  for (auto& table : root.tables("surface")) scene.surfaces.push_back(read_surface_part(table, path.parent_path()));
  for (auto& table : root.tables("step")) scene.steps.push_back(read_step(table, scene.grid.periodic));
  read_part(root, "solver", scene.solver, read_solver);
  read_part(root, "output", scene.output, read_output);
  root.finish();

  if (scene.lower.rigid && (scene.upper.rigid || scene.upper.same_as_lower)) {
    throw SceneError(scene.place(scene.lower.line != 0 ? scene.lower.line : 1) +
                     "both bodies are rigid; give youngs_modulus and poissons_ratio in [lower] or in [upper]");
  }
  if (scene.surfaces.empty()) root.fail("expected at least one [[surface]], found none");
  if (scene.steps.empty()) root.fail("expected at least one [[step]], found none");
  return scene;
}

}  // namespace brinell::cli
