// Drives a run to its end, to an interruption or to a failure, and writes what there is to its folder.
#pragma once

#include "commands.h"
#include "run_folder.h"
#include "scene_builder.h"

namespace brinell::cli {

struct RunParts {
  const SceneFile& file;
  const brn_grid& grid;
  const brn_engine* engine;
  brn_run* run;
  const RunFolder& folder;
  bool resumed;
};

/// Returns the exit status. Throws FileError if results cannot be written, EngineError if the engine fails otherwise
/// than by not converging; what was solved before is written first.
int solve(const RunParts& parts, const RunOptions& options);

}  // namespace brinell::cli
