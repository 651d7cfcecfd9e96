#include "scene/field.h"

#include <algorithm>
#include <array>

namespace brinell::scene {

namespace {

struct Known {
  Field field;
  const char* name;
  std::optional<subsurface::Invariant> invariant;
};

constexpr std::array<Known, 12> kKnown{{
    {Field::pressure, "pressure", {}},
    {Field::gap, "gap", {}},
    {Field::displacement, "displacement", {}},
    {Field::undeformed_gap, "undeformed_gap", {}},
    {Field::stress, "stress", {}},
    {Field::von_mises, "von_mises", subsurface::Invariant::von_mises},
    {Field::tresca, "tresca", subsurface::Invariant::tresca},
    {Field::hydrostatic, "hydrostatic", subsurface::Invariant::hydrostatic},
    {Field::principal_1, "principal_1", subsurface::Invariant::principal_1},
    {Field::principal_2, "principal_2", subsurface::Invariant::principal_2},
    {Field::principal_3, "principal_3", subsurface::Invariant::principal_3},
    {Field::principal_directions, "principal_directions", {}},
}};

Field of_lower_body(Field field) {
  const auto number = static_cast<std::int32_t>(field);
  return static_cast<Field>(number >= kUpperField ? number - kUpperField : number);
}

const Known& known(Field field) {
  return *std::find_if(kKnown.begin(), kKnown.end(),
                       [&](const Known& one) { return one.field == of_lower_body(field); });
}

}  // namespace

std::optional<Field> field_of(std::int32_t number) {
  const auto field = static_cast<Field>(number);
  for (const Known& one : kKnown) {
    if (one.field == field) return field;
    if (is_below_surface(one.field) && one.field == of_lower_body(field)) return field;
  }
  return {};
}

bool is_below_surface(Field field) {
  return of_lower_body(field) >= Field::stress;
}

std::string name(Field field) {
  return std::string(is_below_surface(field) && body_of(field) == Which::upper ? "upper_" : "") + known(field).name;
}

Which body_of(Field field) {
  return static_cast<std::int32_t>(field) >= kUpperField ? Which::upper : Which::lower;
}

std::optional<subsurface::Invariant> invariant_of(Field field) {
  return known(field).invariant;
}

bool is_stress(Field field) {
  return of_lower_body(field) == Field::stress;
}

std::size_t values_per_node(Field field) {
  if (is_stress(field)) return subsurface::kComponents;
  return of_lower_body(field) == Field::principal_directions ? 9 : 1;
}

}  // namespace brinell::scene
