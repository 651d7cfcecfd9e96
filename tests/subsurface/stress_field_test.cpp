#include "subsurface/stress_field.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "subsurface/stress_case.h"

namespace brinell::subsurface {
namespace {

StressRequest full_request(const Grid& grid, std::vector<double> depths) {
  StressRequest request;
  request.grid = grid;
  request.poissons_ratio = 0.3;
  request.depths = std::move(depths);
  request.sources = kAllSources;
  request.components = kAllComponents;
  return request;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

void expect_same_bits(const Fields& a, const Fields& b, const std::string& where) {
  for (std::size_t c = 0; c < kComponents; ++c) EXPECT_TRUE(same_bits(a.component[c], b.component[c])) << where << c;
  for (std::size_t k = 0; k < kInvariants; ++k) {
    EXPECT_TRUE(same_bits(a.invariant[k], b.invariant[k])) << where << k;
    EXPECT_EQ(a.maxima[k].value, b.maxima[k].value) << where << k;
    EXPECT_EQ(a.maxima[k].position, b.maxima[k].position) << where << k;
  }
  for (std::size_t k = 0; k < 9; ++k) EXPECT_TRUE(same_bits(a.direction[k], b.direction[k])) << where << k;
}

/// Σ coefficient · traction, one product after the other.
std::array<double, 6> direct_sum(const StressRequest& request, const Tractions& tractions, double depth,
                                 std::int64_t i, std::int64_t j) {
  const influence::Stress stress(request.grid.dx, request.grid.dy, depth, request.poissons_ratio);
  std::array<double, 6> sum{};
  for (int t = 0; t < kTractions; ++t) {
    if (!request.sources.has(t)) continue;
    for (std::int64_t l = 0; l < request.grid.ny; ++l) {
      for (std::int64_t k = 0; k < request.grid.nx; ++k) {
        const auto six = stress(static_cast<Traction>(t), i - k, j - l);
        const double source = tractions[static_cast<std::size_t>(t)][l * request.grid.nx + k];
        for (std::size_t c = 0; c < 6; ++c) sum[c] += six[c] * source;
      }
    }
  }
  return sum;
}

TEST(StressField, is_the_direct_sum_for_any_size_spacing_source_and_instruction_set) {
  for (const Grid& grid : {Grid{1, 1, 1, 1}, Grid{2, 1, 1, 3}, Grid{7, 5, 1, 0.4}, Grid{16, 9, 2e-6, 1e-6},
                           Grid{13, 17, 1, 1}, Grid{1, 31, 1, 1}}) {
    const double h = grid.dx;
    const RandomTractions tractions(grid);
    for (const Sources sources : {Sources{Traction::pressure}, Sources{Traction::shear_x}, Sources{Traction::shear_y},
                                  Sources{Traction::shear_x, Traction::shear_y}, kAllSources}) {
      StressRequest request = full_request(grid, {0.0, 0.3 * h, 1.7 * h, 30 * h});
      request.sources = sources;
      for (const simd::Isa isa : simd::supported()) {
        const Fields fields = computed(Engine(1, isa), request, tractions.pointers());
        for (std::size_t layer = 0; layer < request.depths.size(); ++layer) {
          for (std::size_t n = 0; n < grid.nodes(); n += grid.nodes() / 11 + 1) {
            const auto at = static_cast<std::int64_t>(n);
            const auto expected =
                direct_sum(request, tractions.pointers(), request.depths[layer], at % grid.nx, at / grid.nx);
            const auto found = fields.at(layer * grid.nodes() + n);
            // Coefficients are of order one, tractions too: round-off of as many of them as there are.
            for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(found[c], expected[c], 2e-14) << c << " layer " << layer;
          }
        }
      }
    }
  }
}

TEST(StressField, has_the_given_tractions_at_the_surface_and_none_beside_them) {
  const Grid grid{24, 20, 1.0, 1.5};
  RandomTractions tractions(grid);
  for (std::size_t k = 0; k < tractions.values.size(); ++k) {
    if (k % 24 > 11) tractions.values[k] = 0;
  }
  const Fields fields = computed(Engine(), full_request(grid, {0.0}), tractions.pointers());
  for (std::size_t n = 0; n < grid.nodes(); ++n) {
    EXPECT_NEAR(fields.component[kZz][n], -tractions.values[n], 1e-13);
    EXPECT_NEAR(fields.component[kXz][n], -tractions.values[grid.nodes() + n], 1e-13);
    EXPECT_NEAR(fields.component[kYz][n], -tractions.values[2 * grid.nodes() + n], 1e-13);
  }
}

TEST(StressField, is_in_equilibrium_to_second_order_of_the_finite_differences) {
  const double h = 0.25;
  const Grid grid{32, 32, h, h};
  std::vector<double> depths;
  for (int k = 0; k < 5; ++k) depths.push_back(2.0 + h * k);  // some cells deep: smooth
  const RandomTractions tractions(grid);
  const Fields fields = computed(Engine(), full_request(grid, depths), tractions.pointers());
  constexpr int row[3][3] = {{kXx, kXy, kXz}, {kXy, kYy, kYz}, {kXz, kYz, kZz}};
  double residual[2] = {0, 0};
  for (const std::int64_t step : {1, 2}) {
    for (std::int64_t j = 4; j < 28; ++j) {
      for (std::int64_t i = 4; i < 28; ++i) {
        for (const auto& component : row) {
          double divergence = 0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t apart = step * (axis == 0   ? 1
                                               : axis == 1 ? grid.nx
                                                           : static_cast<std::int64_t>(grid.nodes()));
            const std::int64_t centre = 2 * static_cast<std::int64_t>(grid.nodes()) + j * grid.nx + i;
            const auto& field = fields.component[static_cast<std::size_t>(component[axis])];
            divergence +=
                (field[static_cast<std::size_t>(centre + apart)] - field[static_cast<std::size_t>(centre - apart)]) /
                (2 * h * static_cast<double>(step));
          }
          double& worst = residual[step - 1];
          worst = std::max(worst, std::abs(divergence));
        }
      }
    }
  }
  EXPECT_NEAR(std::log2(residual[1] / residual[0]), 2, 0.25);
  EXPECT_LT(residual[0], 0.02);
}

TEST(StressField, of_a_sum_is_the_sum) {
  const Grid grid{20, 14, 1, 1.3};
  const RandomTractions a(grid, 1), b(grid, 2);
  RandomTractions sum(grid);
  for (std::size_t k = 0; k < sum.values.size(); ++k) sum.values[k] = 2 * a.values[k] - 3 * b.values[k];
  const StressRequest request = full_request(grid, {0.5, 4.0});
  const Engine engine;
  const Fields of_a = computed(engine, request, a.pointers()), of_b = computed(engine, request, b.pointers());
  const Fields of_sum = computed(engine, request, sum.pointers());
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t n = 0; n < of_a.component[c].size(); ++n) {
      EXPECT_NEAR(of_sum.component[c][n], 2 * of_a.component[c][n] - 3 * of_b.component[c][n], 1e-13);
    }
  }
}

