#include "output/summary.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "formats/formats.h"

namespace brinell::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<brn_plan_item> plan_items(brn_run* run) {
  std::vector<brn_plan_item> items(static_cast<std::size_t>(brn_run_plan_count(run)));
  for (std::size_t k = 0; k < items.size(); ++k) {
    brn_plan_item_init(&items[k]);
    check(brn_run_get_plan_item(run, static_cast<int>(k), &items[k]), run);
  }
  return items;
}

Json stages_json(const std::vector<brn_plan_item>& items) {
  Json stages = Json::array();
  for (const auto& item : items) {
    if (std::find(stages.begin(), stages.end(), item.stage) == stages.end()) stages.push_back(item.stage);
  }
  return stages;
}

/// Coordinates or slopes; null if they do not exist.
Json pair_json(const double (&values)[2]) {
  if (values[0] != values[0] || values[1] != values[1]) return nullptr;
  return {values[0], values[1]};
}

Json place_json(const double (&values)[3]) {
  if (values[0] != values[0]) return nullptr;
  return {values[0], values[1], values[2]};
}

Json number_json(double value) {
  if (value != value) return nullptr;
  return value;
}

/// Null where the body does not harden, so that its largest plastic strain is no number.
Json count_json(std::int64_t count, double largest) {
  if (largest != largest) return nullptr;
  return count;
}

Json increment_json(const brn_increment& increment) {
  return {{"step", increment.step},
          {"increment", increment.increment},
          {"converged", increment.converged != 0},
          {"normal_force", increment.normal_force},
          {"approach", increment.approach},
          {"tilt", pair_json(increment.tilt)},
          {"offset", pair_json(increment.offset)},
          {"centre_of_force", pair_json(increment.centre_of_force)},
          {"first_touch", increment.first_touch},
          {"contact_area", increment.contact_area},
          {"contact_nodes", increment.contact_nodes},
          {"max_pressure", increment.max_pressure},
          {"max_pressure_at", pair_json(increment.max_pressure_at)},
          {"mean_gap", increment.mean_gap},
          {"max_von_mises", number_json(increment.max_von_mises)},
          {"max_von_mises_at", place_json(increment.max_von_mises_at)},
          {"upper_max_von_mises", number_json(increment.upper_max_von_mises)},
          {"upper_max_von_mises_at", place_json(increment.upper_max_von_mises_at)},
          {"max_equivalent_plastic_strain", number_json(increment.max_equivalent_plastic_strain)},
          {"max_equivalent_plastic_strain_at", place_json(increment.max_equivalent_plastic_strain_at)},
          {"plastic_nodes", count_json(increment.plastic_nodes, increment.max_equivalent_plastic_strain)},
          {"upper_max_equivalent_plastic_strain", number_json(increment.upper_max_equivalent_plastic_strain)},
          {"upper_max_equivalent_plastic_strain_at", place_json(increment.upper_max_equivalent_plastic_strain_at)},
          {"upper_plastic_nodes",
           count_json(increment.upper_plastic_nodes, increment.upper_max_equivalent_plastic_strain)},
          {"substeps", increment.substeps},
          {"increment_error", number_json(increment.increment_error)},
          {"iterations", increment.iterations},
          {"convolutions", increment.convolutions},
          {"certificate",
           {{"penetration", increment.penetration},
            {"complementarity", increment.complementarity},
            {"tension", increment.tension},
            {"balance", increment.balance},
            {"yield", number_json(increment.yield)}}},
          {"wall_seconds", increment.wall_seconds}};
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  double value = static_cast<double>(bytes);
  for (; value >= 1024 && unit + 1 < kUnits.size(); ++unit) value /= 1024;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", value, kUnits[unit]);
  return text.data();
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

double worst_of(const brn_increment& i) {
  const double contact = std::max({i.penetration, i.complementarity, i.tension, i.balance});
  return i.yield > contact ? i.yield : contact;  // yield is no number where nothing hardens
}

std::string von_mises_text(double value) {
  std::array<char, 32> text{"-"};
  if (value == value) std::snprintf(text.data(), text.size(), "%.5g", value);
  return padded(text.data(), 11);
}

}  // namespace

