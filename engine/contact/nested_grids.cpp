#include "contact/nested_grids.h"

#include <algorithm>
#include <array>

namespace brinell::contact {

namespace {

constexpr std::int64_t kCoarsest = 32;  // nodes of the shorter side below which no coarser grid helps
constexpr double kWorthwhile = 0.6;     // fraction of the nodes above which a box is not worth its margin
constexpr std::int64_t kRowsPerTask = 16;

bool can_coarsen(const Grid& grid, Boundary boundary) {
  if (std::min(grid.nx, grid.ny) < 2 * kCoarsest) return false;
  return boundary == Boundary::free || (grid.nx % 2 == 0 && grid.ny % 2 == 0);  // a period holds whole cells
}

Grid coarsen(const Grid& grid) {
  return {(grid.nx + 1) / 2, (grid.ny + 1) / 2, 2 * grid.dx, 2 * grid.dy};
}

PlacedGrid coarsen(const PlacedGrid& finer) {
  return {coarsen(finer.grid), finer.x + 0.5 * finer.grid.dx, finer.y + 0.5 * finer.grid.dy};
}

}  // namespace

std::vector<CoarserGrid> coarser_grids(const PlacedGrid& placed, Boundary boundary, std::span<const double> gap,
                                       const parallel::Arena& arena) {
  std::vector<CoarserGrid> coarser;
  PlacedGrid finer = placed;
  const double* finer_gap = gap.data();
  while (can_coarsen(finer.grid, boundary)) {
    const PlacedGrid next = coarsen(finer);
    coarser.push_back({next, Buffer<double>::uninitialised(next.grid.nodes())});
    restrict_to(finer.grid, finer_gap, next.grid, coarser.back().gap.data(), arena);
    finer = next;
    finer_gap = coarser.back().gap.data();
  }
  return coarser;
}

std::size_t coarser_grids_bytes(const Grid& grid, Boundary boundary) {
  std::size_t bytes = 0;
  for (Grid finer = grid; can_coarsen(finer, boundary);) {
    finer = coarsen(finer);
    bytes += Buffer<double>::padded_bytes(finer.nodes());
  }
  return bytes;
}

Box contact_box(const Box& box, const double* p) {
  std::int64_t first_i = box.nx, last_i = -1, first_j = box.ny, last_j = -1;
  for (std::int64_t j = 0; j < box.ny; ++j) {
    const double* row = p + j * box.nx;
    const auto in_contact = [](double pressure) { return pressure > 0; };
    const std::int64_t first = std::find_if(row, row + box.nx, in_contact) - row;
    if (first == box.nx) continue;
    std::int64_t last = box.nx - 1;
    while (!in_contact(row[last])) --last;
    first_i = std::min(first_i, first);
    last_i = std::max(last_i, last);
    first_j = std::min(first_j, j);
    last_j = j;
  }
  if (last_i < 0) return {box.i0, box.j0, 0, 0};
  return {box.i0 + first_i, box.j0 + first_j, last_i - first_i + 1, last_j - first_j + 1};
}

Box candidate_box(const Box& contact, const Grid& finer, Boundary boundary) {
  if (contact.nx == 0 || boundary == Boundary::periodic) return Box::whole(finer);
  // Two coarse cells and a sixteenth of the contact on each side.
  const std::int64_t margin_x = 4 + contact.nx / 8;
  const std::int64_t margin_y = 4 + contact.ny / 8;
  const std::int64_t i0 = std::max<std::int64_t>(0, 2 * contact.i0 - margin_x);
  const std::int64_t j0 = std::max<std::int64_t>(0, 2 * contact.j0 - margin_y);
  const std::int64_t i1 = std::min(finer.nx, 2 * (contact.i0 + contact.nx) + margin_x);
  const std::int64_t j1 = std::min(finer.ny, 2 * (contact.j0 + contact.ny) + margin_y);
  const Box box{i0, j0, i1 - i0, j1 - j0};
  const double part = static_cast<double>(box.nx * box.ny) / static_cast<double>(finer.nodes());
  return part > kWorthwhile ? Box::whole(finer) : box;
}

Buffer<double> gather(const Grid& grid, const Box& box, const double* field) {
  auto part = Buffer<double>::uninitialised(static_cast<std::size_t>(box.nx * box.ny));
  for (std::int64_t j = 0; j < box.ny; ++j) {
    std::copy_n(field + (box.j0 + j) * grid.nx + box.i0, box.nx, part.data() + j * box.nx);
  }
  return part;
}

void prolong_pressure(const Box& coarse_box, const double* coarse, const Box& fine_box, double* fine,
                      const parallel::Arena& arena) {
  arena.for_chunks(fine_box.ny, kRowsPerTask, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      const std::int64_t cj = (fine_box.j0 + j) / 2 - coarse_box.j0;
      double* row = fine + j * fine_box.nx;
      if (cj < 0 || cj >= coarse_box.ny) {
        std::fill_n(row, fine_box.nx, 0.0);
        continue;
      }
      for (std::int64_t i = 0; i < fine_box.nx; ++i) {
        const std::int64_t ci = (fine_box.i0 + i) / 2 - coarse_box.i0;
        row[i] = ci >= 0 && ci < coarse_box.nx ? coarse[cj * coarse_box.nx + ci] : 0.0;
      }
    }
  });
}

