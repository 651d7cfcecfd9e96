// The folder of one run: what `run` writes and `resume` finds.
//
//   scene.toml  a copy of the scene      run.json      where the scene came from: paths inside it are relative to
//   that fields.h5   fields.xdmf              trace.csv     checkpoint.bin  the engine's saved run summary.json
//   written last, so that its presence says that the others are whole
#pragma once

#include <filesystem>
#include <string>

#include "scene_file.h"

namespace brinell::cli {

class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path trace() const { return path_ / "trace.csv"; }
  std::filesystem::path fields() const { return path_ / "fields.h5"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.bin"; }

  /// Creates the folder, removes the results of an earlier run and copies the scene. Throws FileError; in particular
  /// it refuses a folder that holds a scene, or files of the results' names, which no run has put there.
  void begin(const SceneFile& scene) const;

  /// The scene that `begin` copied. Throws FileError if the folder is none of a run.
  SceneFile read_scene() const;

  /// Seconds that earlier parts of the run have taken; 0 if unknown.
  double earlier_seconds() const;

 private:
  std::filesystem::path origin() const { return path_ / "run.json"; }
  std::filesystem::path scene() const { return path_ / "scene.toml"; }

  std::filesystem::path path_;
};

}  // namespace brinell::cli
