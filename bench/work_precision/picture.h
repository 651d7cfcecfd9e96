// A sweep as a table (CSV) and as a picture (SVG, PNG): a curve for each method and quantity, the front of what is
// best for each time behind them.
#pragma once

#include <filesystem>
#include <string>

#include "work_precision/sweep.h"

namespace brinell::bench {

/// stem.csv, stem.svg and stem.png.
void write(const Sweep& sweep, const std::string& title, const std::filesystem::path& stem);

}  // namespace brinell::bench
