// Fields of symmetric tensors as six arrays, in the order xx yy zz yz xz xy.
#pragma once

#include <array>

namespace brinell::plastic {

using TensorView = std::array<const double*, 6>;
using TensorArrays = std::array<double*, 6>;

}  // namespace brinell::plastic
