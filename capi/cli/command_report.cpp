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
  const auto summary = nlohmann::json::parse(read_bytes(folder.summary()), nullptr, false);
  if (!summary.is_object() || !summary.contains("increments") || !summary["increments"].is_array()) {
    fail_file(folder.summary(), "is not the summary of a run");
  }
  return summary;
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
  std::string data;
  for (const auto& increment : increments) {
    for (const char* key : {"normal_force", "approach", "contact_area"}) {
      data += increment.at(key).is_number() ? number_text(increment[key].get<double>()) + " " : "NaN ";
    }
    data += "\n";
  }
  draw_picture(folder.path() / "history",
               "$data << EOD\n" + data +
                   "EOD\nset grid\nset y2tics\nset ytics nomirror\nset key top left\n"
                   "set xlabel 'approach [m]'\nset ylabel 'normal force [N]'\nset y2label 'contact area [m^2]'\n"
                   "plot $data using 2:1 with linespoints pt 7 title 'force', "
                   "$data using 2:3 axes x1y2 with linespoints pt 6 title 'area'");
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
  std::string data;
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) {
      data += number_text(map.heights[static_cast<std::size_t>(j * map.nx + i)]) + " ";
    }
    data += "\n";
  }
  const auto axis = [](const char* column, std::int64_t count, double step) {
    return "(($" + std::string(column) + " - " + number_text(0.5 * static_cast<double>(count - 1)) + ") * " +
           number_text(step) + ")";
  };
  draw_picture(
      folder.path() / "pressure",
      "$data << EOD\n" + data +
          "EOD\nset size ratio -1\nset tics out\nset xlabel 'x [m]'\n"
          "set ylabel 'y [m]'\nset cblabel 'pressure [Pa]'\nset palette defined (0 'white', 1 'gold', 2 'red', 3 "
          "'black')\nset autoscale fix\nset format x '%.1s %c'\nset format y '%.1s %c'\nset format cb '%.1s %c'\n"
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
