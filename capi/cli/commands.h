// The subcommands. Each returns the exit status of a result, and throws for everything that prevents one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace brinell::cli {

constexpr int kSolved = 0;
constexpr int kNotConverged = 1;
constexpr int kTooSlow = 1;  ///< of bench
constexpr int kBadScene = 2;
constexpr int kFileTrouble = 3;
constexpr int kInterrupted = 130;

struct RunOptions {
  std::filesystem::path scene;  ///< run: the scene
  std::filesystem::path out;    ///< folder of the run; empty: out/ and the scene's name
  std::optional<int> threads;   ///< instead of the scene's
  bool json = false;            ///< print summary.json
  bool quiet = false;           ///< print nothing but what --json asks for
};

struct BenchOptions {
  std::vector<std::filesystem::path> scenes;  ///< or "kernels"; empty: kernels and profiles/
  std::filesystem::path baselines;            ///< folder of folders with baseline.json; empty: beside each scene
  int rounds = 10;                            ///< 0: nothing is timed
  int threads = 1;
  double allowed = 1.15;  ///< time / baseline
  double allowed_instructions = 1.03;
  bool instructions = true;  ///< count those of small scenes
  bool update = false;       ///< write the baselines anew
  bool json = false;
  bool once = false;  ///< solve the scenes once and print the instruction set: what is counted
};

int run_command(const RunOptions& options);
int resume_command(const RunOptions& options);
int plan_command(const std::filesystem::path& scene, bool json);
int check_command(const std::filesystem::path& scene);
int report_command(const std::filesystem::path& folder);
int bench_command(const BenchOptions& options);
int info_command(const std::vector<std::filesystem::path>& surfaces, bool json);

/// "afm_contact" for profiles/afm_contact, profiles/afm_contact/scene.toml and afm_contact.toml.
std::string scene_name(const std::filesystem::path& scene);

}  // namespace brinell::cli
