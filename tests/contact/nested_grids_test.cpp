#include "contact/nested_grids.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/workbench.h"

namespace brinell::contact {
namespace {

TEST(NestedGrids, halve_down_to_the_coarsest_and_keep_means) {
  const parallel::Arena arena(1);
  const Grid grid{200, 136, 1, 2};
  const std::vector<double> gap = support::random_gap(grid, 1, 1);
  const auto coarser = coarser_grids(PlacedGrid::centred(grid), Boundary::free, gap, arena);
  ASSERT_EQ(coarser.size(), 2U);
  EXPECT_EQ(coarser[0].placed.grid, (Grid{100, 68, 2, 4}));
  EXPECT_EQ(coarser[1].placed.grid, (Grid{50, 34, 4, 8}));
  EXPECT_EQ(coarser[0].gap[3 * 100 + 5],
            0.25 * ((gap[6 * 200 + 10] + gap[6 * 200 + 11]) + (gap[7 * 200 + 10] + gap[7 * 200 + 11])));
  EXPECT_EQ(coarser_grids_bytes(grid, Boundary::free), coarser[0].gap.bytes() + coarser[1].gap.bytes());
}

TEST(NestedGrids, of_odd_sizes_exist_on_free_boundaries_only) {
  const parallel::Arena arena(1);
  const Grid grid{129, 64, 1, 1};
  const std::vector<double> gap = support::random_gap(grid, 1, 1);
  EXPECT_TRUE(coarser_grids(PlacedGrid::centred(grid), Boundary::periodic, gap, arena).empty());
  const auto coarser = coarser_grids(PlacedGrid::centred(grid), Boundary::free, gap, arena);
  ASSERT_EQ(coarser.size(), 1U);
  EXPECT_EQ(coarser[0].placed.grid.nx, 65);
  EXPECT_EQ(coarser[0].gap[64],
            0.25 * ((gap[128] + gap[128]) + (gap[257] + gap[257])));  // the last column stands alone
  EXPECT_TRUE(coarser_grids(PlacedGrid::centred({63, 1000, 1, 1}), Boundary::free, std::vector<double>(63000), arena)
                  .empty());
}

TEST(ContactBox, is_the_smallest_around_all_contact) {
  const Box box{10, 20, 7, 5};
  std::vector<double> p(35, 0.0);
  EXPECT_EQ(contact_box(box, p.data()).nx, 0);
  p[1 * 7 + 6] = 1;
  EXPECT_EQ(contact_box(box, p.data()), (Box{16, 21, 1, 1}));
  p[3 * 7 + 2] = 1e-300;
  EXPECT_EQ(contact_box(box, p.data()), (Box{12, 21, 5, 3}));
}

TEST(CandidateBox, surrounds_the_contact_and_stays_on_the_grid) {
  const Grid finer{200, 300, 1, 1};
  for (const Box& contact : {Box{0, 0, 3, 4}, Box{90, 140, 10, 10}, Box{40, 70, 5, 60}, Box{50, 50, 1, 1}}) {
    const Box box = candidate_box(contact, finer, Boundary::free);
    EXPECT_GE(box.i0, 0);
    EXPECT_GE(box.j0, 0);
    EXPECT_LE(box.i0 + box.nx, finer.nx);
    EXPECT_LE(box.j0 + box.ny, finer.ny);
    EXPECT_LE(box.i0, 2 * contact.i0);
    EXPECT_LE(box.j0, 2 * contact.j0);
    EXPECT_GE(box.i0 + box.nx, std::min(finer.nx, 2 * (contact.i0 + contact.nx)));
    EXPECT_GE(box.j0 + box.ny, std::min(finer.ny, 2 * (contact.j0 + contact.ny)));
  }
  EXPECT_EQ(candidate_box({5, 5, 90, 120}, finer, Boundary::free), Box::whole(finer));
  EXPECT_EQ(candidate_box({0, 0, 0, 0}, finer, Boundary::free), Box::whole(finer));
  EXPECT_EQ(candidate_box({5, 5, 2, 2}, finer, Boundary::periodic), Box::whole(finer));
}

TEST(NestedGrids, pressure_goes_to_the_finer_grid_unchanged) {
  const parallel::Arena arena(1);
  const Box coarse{3, 4, 6, 5}, fine{4, 9, 15, 8};
  std::vector<double> p(30), finer(15 * 8, -1);
  for (std::size_t n = 0; n < p.size(); ++n) p[n] = 1 + static_cast<double>(n);
  prolong_pressure(coarse, p.data(), fine, finer.data(), arena);
  for (std::int64_t j = 0; j < fine.ny; ++j) {
    for (std::int64_t i = 0; i < fine.nx; ++i) {
      const std::int64_t ci = (fine.i0 + i) / 2 - coarse.i0, cj = (fine.j0 + j) / 2 - coarse.j0;
      const bool inside = ci >= 0 && ci < coarse.nx && cj >= 0 && cj < coarse.ny;
      EXPECT_EQ(finer[j * 15 + i], inside ? p[cj * 6 + ci] : 0);
    }
  }
}

// Bilinear: exact for linear displacements wherever both neighbours exist.
TEST(NestedGrids, displacement_goes_to_the_finer_grid_bilinearly) {
  const parallel::Arena arena(1);
  const Box coarse{2, 3, 9, 8}, fine{6, 8, 12, 10};
  const double scale = 0.5, origin = 3;
  const std::vector<double> gap = support::random_gap({9, 8, 1, 1}, 1, 1);
  std::vector<double> g(72), finer(120);
  for (std::int64_t j = 0; j < 8; ++j) {
    for (std::int64_t i = 0; i < 9; ++i) {
      const double u =
          2 * (static_cast<double>(coarse.i0 + i) + 0.5) + 10 * (static_cast<double>(coarse.j0 + j) + 0.5);
      g[j * 9 + i] = u + scale * (gap[j * 9 + i] - origin);
    }
  }
  prolong_displacement(coarse, g.data(), {gap.data(), scale, origin}, fine, finer.data(), arena);
  for (std::int64_t j = 0; j < fine.ny; ++j) {
    for (std::int64_t i = 0; i < fine.nx; ++i) {
      const double u = (static_cast<double>(fine.i0 + i) + 0.5) + 5 * (static_cast<double>(fine.j0 + j) + 0.5);
      EXPECT_NEAR(finer[j * 12 + i], u, 1e-13);  // some roundings of numbers around 100
    }
  }
}

TEST(NestedGrids, gather_copies_the_box) {
  const Grid grid{7, 5, 1, 1};
  std::vector<double> field(35);
  for (std::size_t n = 0; n < field.size(); ++n) field[n] = static_cast<double>(n);
  const Buffer<double> part = gather(grid, {2, 1, 3, 2}, field.data());
  EXPECT_EQ(std::vector<double>(part.begin(), part.end()), (std::vector<double>{9, 10, 11, 16, 17, 18}));
}

}  // namespace
}  // namespace brinell::contact
