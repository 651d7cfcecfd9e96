// A scene file as plain values: the keys of the contract, types and simple ranges checked, defaults filled in.
//
// Ranges that depend on physics are the engine's to check; what is stored here says on which line a part stands.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace brinell::cli {

struct GridPart {
  int line = 0;
  std::optional<std::array<std::int64_t, 2>> nodes;  ///< left out: those of the first surface file
  std::optional<std::array<double, 2>> spacing;      ///< [m]; left out: that of the first surface file that says it
  std::int64_t layers = 0;
  double layer_thickness = 0;        ///< [m]
  std::vector<double> layer_depths;  ///< [m], instead of equal layers
  bool periodic = false;
};

struct HardeningPart {
  int line = 0;
  std::string law;
  std::map<std::string, double> numbers;  ///< the law's parameters by key
  std::vector<double> plastic_strain, stress;
  std::vector<std::array<double, 2>> depth_factor;  ///< depth [m], factor
};

struct BodyPart {
  int line = 0;
  bool rigid = false;
  bool same_as_lower = false;
  double youngs_modulus = 0;  ///< [Pa]
  double poissons_ratio = 0;
  std::optional<HardeningPart> hardening;
};

struct SurfacePart {
  int line = 0;
  std::string shape;
  std::string body;                       ///< lower or upper; empty: as its shape has it
  std::map<std::string, double> numbers;  ///< lengths, angles and exponents by key
  std::array<double, 2> wavelength{};     ///< sinusoid [m]
  bool exact = false;                     ///< sphere, ellipsoid, roller
  std::uint64_t seed = 0;                 ///< rough
  std::filesystem::path path;             ///< file: absolute, or relative to the working folder
  std::string units, dataset, detrend = "none";
  bool fill_missing = false;
};

struct StepPart {
  int line = 0;
  std::optional<double> normal_force;   ///< [N]; exactly one of these three
  std::optional<double> mean_pressure;  ///< [Pa]
  std::optional<double> approach;       ///< [m]
  std::int32_t increments = 1;
  std::optional<std::array<double, 2>> eccentricity;    ///< [m]
  std::optional<std::array<double, 2>> tilt;            ///< [rad]
  std::optional<std::array<double, 2>> offset;          ///< [m]
  std::optional<std::array<double, 2>> traction_ratio;  ///< shear / pressure
};

struct SolverPart {
  int line = 0;
  double tolerance = 1e-8;
  std::int32_t max_iterations = 2000;
  bool mixed = false;
  double increment_tolerance = 0;  // none
  std::int32_t threads = 0;
};

enum class StoredIncrements { last, all, steps };

struct OutputPart {
  int line = 0;
  std::vector<std::string> fields{"pressure", "gap", "displacement"};
  std::vector<std::string> maxima;  ///< von_mises, upper_von_mises: in the summary, without a field
  StoredIncrements increments = StoredIncrements::last;
};

struct SceneFile {
  std::filesystem::path path;
  std::string bytes;  ///< the file as it was read
  std::string title;
  GridPart grid;
  BodyPart lower, upper;
  std::vector<SurfacePart> surfaces;
  std::vector<StepPart> steps;
  SolverPart solver;
  OutputPart output;

  /// "scene.toml:12: " for messages about the part that begins on a line.
  std::string place(int line) const;
};

/// `scene` is a TOML file or a folder that holds scene.toml. Throws FileError if it cannot be read, SceneError with
/// key and line if it is no valid scene.
SceneFile read_scene(const std::filesystem::path& scene);

/// The file that `scene` names.
std::filesystem::path scene_path(const std::filesystem::path& scene);

/// The same from text; paths inside are relative to `path`'s folder.
SceneFile parse_scene(const std::filesystem::path& path, std::string bytes);

}  // namespace brinell::cli
