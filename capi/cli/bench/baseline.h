// baseline.json of a profile: what it cost when that was last recorded, and on what.
//
//   {"recorded": {"date", "version", "compiler", "machine", "isa", "threads"},
//    "figures": {"time": {"ratio", "calibration"}, "instructions": {"count", "isa"}, ...}}
//
// A ratio is that of a time to the time of its calibration, measured in turn. Ratios are compared only on the machine
// and with the compiler and instruction set that they were recorded on, instructions with the same compiler and
// instruction set.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace brinell::cli {

struct Circumstances {
  std::string date, version, compiler, machine, isa;
  int threads = 1;

  std::string in_words() const;
};

/// Of this program on this machine, today.
Circumstances present_circumstances(const std::string& isa, int threads);

struct Baseline {
  Circumstances recorded;
  nlohmann::ordered_json figures;
};

/// None if there is no such file. Throws FileError if it is none of ours.
std::optional<Baseline> read_baseline(const std::filesystem::path& path);

/// Creates the folder too.
void write_baseline(const std::filesystem::path& path, const Baseline& baseline);

}  // namespace brinell::cli
