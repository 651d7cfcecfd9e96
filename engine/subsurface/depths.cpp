#include "subsurface/depths.h"

#include <cmath>
#include <string>

#include "base/error.h"

namespace brinell::subsurface {

std::vector<double> layer_depths(std::int64_t layers, double thickness) {
  if (layers < 1) fail(Status::invalid_argument, "layers = " + std::to_string(layers) + ": must be at least 1");
  if (!(thickness > 0) || !std::isfinite(thickness)) {
    fail(Status::invalid_argument, "layer_thickness = " + text(thickness) + ": must be positive and finite");
  }
  std::vector<double> depths(static_cast<std::size_t>(layers));
  for (std::int64_t k = 0; k < layers; ++k) {
    depths[static_cast<std::size_t>(k)] = (static_cast<double>(k) + 0.5) * thickness;
  }
  return depths;
}

void check_depths(std::span<const double> depths) {
  if (depths.empty()) fail(Status::invalid_argument, "depths: at least one is needed, not 0");
  for (std::size_t k = 0; k < depths.size(); ++k) {
    const std::string entry = "depths[" + std::to_string(k) + "] = " + text(depths[k]);
    if (!(depths[k] >= 0) || !std::isfinite(depths[k])) {
      fail(Status::invalid_argument, entry + ": must be zero (the surface) or positive, and finite");
    }
    if (k > 0 && !(depths[k] > depths[k - 1])) {
      fail(Status::invalid_argument, entry + ": must be greater than the depth before it, " + text(depths[k - 1]));
    }
  }
}

}  // namespace brinell::subsurface
