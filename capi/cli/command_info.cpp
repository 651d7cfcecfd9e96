// info: the engine on this machine, or the height maps named.
#include <brinell.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "handles.h"
#include "surface_file.h"

namespace brinell::cli {

namespace {

using Json = nlohmann::ordered_json;

Json engine_json() {
  const Engine engine = make_engine(0);
  return {{"version", brn_version()},
          {"isa", brn_engine_isa_name(engine.get())},
          {"threads", brn_engine_threads(engine.get())},
          {"surface_formats", {"Gwyddion text", "GSF", "NPY", "text matrix", "X3P", "HDF5"}}};
}

/// Size, spacing and ISO 25178-2 height statistics; null where the file does not say its spacing.
Json surface_json(const std::filesystem::path& path) {
  const HeightMap map = read_surface(path);
  brn_heights heights;
  brn_heights_init(&heights);
  heights.values = map.heights.data();
  heights.nx = map.nx;
  heights.ny = map.ny;
  const bool has_spacing = !std::isnan(map.dx) && !std::isnan(map.dy);
  brn_statistics statistics;
  brn_statistics_init(&statistics);
  check(brn_height_statistics(&heights, has_spacing ? map.dx : 1.0, has_spacing ? map.dy : 1.0, &statistics));
  Json values{{"path", path.string()},
              {"nodes", {map.nx, map.ny}},
              {"spacing", {map.dx, map.dy}},
              {"Sa", statistics.sa},
              {"Sq", statistics.sq},
              {"Ssk", statistics.ssk},
              {"Sku", statistics.sku},
              {"Sp", statistics.sp},
              {"Sv", statistics.sv},
              {"Sz", statistics.sz},
              {"Sdq", nullptr}};
  if (has_spacing) values["Sdq"] = statistics.sdq;
  return values;
}

void print_lines(const Json& values) {
  for (const auto& [key, value] : values.items()) {
    std::cout << key << ": " << (value.is_string() ? value.get<std::string>() : value.dump()) << "\n";
  }
}

}  // namespace

int info_command(const std::vector<std::filesystem::path>& surfaces, bool json) {
  Json list = Json::array();
  for (const auto& path : surfaces) list.push_back(surface_json(path));
  if (surfaces.empty()) list.push_back(engine_json());
  if (json) {
    std::cout << (surfaces.empty() ? list[0] : list).dump(2) << "\n";
    return kSolved;
  }
  for (const auto& values : list) print_lines(values);
  return kSolved;
}

}  // namespace brinell::cli
