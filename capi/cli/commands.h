// The subcommands. Each returns the exit status of a result, and throws for everything that prevents one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace brinell::cli {

constexpr int kSolved = 0;
constexpr int kNotConverged = 1;
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

int run_command(const RunOptions& options);
int resume_command(const RunOptions& options);
int plan_command(const std::filesystem::path& scene, bool json);
int check_command(const std::filesystem::path& scene);
int report_command(const std::filesystem::path& folder);
int bench_command(const std::vector<std::filesystem::path>& scenes, int rounds, int threads, bool json);
int info_command(const std::vector<std::filesystem::path>& surfaces, bool json);

/// "afm_contact" for profiles/afm_contact, profiles/afm_contact/scene.toml and afm_contact.toml.
std::string scene_name(const std::filesystem::path& scene);

}  // namespace brinell::cli
