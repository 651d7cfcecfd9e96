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

constexpr std::array<Known, 16> kKnown{{
    {Field::pressure, "pressure", {}},
    {Field::gap, "gap", {}},
    {Field::displacement, "displacement", {}},
    {Field::undeformed_gap, "undeformed_gap", {}},
    {Field::residual_displacement, "residual_displacement", {}},
    {Field::stress, "stress", {}},
    {Field::von_mises, "von_mises", subsurface::Invariant::von_mises},
    {Field::tresca, "tresca", subsurface::Invariant::tresca},
    {Field::hydrostatic, "hydrostatic", subsurface::Invariant::hydrostatic},
    {Field::principal_1, "principal_1", subsurface::Invariant::principal_1},
    {Field::principal_2, "principal_2", subsurface::Invariant::principal_2},
    {Field::principal_3, "principal_3", subsurface::Invariant::principal_3},
    {Field::principal_directions, "principal_directions", {}},
    {Field::plastic_strain, "plastic_strain", {}},
    {Field::equivalent_plastic_strain, "equivalent_plastic_strain", {}},
    {Field::residual_stress, "residual_stress", {}},
}};

const Known& known(Field field) {
  return *std::find_if(kKnown.begin(), kKnown.end(),
                       [&](const Known& one) { return one.field == lower_field(field); });
}

}  // namespace

Field lower_field(Field field) {
  const auto number = static_cast<std::int32_t>(field);
  return static_cast<Field>(number >= kUpperField ? number - kUpperField : number);
}

std::optional<Field> field_of(std::int32_t number) {
  const auto field = static_cast<Field>(number);
  for (const Known& one : kKnown) {
    if (one.field == field) return field;
    if (one.field >= Field::residual_displacement && one.field == lower_field(field)) return field;
  }
  return {};
}

bool is_below_surface(Field field) {
  return lower_field(field) >= Field::stress;
}

bool is_stress(Field field) {
  return lower_field(field) >= Field::stress && lower_field(field) <= Field::principal_directions;
}

bool is_plastic(Field field) {
  return lower_field(field) == Field::residual_displacement || lower_field(field) >= Field::plastic_strain;
}

std::string name(Field field) {
  return std::string(body_of(field) == Which::upper ? "upper_" : "") + known(field).name;
}

Which body_of(Field field) {
  return static_cast<std::int32_t>(field) >= kUpperField ? Which::upper : Which::lower;
}

std::optional<subsurface::Invariant> invariant_of(Field field) {
  return known(field).invariant;
}

std::size_t values_per_node(Field field) {
  const Field lower = lower_field(field);
  if (lower == Field::principal_directions) return 9;
  const bool tensor = lower == Field::stress || lower == Field::plastic_strain || lower == Field::residual_stress;
  return tensor ? static_cast<std::size_t>(subsurface::kComponents) : 1;
}

}  // namespace brinell::scene
