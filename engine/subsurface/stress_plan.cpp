#include "subsurface/stress_plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "parallel/arena.h"
#include "subsurface/depths.h"
#include "subsurface/stress_spectra.h"

namespace brinell::subsurface {

namespace {

// From this many nodes on, one transform has work for many threads.
constexpr std::size_t kNodesForThreadsInside = std::size_t{1} << 17;
constexpr std::int64_t kMostLayersOfBatch = 16;
constexpr std::size_t kBytesOfBatch = std::size_t{16} << 20;  // spectra stay in the shared cache until they are used
constexpr double kMostBytes = 0x1p62;

std::int64_t count_of(Components components) {
  std::int64_t count = 0;
  for (int c = 0; c < kComponents; ++c) count += components.has(c) ? 1 : 0;
  return count;
}
std::int64_t count_of(Invariants invariants) {
  std::int64_t count = 0;
  for (int k = 0; k < kInvariants; ++k) count += invariants.has(k) ? 1 : 0;
  return count;
}

Components needed_for(const StressRequest& request) {
  Components needed = request.components;
  const Invariants wanted = request.invariants | request.maxima;
  if (wanted.has(Invariant::hydrostatic)) {
    needed = needed | Components{StressComponent::xx, StressComponent::yy, StressComponent::zz};
  }
  const Invariants trace_only{Invariant::hydrostatic};
  if (request.directions || !((wanted | trace_only) == trace_only)) needed = kAllComponents;
  return needed;
}

}  // namespace

void check(const StressRequest& request) {
  const Grid& grid = request.grid;
  if (grid.nx < 1 || grid.ny < 1) {
    fail(Status::invalid_argument, "grid of " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) +
                                       " nodes: each side must be at least 1");
  }
  for (const auto& [name, spacing] : {std::pair{"dx", grid.dx}, std::pair{"dy", grid.dy}}) {
    if (!(spacing > 0) || !std::isfinite(spacing)) {
      fail(Status::invalid_argument, std::string(name) + " = " + text(spacing) + ": must be positive and finite");
    }
  }
  if (!(request.poissons_ratio > -1) || !(request.poissons_ratio < 0.5)) {
    fail(Status::invalid_argument,
         "poissons_ratio = " + text(request.poissons_ratio) + ": must be greater than -1 and less than 0.5");
  }
  check_depths(request.depths);
  if (request.sources.empty()) {
    fail(Status::invalid_argument, "sources: at least one of pressure, shear_x and shear_y is needed");
  }
  if (request.components.empty() && request.invariants.empty() && request.maxima.empty() && !request.directions) {
    fail(Status::invalid_argument, "nothing is asked for: name components, invariants, directions or maxima");
  }
  const double nodes = static_cast<double>(grid.nx) * static_cast<double>(grid.ny);
  if (nodes * static_cast<double>(request.depths.size()) * 64 * sizeof(double) > kMostBytes) {
    fail(Status::too_large, std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " nodes on " +
                                std::to_string(request.depths.size()) + " layers: more than can be addressed");
  }
}

StressPlan plan_stress(const fft::Backend& backend, const StressRequest& request, std::size_t spectra_limit) {
  check(request);
  const Grid& grid = request.grid;
  const std::size_t nodes = grid.nodes();
  const std::size_t field = Buffer<double>::padded_bytes(nodes);

  StressPlan plan;
  plan.layers = static_cast<std::int64_t>(request.depths.size());
  plan.threads_inside = nodes >= kNodesForThreadsInside;
  plan.needed = needed_for(request);

  const SpectrumIndex index(request.sources, plan.needed);
  const parallel::Arena one_thread(1);
  const fft::Convolution<double> convolution({one_thread, backend.kernels, backend.plans}, grid.nx, grid.ny,
                                             request.boundary);
  const auto spectra = static_cast<std::size_t>(index.count());
  const std::size_t layer_spectra = spectra * convolution.spectrum_bytes();
  plan.kept_layers = std::min(plan.layers, static_cast<std::int64_t>(spectra_limit / layer_spectra));
  plan.kept_bytes = static_cast<std::size_t>(plan.kept_layers) * layer_spectra;

  const Invariants wanted = request.invariants | request.maxima;
  const auto arrays =
      static_cast<std::size_t>(count_of(plan.needed) + count_of(wanted) + (request.directions ? 9 : 0));
  const std::size_t layer_bytes = layer_spectra + arrays * field;
  plan.batch = std::clamp(static_cast<std::int64_t>(kBytesOfBatch / layer_bytes), std::int64_t{1},
                          std::min(kMostLayersOfBatch, plan.layers));
  if (plan.threads_inside) plan.batch = 1;

  const auto stored = static_cast<std::size_t>(count_of(request.components) + count_of(request.invariants) +
                                               (request.directions ? 9 : 0));
  plan.field_bytes = stored * static_cast<std::size_t>(plan.layers) * nodes * sizeof(double);

  // Scratch of a worker: a transform's workspace; coefficients and the transform of one of them while generating.
  const std::size_t generating =
      request.boundary == Boundary::free
          ? kComponents * field + 2 * convolution.spectrum_bytes() +
                static_cast<std::size_t>(convolution.padded_nx() + convolution.padded_ny()) * 10 * sizeof(double)
          : 0;
  const std::size_t workers = plan.threads_inside ? 1 : static_cast<std::size_t>(backend.arena.threads());
  const bool streams = plan.kept_layers < plan.layers;
  const auto batch = static_cast<std::size_t>(plan.batch);
  plan.work_bytes = workers * (convolution.workspace_bytes() + generating) +
                    kTractions * convolution.transform_bytes() + field + (streams ? batch * layer_spectra : 0) +
                    (batch * arrays + static_cast<std::size_t>(count_of(request.maxima))) * field;
  return plan;
}

}  // namespace brinell::subsurface
