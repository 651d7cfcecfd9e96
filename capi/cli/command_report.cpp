// report: pictures of a run from its files alone: certificate against time, load history, pressure of the last stored
// increment.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "errors.h"
#include "formats/formats.h"
#include "output/gnuplot.h"
#include "run_folder.h"

namespace brinell::cli {

namespace {

nlohmann::json read_summary(const RunFolder& folder) {
  auto summary = nlohmann::json::parse(read_bytes(folder.summary()), nullptr, false);
  if (!summary.is_object() || !summary.contains("increments") || !summary["increments"].is_array()) {
    fail_file(folder.summary(), "is not the summary of a run");
  }
  return summary;
}

double number(const nlohmann::json& increment, const char* key) {
  return increment.contains(key) && increment[key].is_number() ? increment[key].get<double>() : std::nan("");
}

/// A unit in which a number near `extent` reads without an exponent.
struct ReadableUnit {
  double scale;  ///< SI units in one of these
  const char* name;
};

ReadableUnit readable_length(double extent) {
  if (extent < 1e-6) return {1e-9, "nm"};
  if (extent < 1e-3) return {1e-6, "um"};
  if (extent < 1) return {1e-3, "mm"};
  return {1, "m"};
}

ReadableUnit readable_pressure(double extent) {
  if (extent > 1e9) return {1e9, "GPa"};
  if (extent > 1e6) return {1e6, "MPa"};
  if (extent > 1e3) return {1e3, "kPa"};
  return {1, "Pa"};
}

void draw_trace(const RunFolder& folder) {
  const std::string data = gnuplot_quoted(folder.trace().string());
  draw_picture(folder.path() / "trace",
               "set datafile separator ','\nset logscale y\nset format y '10^{%L}'\nset grid\n"
               "set xlabel 'seconds since the run began'\nset ylabel 'certificate (relative error)'\n"
               "plot " +
                   data +
                   " every ::1 using 7:($6 == 0 ? $8 : NaN) with points pt 7 ps 0.4 title 'estimate of "
                   "an iteration', " +
                   data +
                   " every ::1 using 7:($6 == 1 ? $8 : NaN) with points pt 6 ps 1.2 title "
                   "'certificate'");
}

void draw_history(const RunFolder& folder, const nlohmann::json& increments) {
  double extent = 0;
  for (const auto& increment : increments) extent = std::max(extent, std::abs(number(increment, "approach")));
  const ReadableUnit unit = readable_length(extent);
  std::string data;
  for (const auto& increment : increments) {
    data += number_text(number(increment, "approach") / unit.scale) + " " +
            number_text(number(increment, "normal_force")) + " " + number_text(number(increment, "contact_area")) +
            "\n";
  }
  draw_picture(folder.path() / "history",
               "$data << EOD\n" + data + "EOD\nset multiplot layout 2,1\nset grid\nset xlabel 'approach [" +
                   unit.name +
                   "]'\nset format y '%g'\nset ylabel 'force [N]'\n"
                   "plot $data using 1:2 with linespoints pt 7 notitle\nset ylabel 'contact area [m^2]'\n"
                   "plot $data using 1:3 with linespoints pt 7 lc 2 notitle\nunset multiplot");
}

/// Largest value of each block, so that small contacts stay visible when a map has more nodes than the picture.
RawMap shrunk(const RawMap& map, std::int64_t most) {
  const std::int64_t block = (std::max(map.nx, map.ny) + most - 1) / most;
  if (block <= 1) return map;
  RawMap small;
  small.nx = (map.nx + block - 1) / block;
  small.ny = (map.ny + block - 1) / block;
  small.dx = map.dx * static_cast<double>(block);
  small.dy = map.dy * static_cast<double>(block);
  small.heights.assign(static_cast<std::size_t>(small.nx * small.ny), -HUGE_VAL);
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) {
      double& value = small.heights[static_cast<std::size_t>(j / block * small.nx + i / block)];
      value = std::max(value, map.heights[static_cast<std::size_t>(j * map.nx + i)]);
    }
  }
  return small;
}

/// False if the run has not stored the pressure.
bool draw_pressure(const RunFolder& folder, const nlohmann::json& last) {
  const std::string place = "/step_" + std::to_string(last.at("step").get<int>()) + "/increment_" +
                            std::to_string(last.at("increment").get<int>()) + "/pressure";
  RawMap map;
  try {
    map = shrunk(read_hdf5(folder.fields(), place), 600);
  } catch (const FileError&) {
    return false;
  }
  const double extent = std::max(map.dx * static_cast<double>(map.nx), map.dy * static_cast<double>(map.ny));
  const ReadableUnit length = readable_length(extent);
  const ReadableUnit pressure = readable_pressure(*std::max_element(map.heights.begin(), map.heights.end()));
  std::string data;
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) {
      data += number_text(map.heights[static_cast<std::size_t>(j * map.nx + i)] / pressure.scale) + " ";
    }
    data += "\n";
  }
  const auto axis = [&](const char* column, std::int64_t count, double step) {
    return "(($" + std::string(column) + " - " + number_text(0.5 * static_cast<double>(count - 1)) + ") * " +
           number_text(step / length.scale) + ")";
  };
  draw_picture(folder.path() / "pressure",
               "$data << EOD\n" + data + "EOD\nset size ratio -1\nset tics out nomirror\nset xlabel 'x [" +
                   length.name + "]'\nset ylabel 'y [" + length.name + "]'\nset cblabel 'pressure [" + pressure.name +
                   "]'\nset palette defined (0 'white', 1 'gold', 2 'red', 3 'black')\nset autoscale fix\n"
                   "plot $data matrix using " +
                   axis("1", map.nx, map.dx) + ":" + axis("2", map.ny, map.dy) + ":3 with image notitle");
  return true;
}

}  // namespace

int report_command(const std::filesystem::path& path) {
  const RunFolder folder(path);
  const auto summary = read_summary(folder);
  const auto& increments = summary["increments"];
  if (increments.empty()) fail_file(folder.summary(), "holds no solved increment, there is nothing to draw");
  read_bytes(folder.trace());  // tells a missing file by its name
  std::vector<std::string> drawn{"trace", "history"};
  draw_trace(folder);
  draw_history(folder, increments);
  if (draw_pressure(folder, increments.back())) drawn.emplace_back("pressure");
  for (const auto& name : drawn) std::cout << (folder.path() / name).string() << ".svg, .png\n";
  return kSolved;
}

}  // namespace brinell::cli
