#include "subsurface/stress_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "subsurface/depths.h"
#include "subsurface/stress_case.h"

namespace brinell::subsurface {
namespace {

constexpr std::size_t kAll = static_cast<std::size_t>(-1);

StressRequest cube(std::int64_t n, std::int64_t layers) {
  StressRequest request;
  request.grid = {n, n, 1e-6, 1e-6};
  request.poissons_ratio = 0.3;
  request.depths = layer_depths(layers, 1e-6);
  request.sources = kAllSources;
  request.components = kAllComponents;
  return request;
}

TEST(StressPlan, keeps_large_requests_within_bounds) {
  const Engine engine(2);
  const StressPlan full = plan_stress(engine.backend, cube(128, 128), kAll);
  EXPECT_EQ(full.field_bytes, 6u * 128 * 128 * 128 * 8);
  EXPECT_EQ(full.kept_layers, 128);
  EXPECT_LT(full.total_bytes(), std::size_t{1} << 30);
  const StressPlan half = plan_stress(engine.backend, cube(128, 64), kAll);
  EXPECT_LT(half.kept_bytes + half.work_bytes, 600u * 1000 * 1000);
  const StressPlan streamed = plan_stress(engine.backend, cube(128, 64), 0);
  EXPECT_EQ(streamed.kept_bytes, 0u);
  EXPECT_LT(streamed.work_bytes, 40u << 20);
}

TEST(StressPlan, stores_no_field_for_a_maximum) {
  StressRequest request = cube(64, 32);
  request.components = {};
  request.maxima = {Invariant::von_mises};
  const StressPlan plan = plan_stress(Engine().backend, request, 0);
  EXPECT_EQ(plan.field_bytes, 0u);
  EXPECT_EQ(plan.needed, kAllComponents);
}

TEST(StressPlan, computes_only_what_is_needed) {
  StressRequest request = cube(32, 4);
  request.components = {StressComponent::xy};
  EXPECT_EQ(plan_stress(Engine().backend, request, 0).needed, Components{StressComponent::xy});
  request.maxima = {Invariant::hydrostatic};
  const Components with_trace{StressComponent::xx, StressComponent::yy, StressComponent::zz, StressComponent::xy};
  EXPECT_EQ(plan_stress(Engine().backend, request, 0).needed, with_trace);
}

TEST(StressPlan, keeps_whole_layers_up_to_the_limit) {
  const StressRequest request = cube(32, 10);
  const Engine engine;
  const StressPlan all = plan_stress(engine.backend, request, kAll);
  const std::size_t layer = all.kept_bytes / 10;
  EXPECT_EQ(plan_stress(engine.backend, request, 3 * layer).kept_layers, 3);
  EXPECT_EQ(plan_stress(engine.backend, request, 3 * layer - 1).kept_layers, 2);
  EXPECT_EQ(plan_stress(engine.backend, request, layer - 1).kept_layers, 0);
}

void expect_refused(const StressRequest& request, const std::string& part, Status status = Status::invalid_argument) {
  try {
    plan_stress(Engine().backend, request, 0);
    FAIL() << "accepted; expected: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), status);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(StressPlan, names_what_is_wrong) {
  const auto with = [](auto change) {
    StressRequest request = cube(8, 2);
    change(request);
    return request;
  };
  expect_refused(with([](StressRequest& r) { r.grid.nx = 0; }), "grid of 0 x 8");
  expect_refused(with([](StressRequest& r) { r.grid.dy = -1; }), "dy = -1");
  expect_refused(with([](StressRequest& r) { r.poissons_ratio = 0.5; }), "poissons_ratio = 0.5");
  expect_refused(with([](StressRequest& r) { r.poissons_ratio = std::nan(""); }), "poissons_ratio = nan");
  expect_refused(with([](StressRequest& r) { r.depths[1] = -2e-6; }), "depths[1] = -2e-06");
  expect_refused(with([](StressRequest& r) { r.depths.clear(); }), "depths");
  expect_refused(with([](StressRequest& r) { r.sources = {}; }), "sources");
  expect_refused(with([](StressRequest& r) { r.components = {}; }), "nothing is asked for");
  expect_refused(with([](StressRequest& r) { r.grid.nx = r.grid.ny = std::int64_t{1} << 29; }), "more than can be",
                 Status::too_large);
}

}  // namespace
}  // namespace brinell::subsurface
