// summary.json and trace.csv of a run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "handles.h"
#include "scene_file.h"

namespace brinell::cli {

/// The contract's summary, as ordered as it is written. NaN becomes null. `wall_seconds` is that of the whole run.
nlohmann::ordered_json summary_json(const SceneFile& file, const brn_engine* engine, brn_run* run, bool interrupted,
                                    double wall_seconds);

/// What `plan` prints: stages, items with their bytes, and their sum.
nlohmann::ordered_json plan_json(const SceneFile& file, const brn_grid& grid, brn_run* run);

/// Certificate against time, one line for each point.
std::string trace_csv(brn_run* run);

/// One line for each solved increment, for a person.
std::string summary_table(brn_run* run);

/// Stages and bytes of the plan, for a person.
std::string plan_table(const SceneFile& file, const brn_grid& grid, brn_run* run);

}  // namespace brinell::cli
