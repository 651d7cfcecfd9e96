#include "scene/undeformed_gap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace brinell::scene {

namespace {

constexpr double kRounding = 1e-9;   // of a spacing: what sums of decimal numbers leave
constexpr double kMostNodes = 1e15;  // whole numbers that doubles tell apart, with digits to spare

bool has_node_values(const SurfaceEntry& entry) {
  return !std::holds_alternative<surface::Shape>(entry.form);
}

std::optional<std::int64_t> whole(double way, double spacing) {
  const double nodes = way / spacing;
  if (!(std::fabs(nodes) <= kMostNodes) || std::fabs(nodes - std::round(nodes)) > kRounding) return {};
  return std::llround(nodes);
}

double snapped(double way, double spacing) {
  const auto nodes = whole(way, spacing);
  return nodes ? static_cast<double>(*nodes) * spacing : way;
}

/// Sizes that are fine each for itself may overflow together, as x²/(2·radius) does for a tiny radius.
void check_finite(std::span<const double> gap, const Grid& grid) {
  for (std::size_t n = 0; n < gap.size(); ++n) {
    if (std::isfinite(gap[n])) continue;
    const auto i = static_cast<std::int64_t>(n) % grid.nx;
    const auto j = static_cast<std::int64_t>(n) / grid.nx;
    fail(Status::invalid_scene, "the gap of the undeformed surfaces at node (" + std::to_string(i) + ", " +
                                    std::to_string(j) + ") is " + text(gap[n]) +
                                    " m: must be finite; compare the sizes of the surfaces with the grid's, " +
                                    text(grid.dx) + " x " + text(grid.dy) + " m a cell");
  }
}

void add_node_values(const SurfaceEntry& entry, const Grid& grid, const parallel::Arena& arena,
                     std::span<double> gap) {
  if (const auto* roughness = std::get_if<surface::Roughness>(&entry.form)) {
    surface::add_to_gap(*roughness, {}, grid, gap, arena);
    return;
  }
  const auto& heights = std::get<Heights>(entry.form);
  surface::add_to_gap(surface::HeightMap::contiguous(heights.values->data(), grid.nx, grid.ny), heights.detrend, grid,
                      gap, arena);
}

/// result(i + shift.i, j + shift.j) += values(i, j), around the grid.
void add_moved(const Buffer<double>& values, const NodeShift& shift, const Grid& grid, std::span<double> result) {
  const auto around = [](std::int64_t n, std::int64_t nodes) { return ((n % nodes) + nodes) % nodes; };
  const std::int64_t by_i = around(shift.i, grid.nx), by_j = around(shift.j, grid.ny);
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    const double* from = values.data() + j * grid.nx;
    double* to = result.data() + (j + by_j) % grid.ny * grid.nx;
    for (std::int64_t i = 0; i < grid.nx; ++i) to[(i + by_i) % grid.nx] += from[i];
  }
}

/// Surface k has values at nodes; `what` has moved it, by whole nodes or not.
void check_node_values(const Scene& scene, std::size_t k, const std::string& what, bool is_whole,
                       const std::string& spacings) {
  const bool is_map = std::holds_alternative<Heights>(scene.surfaces()[k].form);
  const std::string surface =
      what + ", but surface " + std::to_string(k) + " of it " + (is_map ? "is a height map" : "is rough");
  if (is_map && scene.boundary() == Boundary::free) {
    fail(Status::invalid_scene, surface +
                                    ": on a free boundary nothing is known of what moves into the grid; give the map "
                                    "to the lower body and move the other surfaces by the offset, or make the "
                                    "boundary periodic");
  }
  if (!is_whole) fail(Status::invalid_scene, surface + ", which moves from node to node" + spacings);
}

/// Of step n.
void check_offset(const Scene& scene, std::size_t n) {
  const Grid& grid = scene.grid();
  const Step& step = scene.steps()[n];
  const Place place = place_of_upper(scene, static_cast<std::int32_t>(n));
  const std::string what = "step " + std::to_string(n) + ": offset = [" + text(step.offset[0]) + ", " +
                           text(step.offset[1]) + "] m takes the upper body to [" + text(place.x) + ", " +
                           text(place.y) + "] m";
  if (!std::isfinite(place.x) || !std::isfinite(place.y)) fail(Status::invalid_scene, what + ": must be finite");
  if (scene.hardens() && scene.identical()) {
    fail(Status::invalid_scene, what +
                                    ", but bodies that are each other's mirror image (same_as_lower) are solved as "
                                    "one: where one of them moves they are not; give the upper body its own "
                                    "youngs_modulus, poissons_ratio and hardening");
  }
  if (place == Place{}) return;
  const bool is_whole = whole_nodes(place, grid).has_value();
  const std::string spacings =
      ": must add up to whole multiples of the spacing, " + text(grid.dx) + " x " + text(grid.dy) + " m";
  if (scene.hardens(Which::upper) && !is_whole) {
    fail(Status::invalid_scene, what + ", which hardens, so that its cuboids move from node to node" + spacings);
  }
  for (std::size_t k = 0; k < scene.surfaces().size(); ++k) {
    const SurfaceEntry& entry = scene.surfaces()[k];
    if (entry.body == Which::upper && has_node_values(entry)) check_node_values(scene, k, what, is_whole, spacings);
  }
}

}  // namespace

Place place_of_upper(const Scene& scene, std::int32_t step) {
  Place place;
  for (std::int32_t n = 0; n <= step; ++n) {
    const Step& one = scene.steps()[static_cast<std::size_t>(n)];
    place.x += one.offset[0];
    place.y += one.offset[1];
  }
  return {snapped(place.x, scene.grid().dx), snapped(place.y, scene.grid().dy)};
}

std::optional<NodeShift> whole_nodes(const Place& place, const Grid& grid) {
  const auto i = whole(place.x, grid.dx), j = whole(place.y, grid.dy);
  if (!i || !j) return {};
  return NodeShift{*i, *j};
}

bool moves_node_values(const Scene& scene) {
  const auto is_moved = [](const SurfaceEntry& entry) {
    return entry.body == Which::upper && has_node_values(entry);
  };
  return std::any_of(scene.steps().begin(), scene.steps().end(), [](const Step& step) { return step.moves(); }) &&
         std::any_of(scene.surfaces().begin(), scene.surfaces().end(), is_moved);
}

void check_offsets(const Scene& scene) {
  for (std::size_t n = 0; n < scene.steps().size(); ++n) {
    if (scene.steps()[n].moves()) check_offset(scene, n);
  }
}

void sum_surfaces(const Scene& scene, const Place& place, const parallel::Arena& arena, std::span<double> gap) {
  const Grid& grid = scene.grid();
  std::fill(gap.begin(), gap.end(), 0.0);
  for (const SurfaceEntry& entry : scene.surfaces()) {
    const Place at = entry.body == Which::upper ? place : Place{};
    if (const auto* shape = std::get_if<surface::Shape>(&entry.form)) {
      surface::add_to_gap(*shape, {at.x, at.y}, grid, gap, arena, scene.boundary());
    } else if (at == Place{}) {
      add_node_values(entry, grid, arena, gap);
    } else {
      Buffer<double> values(grid.nodes());
      add_node_values(entry, grid, arena, values);
      add_moved(values, whole_nodes(at, grid).value(), grid, gap);
    }
  }
  check_finite(gap, grid);
}

}  // namespace brinell::scene