void prolong_displacement(const Box& coarse_box, const double* coarse_g, const UndeformedGap& coarse_gap,
                          const Box& fine_box, double* fine, const parallel::Arena& arena) {
  // A fine node lies a quarter of a coarse cell from its cell's centre: weights 3/4 and 1/4.
  const auto neighbours = [](std::int64_t fine_index, std::int64_t first, std::int64_t count) {
    const std::int64_t near = fine_index / 2 - first;
    const std::int64_t far = fine_index % 2 == 0 ? near - 1 : near + 1;
    return std::array{std::clamp<std::int64_t>(near, 0, count - 1), std::clamp<std::int64_t>(far, 0, count - 1)};
  };
  arena.for_chunks(fine_box.ny, kRowsPerTask, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      const auto rows = neighbours(fine_box.j0 + j, coarse_box.j0, coarse_box.ny);
      const auto at = [&](std::int64_t row, std::int64_t column) {
        const std::int64_t n = row * coarse_box.nx + column;
        return coarse_g[n] - coarse_gap.scale * (coarse_gap.values[n] - coarse_gap.origin);
      };
      for (std::int64_t i = 0; i < fine_box.nx; ++i) {
        const auto columns = neighbours(fine_box.i0 + i, coarse_box.i0, coarse_box.nx);
        const double near = 0.75 * at(rows[0], columns[0]) + 0.25 * at(rows[0], columns[1]);
        const double far = 0.75 * at(rows[1], columns[0]) + 0.25 * at(rows[1], columns[1]);
        fine[j * fine_box.nx + i] = 0.75 * near + 0.25 * far;
      }
    }
  });
}

void restrict_to(const Grid& fine_grid, const double* fine, const Grid& coarse_grid, double* coarse,
                 const parallel::Arena& arena) {
  arena.for_chunks(coarse_grid.ny, kRowsPerTask, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      const double* first = fine + 2 * j * fine_grid.nx;
      const double* second = 2 * j + 1 < fine_grid.ny ? first + fine_grid.nx : first;
      for (std::int64_t i = 0; i < coarse_grid.nx; ++i) {
        const std::int64_t left = 2 * i;
        const std::int64_t right = std::min(left + 1, fine_grid.nx - 1);
        coarse[j * coarse_grid.nx + i] = 0.25 * ((first[left] + first[right]) + (second[left] + second[right]));
      }
    }
  });
}

}  // namespace brinell::contact
