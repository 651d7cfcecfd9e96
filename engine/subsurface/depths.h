// Depths of the layers of a body [m], z = 0 at its surface and into it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace brinell::subsurface {

/// Mid-depths (k + 1/2)·thickness of equal layers of cuboids, k = 0 … layers − 1.
/// Throws Status::invalid_argument unless layers >= 1 and thickness is positive and finite.
std::vector<double> layer_depths(std::int64_t layers, double thickness);

/// Throws Status::invalid_argument, naming the entry, unless there is at least one depth, none is negative or not
/// finite, and each is greater than the one before.
void check_depths(std::span<const double> depths);

}  // namespace brinell::subsurface
