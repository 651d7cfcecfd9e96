// A description of what is to be solved: grid, bodies, surfaces, load history, solver. Each part is checked as it is
// set; that the parts fit together is checked when a run is made.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "base/buffer.h"
#include "base/grid.h"
#include "plastic/hardening.h"
#include "plastic/plastic_body.h"
#include "scene/field.h"
#include "surface/height_map.h"
#include "surface/roughness.h"
#include "surface/shapes.h"

namespace brinell::scene {

struct Body {
  bool rigid = true;
  double youngs_modulus = 0;  // [Pa]
  double poissons_ratio = 0;
};

/// A caller's heights, copied contiguously.
struct Heights {
  std::shared_ptr<const Buffer<double>> values;  // nx·ny, row-major
  surface::Detrend detrend = surface::Detrend::none;
};

/// What adds to the gap, and the body that it moves with.
struct SurfaceEntry {
  std::variant<surface::Shape, surface::Roughness, Heights> form;
  Which body = Which::lower;
};

/// Unless it is said: indenters are the upper body; planes and textures belong to the lower one, as heights do.
Which usual_body(const surface::Shape& shape);

enum class StepDrive : std::int32_t { none = 0, force = 1, approach = 2, mean_pressure = 3 };

struct Step {
  StepDrive drive = StepDrive::none;
  std::int32_t increments = 1;
  double target = 0;                  // [N], [m] or [Pa]
  bool free_rotation = false;         // the slopes follow from where the force acts
  double eccentricity[2] = {0, 0};    // where that is [m]; read with free_rotation
  double tilt[2] = {0, 0};            // slopes of the plane that is added to the gap; read without
  double traction_ratio[2] = {0, 0};  // full sliding: shear along x, y on the lower body / pressure
  double offset[2] = {0, 0};          // by which the upper body moves before the step [m]

  bool moves() const { return offset[0] != 0 || offset[1] != 0; }
};

struct SolverSettings {
  double tolerance = 1e-8;
  std::int32_t max_iterations = 2000;
  bool mixed_precision = false;
  double increment_tolerance = 0;  // on Increment::increment_error; 0: as the step says. Read where a body hardens
};

/// What is wanted of the stress below the surfaces.
struct Subsurface {
  std::vector<double> depths;              // [m], in each body's own frame
  std::vector<Field> fields;               // below the surface, of either body
  bool max_von_mises[2] = {false, false};  // by Which: the largest value and its place, without a field

  /// The stress of this body, or what follows from it.
  bool wants(Which body) const;

  /// Asked for, or a by-product: whoever wants the stress or the von Mises field gets it too.
  bool wants_max_von_mises(Which body) const;
};

class Scene {
 public:
  void set_grid(const Grid& grid, Boundary boundary);
  void set_body(Which which, const Body& body);
  void set_hardening(Which which, const std::optional<plastic::Hardening>& hardening);
  /// The upper body is the mirror image of the lower one, whatever it was set to.
  void set_identical(bool identical);
  /// In which a body that hardens is divided.
  void set_layers(const plastic::Layers& layers);
  /// body: whose surface it is; nothing: the usual one.
  void add(const surface::Shape& shape, std::optional<Which> body = {});
  void add(const surface::Roughness& roughness, Which body = Which::lower);
  void add(const surface::HeightMap& heights, surface::Detrend detrend, Which body = Which::lower);
  void add(const Step& step);
  void set_solver(const SolverSettings& solver);
  void set_subsurface(const Subsurface& wanted);

  const Grid& grid() const { return grid_; }
  Boundary boundary() const { return boundary_; }
  const std::vector<SurfaceEntry>& surfaces() const { return surfaces_; }
  const std::vector<Step>& steps() const { return steps_; }
  const SolverSettings& solver() const { return solver_; }
  const Body& body(Which which) const { return bodies_[identical_ ? 0 : static_cast<int>(which)]; }
  bool identical() const { return identical_; }
  bool hardens(Which which) const { return hardening(which).has_value(); }
  bool hardens() const { return hardens(Which::lower) || hardens(Which::upper); }
  const std::optional<plastic::Hardening>& hardening(Which which) const {
    return hardening_[identical_ ? 0 : static_cast<int>(which)];
  }
  const plastic::Layers& layers() const { return layers_; }
  const Subsurface& subsurface() const { return subsurface_; }

  /// 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂ [Pa]. Throws Status::invalid_scene if both bodies are rigid.
  double contact_modulus() const;

  /// Throws Status::invalid_scene if something is missing or does not fit together.
  void check_complete() const;

  /// Tells scenes apart: equal for equal descriptions.
  std::uint64_t fingerprint() const;

 private:
  void check_rotation(std::size_t n) const;
  void check_hardening() const;

  Grid grid_;
  Boundary boundary_ = Boundary::free;
  Body bodies_[2];
  std::optional<plastic::Hardening> hardening_[2];
  bool identical_ = false;
  plastic::Layers layers_;
  std::vector<SurfaceEntry> surfaces_;
  std::vector<Step> steps_;
  SolverSettings solver_;
  Subsurface subsurface_;
};

}  // namespace brinell::scene