TEST(StressField, of_exchanged_axes_is_exchanged) {
  const Grid grid{15, 22, 1, 0.7}, turned{22, 15, 0.7, 1};
  const RandomTractions tractions(grid);
  RandomTractions other(turned);
  const std::size_t nodes = grid.nodes();
  for (std::size_t j = 0; j < 22; ++j) {
    for (std::size_t i = 0; i < 15; ++i) {
      const std::size_t from = j * 15 + i, to = i * 22 + j;
      other.values[to] = tractions.values[from];
      other.values[nodes + to] = tractions.values[2 * nodes + from];
      other.values[2 * nodes + to] = tractions.values[nodes + from];
    }
  }
  const Engine engine;
  const Fields a = computed(engine, full_request(grid, {0.4}), tractions.pointers());
  const Fields b = computed(engine, full_request(turned, {0.4}), other.pointers());
  constexpr std::size_t exchanged[6] = {1, 0, 2, 4, 3, 5};
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t j = 0; j < 22; ++j) {
      for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_NEAR(a.component[c][j * 15 + i], b.component[exchanged[c]][i * 22 + j], 2e-14);
      }
    }
  }
}

TEST(StressField, of_the_upper_body_is_that_of_the_reaction) {
  const Grid grid{12, 10, 1, 1};
  RandomTractions tractions(grid);
  StressRequest request = full_request(grid, {0.0, 0.8});
  request.body = Body::upper;
  const Engine engine;
  const Fields upper = computed(engine, request, tractions.pointers());
  request.body = Body::lower;
  for (std::size_t k = grid.nodes(); k < tractions.values.size(); ++k) tractions.values[k] *= -1;
  expect_same_bits(upper, computed(engine, request, tractions.pointers()), "reaction ");
  // At its surface: pressed upon, and pushed back.
  EXPECT_NEAR(upper.component[kZz][5], -tractions.values[5], 1e-13);
  EXPECT_NEAR(upper.component[kXz][5], -tractions.values[grid.nodes() + 5], 1e-13);
}

