// From a scene file to a scene of the engine: reads the height maps and hands everything over.
#pragma once

#include "handles.h"
#include "scene_file.h"

namespace brinell::cli {

struct BuiltScene {
  Scene scene;
  brn_grid grid;
};

/// Throws FileError for a height map that cannot be read, and SceneError with the line of the part that the engine
/// refuses or that does not fit.
BuiltScene build_scene(const SceneFile& file);

/// Identifier of a field of [output], BRN_FIELD_..., and its unit; 0 if this release does not compute it.
struct FieldInfo {
  int id;
  const char* unit;

  int of_lower() const { return is_upper() ? id - (BRN_FIELD_UPPER_STRESS - BRN_FIELD_STRESS) : id; }
  bool is_upper() const { return id >= BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT; }
  bool is_below_surface() const { return of_lower() >= BRN_FIELD_STRESS; }
  bool is_tensor() const {
    return of_lower() == BRN_FIELD_STRESS || of_lower() == BRN_FIELD_PLASTIC_STRAIN ||
           of_lower() == BRN_FIELD_RESIDUAL_STRESS;
  }
  bool is_directions() const { return of_lower() == BRN_FIELD_PRINCIPAL_DIRECTIONS; }
  bool is_plastic() const {
    return of_lower() == BRN_FIELD_RESIDUAL_DISPLACEMENT || of_lower() >= BRN_FIELD_PLASTIC_STRAIN;
  }
};
FieldInfo field_info(const std::string& name);

}  // namespace brinell::cli
