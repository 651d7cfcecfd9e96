// What a box of cuboids and its fields must be.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "plastic/eigenstrain_response.h"

namespace brinell::plastic {

inline constexpr std::int64_t kLargestSide = std::int64_t{1} << 20;  // cuboids
inline constexpr double kMostCuboids = 1e11;                         // spectra stay far from overflow

inline void check_box(const Box& box) {
  const auto size = [&] {
    return std::to_string(box.nx) + " x " + std::to_string(box.ny) + " x " + std::to_string(box.nz) + " cuboids";
  };
  for (const std::int64_t side : {box.nx, box.ny, box.nz}) {
    if (side < 1 || side > kLargestSide) {
      fail(Status::invalid_argument,
           "a box of " + size() + ": each side must be within 1 .. " + std::to_string(kLargestSide));
    }
  }
  if (static_cast<double>(box.nx) * static_cast<double>(box.ny) * static_cast<double>(box.nz) > kMostCuboids) {
    fail(Status::too_large, "a box of " + size() + ": at most " + text(kMostCuboids) + " are possible");
  }
  for (const auto& [name, side] : {std::pair{"dx", box.dx}, std::pair{"dy", box.dy}, std::pair{"dz", box.dz}}) {
    if (!(side > 0) || !std::isfinite(side)) {
      fail(Status::invalid_argument,
           std::string(name) + " = " + text(side) + ": the side of a cuboid must be positive");
    }
  }
}

template <class Fields>
void check_tensor(const Fields& fields, const char* name) {
  for (std::size_t c = 0; c < fields.size(); ++c) {
    if (fields[c] == nullptr) {
      fail(Status::invalid_argument, std::string(name) + ": component " + std::to_string(c) +
                                         " of xx yy zz yz xz xy is null; all six fields are needed");
    }
  }
}

}  // namespace brinell::plastic
