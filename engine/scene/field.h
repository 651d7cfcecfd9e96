// The fields of an increment by their numbers in brinell.h: on the surface, and below that of either body.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "subsurface/stress_request.h"

namespace brinell::scene {

enum class Which : std::int32_t { lower = 0, upper = 1 };

enum class Field : std::int32_t {
  pressure = 1,
  gap = 2,
  displacement = 3,
  undeformed_gap = 4,
  residual_displacement = 10,  // of the lower body; the upper body's is higher by kUpperField
  stress = 20,                 // below the lower body's surface; the upper body's are higher by kUpperField
  von_mises = 21,
  tresca = 22,
  hydrostatic = 23,
  principal_1 = 24,
  principal_2 = 25,
  principal_3 = 26,
  principal_directions = 27,
  plastic_strain = 30,
  equivalent_plastic_strain = 31,
  residual_stress = 32,
};
inline constexpr std::int32_t kUpperField = 100;

/// Nothing if no field has this number.
std::optional<Field> field_of(std::int32_t number);

bool is_below_surface(Field field);
bool is_stress(Field field);   // the total one, its invariants or directions
bool is_plastic(Field field);  // exists for a body that hardens

/// "pressure", "upper_von_mises".
std::string name(Field field);

/// The lower body's field of the same kind.
Field lower_field(Field field);

/// Of a field of one body:
Which body_of(Field field);
std::optional<subsurface::Invariant> invariant_of(Field field);  // of a stress; nothing: its components or directions
std::size_t values_per_node(Field field);                        // of a tensor 6, of directions 9, else 1

}  // namespace brinell::scene
