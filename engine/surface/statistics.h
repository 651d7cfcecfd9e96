// Height statistics of ISO 25178-2 over the nodes, about the mean height after detrending:
//   Sa = mean |z|        Sq² = mean z²        Ssk = mean z³ / Sq³        Sku = mean z⁴ / Sq⁴
//   Sp = max z           Sv = −min z          Sz = Sp + Sv
//   Sdq² = mean (dz/dx)² + mean (dz/dy)², with first differences between neighbouring nodes, each direction averaged
//   over all its pairs of neighbours; a periodic surface has a pair across its border as well. Sdq of a plane is
//   exact; of a wave of wavelength w along x it is low by the factor sin(pi·dx/w) / (pi·dx/w).
// The number of threads does not change a bit.
#pragma once

#include "base/grid.h"
#include "parallel/arena.h"
#include "surface/height_map.h"

namespace brinell::surface {

struct HeightStatistics {
  double sa = 0;   // [m]
  double sq = 0;   // [m]
  double ssk = 0;  // 0 for a flat surface, where it is undefined
  double sku = 0;  // 3 for Gaussian heights; 0 for a flat surface, where it is undefined
  double sp = 0;   // [m] highest peak, >= 0
  double sv = 0;   // [m] deepest valley, >= 0
  double sz = 0;   // [m]
  double sdq = 0;  // root mean square slope
};

/// dx, dy [m]: spacing of the map's nodes. A direction with one node contributes no slope.
HeightStatistics height_statistics(const HeightMap& map, double dx, double dy, Detrend detrend, Boundary boundary,
                                   const parallel::Arena& arena);

}  // namespace brinell::surface
