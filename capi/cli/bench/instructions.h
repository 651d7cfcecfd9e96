// Instructions that one solve of a scene takes, counted by valgrind's callgrind: unlike a time, they repeat.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace brinell::cli {

struct InstructionCount {
  std::int64_t count;
  std::string isa;  // the best that valgrind knows
};

/// Of this program solving the scene once on one thread, reading included. None if valgrind is not installed.
/// Throws FileError if it fails.
std::optional<InstructionCount> count_instructions(const std::filesystem::path& scene);

}  // namespace brinell::cli
