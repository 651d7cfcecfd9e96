// run, resume, plan and check: from a scene file to an engine's run.
#include <iostream>

#include "commands.h"
#include "errors.h"
#include "formats/formats.h"
#include "interrupt.h"
#include "output/summary.h"
#include "run_folder.h"
#include "scene_builder.h"
#include "solve.h"

namespace brinell::cli {

std::string scene_name(const std::filesystem::path& scene) {
  const auto path = std::filesystem::absolute(scene_path(scene)).lexically_normal();
  return path.filename() == "scene.toml" ? path.parent_path().filename().string() : path.stem().string();
}

int run_command(const RunOptions& options) {
  const SceneFile file = read_scene(options.scene);
  const BuiltScene built = build_scene(file);
  const Engine engine = make_engine(options.threads.value_or(file.solver.threads));
  const Run run = make_run(engine.get(), built.scene.get());
  const RunFolder folder(options.out.empty() ? std::filesystem::path("out") / scene_name(options.scene)
                                             : options.out);
  folder.begin(file);
  catch_interrupts();
  return solve({file, built.grid, engine.get(), run.get(), folder, false}, options);
}

int resume_command(const RunOptions& options) {
  const RunFolder folder(options.out);
  const SceneFile file = folder.read_scene();
  const std::string state = read_bytes(folder.checkpoint());
  const BuiltScene built = build_scene(file);
  const Engine engine = make_engine(options.threads.value_or(file.solver.threads));
  const Run run = load_run(engine.get(), built.scene.get(), state);
  catch_interrupts();
  return solve({file, built.grid, engine.get(), run.get(), folder, true}, options);
}

int plan_command(const std::filesystem::path& scene, bool json) {
  const SceneFile file = read_scene(scene);
  const BuiltScene built = build_scene(file);
  const Engine engine = make_engine(file.solver.threads);
  const Run run = make_run(engine.get(), built.scene.get());
  if (json) {
    std::cout << plan_json(file, built.grid, run.get()).dump(2) << "\n";
  } else {
    std::cout << plan_table(file, built.grid, run.get());
  }
  return kSolved;
}

int check_command(const std::filesystem::path& scene) {
  const SceneFile file = read_scene(scene);
  const BuiltScene built = build_scene(file);
  const Engine engine = make_engine(file.solver.threads);
  const Run run = make_run(engine.get(), built.scene.get());
  std::cout << file.path.string() << ": valid, " << built.grid.nx << " x " << built.grid.ny << " nodes, "
            << brn_run_total_increments(run.get()) << " increments\n";
  return kSolved;
}

}  // namespace brinell::cli
