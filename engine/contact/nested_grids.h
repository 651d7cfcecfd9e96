// The grids that a contact is solved on, coarse to fine, and the passage of pressure from one to the next.
//
// Each coarser grid has cells of 2 × 2 nodes, whose gap is the mean of theirs. Its solution tells which nodes of the
// next grid can be in contact: where that is a small box, the next grid is solved on that box alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "base/grid.h"
#include "contact/problem.h"
#include "parallel/arena.h"

namespace brinell::contact {

/// Part of a grid: nodes i0 <= i < i0 + nx, j0 <= j < j0 + ny.
struct Box {
  std::int64_t i0 = 0, j0 = 0, nx = 0, ny = 0;

  static Box whole(const Grid& grid) { return {0, 0, grid.nx, grid.ny}; }

  /// This part of a grid, in its place.
  PlacedGrid of(const PlacedGrid& all) const {
    return {{nx, ny, all.grid.dx, all.grid.dy},
            all.x + static_cast<double>(i0) * all.grid.dx,
            all.y + static_cast<double>(j0) * all.grid.dy};
  }
  friend bool operator==(const Box&, const Box&) = default;
};

/// The coarser grids of one, finest first; the finest itself is not among them. Lengths keep their unit.
struct CoarserGrid {
  PlacedGrid placed;
  Buffer<double> gap;
};
std::vector<CoarserGrid> coarser_grids(const PlacedGrid& placed, Boundary boundary, std::span<const double> gap,
                                       const parallel::Arena& arena);

/// Bytes that coarser_grids returns.
std::size_t coarser_grids_bytes(const Grid& grid, Boundary boundary);

/// The smallest box around all nodes of `box` in contact (p > 0), empty if there are none.
Box contact_box(const Box& box, const double* p);

/// The box of the finer grid that can be in contact if `contact` is in contact on the coarser one; the whole grid
/// if a part would not save enough.
Box candidate_box(const Box& contact, const Grid& finer, Boundary boundary);

/// Copies the box out of a field of the whole grid.
Buffer<double> gather(const Grid& grid, const Box& box, const double* field);

/// Piecewise constant continuation of a pressure to the next finer grid.
void prolong_pressure(const Box& coarse_box, const double* coarse, const Box& fine_box, double* fine,
                      const parallel::Arena& arena);

/// Bilinear continuation of the displacement coarse_g − coarse_gap.
void prolong_displacement(const Box& coarse_box, const double* coarse_g, const UndeformedGap& coarse_gap,
                          const Box& fine_box, double* fine, const parallel::Arena& arena);

/// Mean over the nodes of each cell of the next coarser grid.
void restrict_to(const Grid& fine_grid, const double* fine, const Grid& coarse_grid, double* coarse,
                 const parallel::Arena& arena);

}  // namespace brinell::contact
