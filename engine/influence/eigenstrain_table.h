// Potentials of a cuboid near it (influence/eigenstrain.h), kept for boxes that grow: the closed forms are what takes
// longest of their coefficients, and depend on offsets alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/buffer.h"
#include "influence/eigenstrain.h"
#include "parallel/arena.h"

namespace brinell::influence {

class EigenstrainTable {
 public:
  explicit EigenstrainTable(const Eigenstrain& cuboid) : cuboid_(cuboid) {}

  /// Makes what a box of nx × ny × nz cuboids needs and was not made before.
  void cover(const parallel::Arena& arena, std::int64_t nx, std::int64_t ny, std::int64_t nz);

  /// As those of Eigenstrain, at so many layers from the cuboid, from its image.
  void fill_kelvin(const simd::EigenstrainKernels& kernels, std::int64_t layer, std::int64_t nx, std::int64_t ny,
                   double* potentials) const;
  void fill_image(const simd::EigenstrainKernels& kernels, std::int64_t layer, std::int64_t nx, std::int64_t ny,
                  double* potentials) const;

  const Eigenstrain& cuboid() const { return cuboid_; }

  /// What boxes up to this one make it keep, and use meanwhile.
  struct Bytes {
    std::size_t kept = 0, work = 0;
  };
  static Bytes bytes(const Eigenstrain& cuboid, int threads, std::int64_t nx, std::int64_t ny, std::int64_t nz);

 private:
  struct Layer {
    Eigenstrain::Extent extent;
    Buffer<double> values;
  };
  using Layers = std::vector<Layer>;
  void cover(const parallel::Arena& arena, Eigenstrain::Potentials which, std::int64_t first, std::int64_t end,
             const Eigenstrain::Extent& box, Layers& layers);

  Eigenstrain cuboid_;
  Layers kelvin_, image_;  // by layer
};

}  // namespace brinell::influence