Json summary_json(const SceneFile& file, const brn_engine* engine, brn_run* run, bool interrupted,
                  double wall_seconds) {
  const auto items = plan_items(run);
  const int solved = brn_run_solved_increments(run);
  bool converged = solved == brn_run_total_increments(run);
  Json increments = Json::array();
  for (int k = 0; k < solved; ++k) {
    const brn_increment increment = increment_of(run, k);
    converged = converged && increment.converged != 0;
    increments.push_back(increment_json(increment));
  }
  Json stage_seconds = Json::object();
  for (int k = 0; brn_run_stage_name(run, k) != nullptr; ++k) {
    stage_seconds[brn_run_stage_name(run, k)] = brn_run_stage_seconds(run, k);
  }
  return {{"title", file.title},
          {"converged", converged},
          {"interrupted", interrupted},
          {"version", brn_version()},
          {"engine",
           {{"isa", brn_engine_isa_name(engine)},
            {"threads", brn_engine_threads(engine)},
            {"precision", file.solver.mixed ? "mixed" : "double"}}},
          {"plan", {{"stages", stages_json(items)}, {"memory_bytes", brn_run_memory_bytes(run)}}},
          {"increments", increments},
          {"wall_seconds", wall_seconds},
          {"stage_seconds", stage_seconds}};
}

Json plan_json(const SceneFile& file, const brn_grid& grid, brn_run* run) {
  const auto items = plan_items(run);
  Json list = Json::array();
  for (const auto& item : items) list.push_back({{"stage", item.stage}, {"what", item.what}, {"bytes", item.bytes}});
  return {{"title", file.title},
          {"nodes", {grid.nx, grid.ny}},
          {"spacing", {grid.dx, grid.dy}},
          {"increments", brn_run_total_increments(run)},
          {"stages", stages_json(items)},
          {"items", list},
          {"memory_bytes", brn_run_memory_bytes(run)}};
}

std::string trace_csv(brn_run* run) {
  std::string text = "step,increment,iteration,nx,ny,certified,seconds,certificate\n";
  const std::int64_t count = brn_run_trace_count(run);
  for (std::int64_t k = 0; k < count; ++k) {
    brn_trace_point point;
    brn_trace_point_init(&point);
    check(brn_run_get_trace_point(run, k, &point), run);
    for (const std::int64_t value :
         {std::int64_t{point.step}, std::int64_t{point.increment}, std::int64_t{point.iteration}, point.nx, point.ny,
          std::int64_t{point.certified}}) {
      text += std::to_string(value) + ",";
    }
    text += number_text(point.seconds) + "," + number_text(point.certificate) + "\n";
  }
  return text;
}

std::string summary_table(brn_run* run) {
  const bool below = !depths_of(run).empty();
  std::string text = "step  increment  force [N]    approach [m]  area [m2]    max p [Pa]   ";
  text += below ? "von Mises    upper [Pa]   iterations  certificate\n" : "iterations  certificate\n";
  for (int k = 0; k < brn_run_solved_increments(run); ++k) {
    const brn_increment i = increment_of(run, k);
    const double worst = worst_of(i);
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "%4d  %9d  %-11.5g  %-12.5g  %-11.5g  %-11.5g  ", i.step, i.increment,
                  i.normal_force, i.approach, i.contact_area, i.max_pressure);
    text += line.data();
    if (below) text += von_mises_text(i.max_von_mises) + "  " + von_mises_text(i.upper_max_von_mises) + "  ";
    std::snprintf(line.data(), line.size(), "%10d  %.1e%s\n", i.iterations, worst,
                  i.converged != 0 ? "" : "  not converged");
    text += line.data();
  }
  return text;
}

std::string plan_table(const SceneFile& file, const brn_grid& grid, brn_run* run) {
  std::string text = (file.title.empty() ? file.path.string() : file.title) + "\n";
  text += "grid  " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " nodes, spacing " +
          number_text(grid.dx) + " x " + number_text(grid.dy) + " m, " + (file.grid.periodic ? "periodic" : "free") +
          "\n";
  text += "load  " + counted(static_cast<std::size_t>(brn_run_total_increments(run)), "increment") + " in " +
          counted(file.steps.size(), "step") + "\n\n";
  const auto items = plan_items(run);
  std::size_t stage_width = 5;
  std::size_t what_width = 4;
  for (const auto& item : items) {
    stage_width = std::max(stage_width, std::string_view(item.stage).size());
    what_width = std::max(what_width, std::string_view(item.what).size());
  }
  for (const auto& item : items) {
    text +=
        padded(item.stage, stage_width) + "  " + padded(item.what, what_width) + "  " + bytes_text(item.bytes) + "\n";
  }
  return text + padded("total", stage_width + what_width + 2) + "  " + bytes_text(brn_run_memory_bytes(run)) + "\n";
}

}  // namespace brinell::cli