StressRequest everything(const Grid& grid, std::size_t layers) {
  std::vector<double> depths;
  for (std::size_t k = 0; k < layers; ++k) depths.push_back(0.3 * static_cast<double>(k * k + 1));
  StressRequest request = full_request(grid, depths);
  request.invariants = Invariants::first(kInvariants);
  request.maxima = Invariants::first(kInvariants);
  request.directions = true;
  return request;
}

TEST(StressField, has_the_same_bits_for_any_number_of_threads_and_any_spectra_kept) {
  const oneapi::tbb::global_control more(oneapi::tbb::global_control::max_allowed_parallelism, 8);
  // One grid with threads over layers and components, one with threads inside the transforms.
  for (const auto& [grid, layers] :
       {std::pair{Grid{31, 44, 1, 1}, std::size_t{19}}, std::pair{Grid{384, 360, 1, 1}, std::size_t{2}}}) {
    const RandomTractions tractions(grid);
    StressRequest request = everything(grid, layers);
    if (layers == 2) request.directions = false;
    const Fields alone = computed(Engine(1), request, tractions.pointers());
    const StressPlan plan = plan_stress(Engine(1).backend, request, 0);
    EXPECT_EQ(plan.threads_inside, layers == 2);
    for (const int threads : {2, 3, 8}) {
      expect_same_bits(alone, computed(Engine(threads), request, tractions.pointers()),
                       std::to_string(threads) + " threads ");
    }
    const std::size_t all = static_cast<std::size_t>(-1);
    const std::size_t some = plan_stress(Engine(1).backend, request, all).kept_bytes / 3;
    expect_same_bits(alone, computed(Engine(2), request, tractions.pointers(), some, 2), "some kept ");
    expect_same_bits(alone, computed(Engine(2), request, tractions.pointers(), all, 2), "all kept ");
  }
}

TEST(StressField, invariants_are_those_of_its_components) {
  const Grid grid{19, 12, 1, 1};
  const RandomTractions tractions(grid);
  const Fields fields = computed(Engine(), everything(grid, 5), tractions.pointers());
  for (std::size_t n = 0; n < fields.component[0].size(); n += 7) {
    const Tensor stress = fields.at(n);
    EXPECT_NEAR(fields.invariant[0][n], von_mises(stress), 1e-14);
    EXPECT_NEAR(fields.invariant[1][n], tresca(stress), 1e-13);
    EXPECT_NEAR(fields.invariant[2][n], hydrostatic(stress), 1e-14);
    const Principal expected = principal(stress);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fields.invariant[3 + k][n], expected.value[k], 1e-13);
  }
}

