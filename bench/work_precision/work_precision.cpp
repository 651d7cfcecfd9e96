// Error against run time of a scene, as tables and pictures: what sweep.h sweeps.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "output/staged_file.h"
#include "work_precision/picture.h"
#include "work_precision/sweep.h"

int main(int argc, char** argv) {
  using namespace brinell;
  std::string scene_path;
  std::filesystem::path out = ".";
  std::string name;
  bench::SweepOptions options;
  options.grids = {64, 128, 256, 512, 1024};
  std::vector<std::string> sweeps{"tolerance", "grid", "increments"};
  CLI::App app("Error against run time of a scene.", "work_precision");
  app.add_option("SCENE", scene_path, "TOML file, or a folder that holds scene.toml")->required();
  app.add_option("--out", out, "Folder of the results");
  app.add_option("--name", name, "Of the result files (before _tolerance, _grid and _increments)")->required();
  app.add_option("--sweeps", sweeps, "tolerance,grid,increments; the last where a body hardens (all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"tolerance", "grid", "increments"}));
  app.add_option("--step", options.step, "From 0: whose load; where a body hardens, the last one")
      ->capture_default_str();
  app.add_option("--rounds", options.rounds, "Turns of each point")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--nodes", options.nodes, "In x, of the sweeps over tolerance and increments (the scene's)")
      ->check(CLI::Range(2, 16384));
  app.add_option("--grids", options.grids, "Nodes in x, rising (64,128,256,512,1024)")
      ->delimiter(',')
      ->check(CLI::Range(2, 16384));
  app.add_option("--reference-grid", options.reference_grid, "Nodes in x (twice the finest)")
      ->check(CLI::Range(2, 16384));
  app.add_option("--increments", options.increments, "Of the last step (3,4,6,8,12,16,24,32,48)")
      ->delimiter(',')
      ->check(CLI::Range(1, 10000));
  CLI11_PARSE(app, argc, argv);
  const auto wanted = [&](const char* sweep) {
    return std::find(sweeps.begin(), sweeps.end(), sweep) != sweeps.end();
  };
  try {
    const cli::SceneFile scene = cli::read_scene(scene_path);
    const bool hardens = scene.lower.hardening || scene.upper.hardening;
    cli::make_output_folder(out);
    const auto write = [&](const bench::Sweep& sweep, const char* suffix) {
      bench::write(sweep, scene.title, out / (name + suffix));
    };
    if (wanted("tolerance")) {
      write(hardens ? bench::plastic_tolerances(scene, options) : bench::elastic_tolerances(scene, options),
            "_tolerance");
    }
    if (wanted("grid")) {
      const auto grids = hardens ? bench::plastic_grids(scene, options) : bench::elastic_grids(scene, options);
      if (grids) write(*grids, "_grid");
    }
    if (hardens && wanted("increments")) write(bench::plastic_increments(scene, options), "_increments");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "work_precision: %s\n", error.what());
    return 3;
  }
  return 0;
}
