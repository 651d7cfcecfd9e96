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
  stress = 20,  // below the lower body's surface; the upper body's are higher by kUpperField
  von_mises = 21,
  tresca = 22,
  hydrostatic = 23,
  principal_1 = 24,
  principal_2 = 25,
  principal_3 = 26,
  principal_directions = 27,
};
inline constexpr std::int32_t kUpperField = 100;

/// Nothing if no field has this number.
std::optional<Field> field_of(std::int32_t number);

bool is_below_surface(Field field);

/// "pressure", "upper_von_mises".
std::string name(Field field);

/// Of a field below the surface:
Which body_of(Field field);
std::optional<subsurface::Invariant> invariant_of(Field field);  // nothing: the stress, or directions
bool is_stress(Field field);                                     // all six components
std::size_t values_per_node(Field field);                        // of the stress 6, of directions 9, else 1

}  // namespace brinell::scene
