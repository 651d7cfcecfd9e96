// Replaces missing heights by a smooth patch.
#pragma once

#include <cstdint>
#include <vector>

namespace brinell::cli {

/// Each missing height (NaN) becomes the mean of its neighbours, all at once: the discrete Laplace equation with the
/// valid heights as its boundary values. Infinite heights stay. Returns false if there is no valid height.
bool fill_missing(std::int64_t nx, std::int64_t ny, std::vector<double>& heights);

}  // namespace brinell::cli
