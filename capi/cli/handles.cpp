#include "handles.h"

namespace brinell::cli {

Engine make_engine(int threads) {
  brn_engine_options options;
  brn_engine_options_init(&options);
  options.threads = threads;
  brn_engine* engine = nullptr;
  check(brn_engine_create(&options, &engine));
  return Engine(engine);
}

Run make_run(brn_engine* engine, const brn_scene* scene) {
  brn_run* run = nullptr;
  check(brn_run_create(engine, scene, &run));
  return Run(run);
}

Run load_run(brn_engine* engine, const brn_scene* scene, const std::string& state) {
  brn_run* run = nullptr;
  check(brn_run_load(engine, scene, state.data(), state.size(), &run));
  return Run(run);
}

std::string save_run(brn_run* run) {
  std::size_t size = 0;
  check(brn_run_save(run, nullptr, 0, &size), run);
  std::string state(size, '\0');
  check(brn_run_save(run, state.data(), state.size(), &size), run);
  return state;
}

brn_increment increment_of(brn_run* run, int index) {
  brn_increment increment;
  brn_increment_init(&increment);
  check(brn_run_get_increment(run, index, &increment), run);
  return increment;
}

std::vector<double> depths_of(brn_run* run) {
  std::size_t count = 0;
  check(brn_run_get_depths(run, nullptr, 0, &count), run);
  std::vector<double> depths(count);
  check(brn_run_get_depths(run, depths.data(), depths.size(), &count), run);
  return depths;
}

}  // namespace brinell::cli
