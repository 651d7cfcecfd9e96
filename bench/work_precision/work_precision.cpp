// Error against run time of a scene, as a table (CSV) and a picture (SVG, PNG): one curve per method, the textbook
// included, and the front of what is best for each time.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "output/gnuplot.h"
#include "output/staged_file.h"
#include "work_precision/sweep.h"

namespace {

using namespace brinell;
using bench::Sweep;
using bench::SweepKind;
using bench::SweepPoint;

std::string csv(const Sweep& sweep) {
  std::ostringstream text;
  text.precision(6);
  text << "method,nx,ny,tolerance,seconds,relative_error,certificate,iterations,convolutions,on_front\n";
  for (const SweepPoint& p : sweep.points) {
    text << p.method << ',' << p.nx << ',' << p.ny << ',' << p.tolerance << ',' << p.seconds << ',' << p.error << ','
         << p.certificate << ',' << p.iterations << ',' << p.convolutions << ',' << (p.on_front ? 1 : 0) << '\n';
  }
  return text.str();
}

template <class Wanted>
void add_block(std::ostringstream& script, const std::string& name, const Sweep& sweep, const Wanted& wanted) {
  std::vector<SweepPoint> points;
  std::copy_if(sweep.points.begin(), sweep.points.end(), std::back_inserter(points), wanted);
  if (name == "$front") {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  }
  script << name << " << EOD\n";
  for (const SweepPoint& p : points) {
    if (!(p.error > 0)) continue;  // no place on a logarithmic axis
    std::ostringstream label;
    if (sweep.kind == SweepKind::grid) {
      label << p.nx;
    } else {
      label << p.tolerance;
    }
    script << p.seconds << ' ' << p.error << ' ' << label.str() << '\n';
  }
  script << "EOD\n";
}

std::string script(const Sweep& sweep, const std::string& title) {
  const std::string labels = sweep.kind == SweepKind::grid ? "nodes in x" : "tolerance";
  std::ostringstream script;
  for (const char* method : {"textbook", "double", "mixed"}) {
    add_block(script, "$" + std::string(method), sweep, [&](const SweepPoint& p) { return p.method == method; });
  }
  add_block(script, "$front", sweep, [](const SweepPoint& p) { return p.on_front; });
  script << "set title " << cli::gnuplot_quoted(title + ", error of the " + sweep.error_of)
         << " noenhanced font ',12'\n"
         << "set xlabel 'seconds of CPU time, one thread (labels: " << labels << ")'\n"
         << "set ylabel 'relative error'\n"
         << "set logscale xy\nset format y '10^{%L}'\nset format x '%g'\nset grid\nset key top right\n"
         << "set offsets graph 0.05, graph 0.08, graph 0.05, graph 0.05\n"
         << "plot $front with lines lw 8 lc rgb '#d8d8d8' title 'Pareto front', \\\n"
         << " $textbook with linespoints pt 5 lc rgb '#c04020' title 'textbook', \\\n"
         << " $double with linespoints pt 7 lc rgb '#2060c0' title 'brinell, double', \\\n"
         << " $mixed with linespoints pt 9 lc rgb '#20a060' title 'brinell, mixed', \\\n"
         << " $textbook using 1:2:3 with labels left offset 0.7,0.4 font ',9' notitle, \\\n"
         << " $double using 1:2:3 with labels right offset -0.7,-0.4 font ',9' notitle\n";
  return script.str();
}

void write(const Sweep& sweep, const std::string& title, const std::filesystem::path& stem) {
  cli::write_file(stem.string() + ".csv", csv(sweep));
  cli::draw_picture(stem, script(sweep, title));
  std::printf("%s.csv, .svg, .png\n", stem.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene_path;
  std::filesystem::path out = ".";
  std::string name;
  bench::SweepOptions options;
  std::int64_t coarsest = 64, finest = 1024;
  CLI::App app("Error against run time of one load of a scene.", "work_precision");
  app.add_option("SCENE", scene_path, "TOML file, or a folder that holds scene.toml")->required();
  app.add_option("--out", out, "Folder of the results");
  app.add_option("--name", name, "Of the result files (before _tolerance and _grid)")->required();
  app.add_option("--step", options.step, "Which step's load, from 0")->capture_default_str();
  app.add_option("--rounds", options.rounds, "Turns of each point")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--coarsest", coarsest, "Nodes in x of the coarsest grid")->capture_default_str();
  app.add_option("--finest", finest, "Nodes in x of the finest grid")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const cli::SceneFile scene = cli::read_scene(scene_path);
    cli::make_output_folder(out);
    const Sweep tolerances = bench::sweep_tolerances(scene, options);
    write(tolerances, scene.title, out / (name + "_tolerance"));
    if (const auto grids = bench::sweep_grids(scene, options, coarsest, finest)) {
      write(*grids, scene.title, out / (name + "_grid"));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "work_precision: %s\n", error.what());
    return 3;
  }
  return 0;
}
