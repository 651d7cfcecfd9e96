// bench: solves scenes several times without writing anything, and prints the median time of each beside its error.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "errors.h"
#include "scene_builder.h"

namespace brinell::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Candidate {
  std::string name;
  Scene scene;
  std::vector<double> seconds;
  int increments = 0;
  int iterations = 0;
  double certificate = 0;
};

/// Scenes in profiles/, in the order of their names.
std::vector<std::filesystem::path> known_profiles() {
  std::vector<std::filesystem::path> scenes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("profiles", error)) {
    if (std::filesystem::exists(entry.path() / "scene.toml")) scenes.push_back(entry.path());
  }
  if (scenes.empty()) throw FileError("there is no folder profiles/ with scenes here; name the scenes to time");
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

void solve_once(brn_engine* engine, Candidate& candidate) {
  const auto start = std::chrono::steady_clock::now();
  const Run run = make_run(engine, candidate.scene.get());
  check(brn_run_execute(run.get(), nullptr, nullptr), run.get());
  candidate.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  candidate.increments = brn_run_solved_increments(run.get());
  candidate.iterations = 0;
  candidate.certificate = 0;
  for (int k = 0; k < candidate.increments; ++k) {
    const brn_increment increment = increment_of(run.get(), k);
    candidate.iterations += increment.iterations;
    candidate.certificate = std::max({candidate.certificate, increment.penetration, increment.complementarity,
                                      increment.tension, increment.balance});
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

int bench_command(const std::vector<std::filesystem::path>& scenes, int rounds, int threads, bool json) {
  std::vector<Candidate> candidates;
  for (const auto& path : scenes.empty() ? known_profiles() : scenes) {
    candidates.push_back({scene_name(path), build_scene(read_scene(path)).scene, {}});
  }
  const Engine engine = make_engine(threads);
  // Rounds are interleaved, so that a disturbance of the machine meets all scenes alike.
  for (int round = 0; round < rounds; ++round) {
    for (auto& candidate : candidates) solve_once(engine.get(), candidate);
  }
  Json list = Json::array();
  for (const auto& candidate : candidates) {
    list.push_back({{"name", candidate.name},
                    {"increments", candidate.increments},
                    {"iterations", candidate.iterations},
                    {"certificate", candidate.certificate},
                    {"median_seconds", median(candidate.seconds)},
                    {"least_seconds", *std::min_element(candidate.seconds.begin(), candidate.seconds.end())},
                    {"rounds", rounds}});
  }
  if (json) {
    std::cout << Json{{"isa", brn_engine_isa_name(engine.get())},
                      {"threads", brn_engine_threads(engine.get())},
                      {"scenes", list}}
                     .dump(2)
              << "\n";
    return kSolved;
  }
  std::cout << "median [s]  least [s]   iterations  certificate  scene\n";
  for (const auto& row : list) {
    std::array<char, 120> line{};
    std::snprintf(line.data(), line.size(), "%-10.4g  %-10.4g  %10d  %-11.1e  ", row["median_seconds"].get<double>(),
                  row["least_seconds"].get<double>(), row["iterations"].get<int>(), row["certificate"].get<double>());
    std::cout << line.data() << row["name"].get<std::string>() << "\n";
  }
  return kSolved;
}

}  // namespace brinell::cli