TEST(StressField, computes_one_thing_alone_as_it_computes_all) {
  const Grid grid{21, 17, 1, 1};
  const RandomTractions tractions(grid);
  const StressRequest all = everything(grid, 20);
  const Engine engine;
  const Fields expected = computed(engine, all, tractions.pointers());
  for (int k = 0; k < kInvariants; ++k) {
    StressRequest request = full_request(grid, all.depths);
    request.components = {};
    request.maxima.add(static_cast<Invariant>(k));
    const Fields found = computed(engine, request, tractions.pointers());
    const auto at = static_cast<std::size_t>(k);
    // Hydrostatic alone needs three components, of which coefficients are other sums: round-off.
    EXPECT_NEAR(found.maxima[at].value, expected.maxima[at].value, 1e-12);
    EXPECT_NEAR(found.maxima[at].position[2], expected.maxima[at].position[2], 1e-9);
    EXPECT_EQ(plan_stress(engine.backend, request, 0).field_bytes, 0);
    const auto& field = expected.invariant[at];
    EXPECT_NEAR(found.maxima[at].node_value, *std::max_element(field.begin(), field.end()), 1e-12);
  }
  for (int c = 0; c < kComponents; ++c) {
    StressRequest request = full_request(grid, all.depths);
    request.components = {};
    request.components.add(static_cast<StressComponent>(c));
    const Fields found = computed(engine, request, tractions.pointers());
    for (std::size_t n = 0; n < grid.nodes() * 20; ++n) {
      ASSERT_NEAR(found.component[static_cast<std::size_t>(c)][n], expected.component[static_cast<std::size_t>(c)][n],
                  1e-13);
    }
  }
}

TEST(StressField, by_layer_is_the_whole_in_order) {
  const Grid grid{11, 13, 1, 1};
  const RandomTractions tractions(grid);
  const StressRequest request = everything(grid, 20);
  const Engine engine(2);
  const Fields expected = computed(engine, request, tractions.pointers());
  StressField stress(engine.backend, request);
  std::int64_t next = 0;
  const Maxima maxima = stress.compute_by_layer(tractions.pointers(), [&](const StressLayer& layer) {
    EXPECT_EQ(layer.layer, next++);
    EXPECT_EQ(layer.depth, request.depths[static_cast<std::size_t>(layer.layer)]);
    const std::size_t offset = static_cast<std::size_t>(layer.layer) * grid.nodes();
    const auto same = [&](const double* found, const std::vector<double>& whole) {
      return std::memcmp(found, whole.data() + offset, grid.nodes() * sizeof(double)) == 0;
    };
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_TRUE(same(layer.component[k], expected.component[k]));
      EXPECT_TRUE(same(layer.invariant[k], expected.invariant[k]));
    }
    for (std::size_t k = 0; k < 9; ++k) EXPECT_TRUE(same(layer.direction[k], expected.direction[k]));
  });
  EXPECT_EQ(next, 20);
  for (std::size_t k = 0; k < kInvariants; ++k) EXPECT_EQ(maxima[k].value, expected.maxima[k].value);
}

TEST(StressField, goes_on_after_a_layer_was_refused) {
  const Grid grid{11, 13, 1, 1};
  const RandomTractions tractions(grid);
  const StressRequest request = full_request(grid, {0.5, 1.0, 1.5});
  const Engine engine;
  StressField stress(engine.backend, request, static_cast<std::size_t>(-1));
  EXPECT_THROW(
      stress.compute_by_layer(tractions.pointers(), [](const StressLayer&) { fail(Status::cancelled, "stopped"); }),
      Error);
  int layers = 0;
  stress.compute_by_layer(tractions.pointers(), [&](const StressLayer&) { ++layers; });
  EXPECT_EQ(layers, 3);
}

TEST(StressField, names_what_is_missing) {
  const Grid grid{4, 4, 1, 1};
  const RandomTractions tractions(grid);
  const Engine engine;
  StressField stress(engine.backend, full_request(grid, {1.0}));
  const auto message = [&](const Tractions& given) -> std::string {
    try {
      stress.compute(given, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(tractions.pointers()).find("field of stress xx"), std::string::npos);
  Tractions without = tractions.pointers();
  without[1] = nullptr;
  try {
    stress.compute_by_layer(without, [](const StressLayer&) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("shear_x"), std::string::npos);
  }
}

}  // namespace
}  // namespace brinell::subsurface
