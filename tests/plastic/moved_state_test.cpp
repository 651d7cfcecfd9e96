#include "plastic/moved_state.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace brinell::plastic {
namespace {

const Grid kGrid{20, 16, 1e-6, 2e-6};

/// A box of 5 x 4 x 3 cuboids from node (6, 7), strained in the middle of its rows and columns alone.
PlasticBody::State strained() {
  PlasticBody::State state;
  state.region = {6, 7, {5, 4, 3, 1e-6, 2e-6, 3e-6}};
  const std::size_t stride = PlasticBody::stride_of(state.region.box);
  state.strain = Buffer<double>(6 * stride);
  state.increment = Buffer<double>(6 * stride);
  state.stress = Buffer<double>(6 * stride);
  state.equivalent = Buffer<double>(stride);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 1; j < 3; ++j) {
      for (std::size_t i = 1; i < 4; ++i) {
        const std::size_t n = (k * 4 + j) * 5 + i;
        state.equivalent[n] = 1.0 + static_cast<double>(n);
        for (std::size_t c = 0; c < 6; ++c) {
          state.strain[c * stride + n] = 1e3 * static_cast<double>(c) + static_cast<double>(n);
          state.increment[c * stride + n] = -state.strain[c * stride + n];
          state.stress[c * stride + n] = 2 * state.strain[c * stride + n];
        }
      }
    }
  }
  return state;
}

double value(const Buffer<double>& field, const PlasticBody::State& state, std::size_t component, std::int64_t i,
             std::int64_t j, std::int64_t k) {
  const Box& box = state.region.box;
  const std::int64_t x = i - state.region.i0, y = j - state.region.j0;
  if (x < 0 || y < 0 || x >= box.nx || y >= box.ny) return 0;
  return field[component * PlasticBody::stride_of(box) + static_cast<std::size_t>((k * box.ny + y) * box.nx + x)];
}

TEST(MovedState, holds_the_same_strain_at_other_nodes) {
  const PlasticBody::State before = strained();
  // Within the grid; and so far to each side that the box's outermost cuboids, which are not strained, are cut off.
  for (const auto& [by_x, by_y] : {std::pair{0, 0}, std::pair{3, -2}, std::pair{-7, 0}, std::pair{10, 6}}) {
    const PlasticBody::State after = moved(before, by_x, by_y, kGrid);
    const Region& region = after.region;
    EXPECT_GE(region.i0, 0);
    EXPECT_LE(region.i0 + region.box.nx, kGrid.nx);
    EXPECT_LE(region.j0 + region.box.ny, kGrid.ny);
    EXPECT_EQ(region.box.nz, 3);
    EXPECT_EQ(region.box.nx, by_x == -7 || by_x == 10 ? 4 : 5);
    for (std::int64_t k = 0; k < 3; ++k) {
      for (std::int64_t j = 0; j < kGrid.ny; ++j) {
        for (std::int64_t i = 0; i < kGrid.nx; ++i) {
          ASSERT_EQ(value(after.equivalent, after, 0, i, j, k),
                    value(before.equivalent, before, 0, i - by_x, j - by_y, k));
          for (std::size_t c = 0; c < 6; ++c) {
            ASSERT_EQ(value(after.strain, after, c, i, j, k), value(before.strain, before, c, i - by_x, j - by_y, k));
            ASSERT_EQ(value(after.increment, after, c, i, j, k),
                      value(before.increment, before, c, i - by_x, j - by_y, k));
            ASSERT_EQ(value(after.stress, after, c, i, j, k), value(before.stress, before, c, i - by_x, j - by_y, k));
          }
        }
      }
    }
  }
}

TEST(MovedState, nothing_moves_without_a_box) {
  EXPECT_TRUE(moved({}, 5, 1000, kGrid).region.empty());
  PlasticBody::State elastic = strained();
  std::fill(elastic.equivalent.begin(), elastic.equivalent.end(), 0.0);
  EXPECT_TRUE(moved(elastic, 1000, 0, kGrid).region.empty()) << "wholly off the grid, and no loss";
}

TEST(MovedState, keeps_plastic_strain_on_the_grid) {
  for (const auto& [by_x, by_y] :
       {std::pair{-8, 0}, std::pair{11, 0}, std::pair{0, -9}, std::pair{0, 7}, std::pair{1000000, 0}}) {
    try {
      moved(strained(), by_x, by_y, kGrid);
      FAIL() << by_x << " x " << by_y;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_scene);
      EXPECT_NE(std::string(error.what()).find(std::to_string(by_x) + " x " + std::to_string(by_y) + " nodes"),
                std::string::npos);
    }
  }
}

}  // namespace
}  // namespace brinell::plastic
