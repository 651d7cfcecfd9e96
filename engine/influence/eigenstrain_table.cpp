#include "influence/eigenstrain_table.h"

#include <algorithm>

namespace brinell::influence {

namespace {

using Extent = Eigenstrain::Extent;
using Potentials = Eigenstrain::Potentials;

// Layers that one task makes: the corners between them are shared.
constexpr std::int64_t kTogether = 8;

Extent smaller(const Extent& a, const Extent& b) {
  return {std::min(a.nx, b.nx), std::min(a.ny, b.ny)};
}

int potentials_of(Potentials which) {
  return which == Potentials::image ? simd::kImagePotentials : simd::kKelvinPotentials;
}

std::size_t values_of(Potentials which, const Extent& extent) {
  return static_cast<std::size_t>(potentials_of(which) * extent.nx * extent.ny);
}

}  // namespace

void EigenstrainTable::cover(const parallel::Arena& arena, std::int64_t nx, std::int64_t ny, std::int64_t nz) {
  cover(arena, Potentials::kelvin, 0, nz, {nx, ny}, kelvin_);
  cover(arena, Potentials::image, 1, 2 * nz, {nx, ny}, image_);
}

void EigenstrainTable::cover(const parallel::Arena& arena, Potentials which, std::int64_t first, std::int64_t end,
                             const Extent& box, Layers& layers) {
  if (layers.size() < static_cast<std::size_t>(end)) layers.resize(static_cast<std::size_t>(end));
  std::int64_t begin = end, stop = end;  // the layers that are near and lack something
  for (std::int64_t layer = first; layer < end; ++layer) {
    const Extent near = cuboid_.near_extent(layer);
    if (near.nx == 0) {
      stop = layer;
      break;
    }
    const Extent needed = smaller(near, box), &there = layers[static_cast<std::size_t>(layer)].extent;
    if (there.nx < needed.nx || there.ny < needed.ny) begin = std::min(begin, layer);
  }
  arena.for_chunks(stop - begin, kTogether, [&](std::int64_t from, std::int64_t to, int) {
    const Extent extent = smaller(cuboid_.near_extent(begin + from), box);
    double* values[kTogether] = {};
    for (std::int64_t n = from; n < to; ++n) {
      Layer& layer = layers[static_cast<std::size_t>(begin + n)];
      layer.values = Buffer<double>::uninitialised(values_of(which, extent));
      layer.extent = extent;
      values[n - from] = layer.values.data();
    }
    cuboid_.fill_near(which, begin + from, to - from, extent, values);
  });
}

void EigenstrainTable::fill_kelvin(const simd::EigenstrainKernels& kernels, std::int64_t layer, std::int64_t nx,
                                   std::int64_t ny, double* potentials) const {
  const Layer& near = kelvin_[static_cast<std::size_t>(layer)];
  cuboid_.fill_layer(kernels, Potentials::kelvin, layer, nx, ny, near.extent, near.values.data(), potentials);
}

void EigenstrainTable::fill_image(const simd::EigenstrainKernels& kernels, std::int64_t layer, std::int64_t nx,
                                  std::int64_t ny, double* potentials) const {
  const Layer& near = image_[static_cast<std::size_t>(layer)];
  cuboid_.fill_layer(kernels, Potentials::image, layer, nx, ny, near.extent, near.values.data(), potentials);
}

EigenstrainTable::Bytes EigenstrainTable::bytes(const Eigenstrain& cuboid, int threads, std::int64_t nx,
                                                std::int64_t ny, std::int64_t nz) {
  Bytes bytes;
  const Extent widest = smaller(cuboid.near_extent(0), {nx, ny});
  for (std::int64_t layer = 0; layer < 2 * nz; ++layer) {
    // Those of one task have the first one's extent.
    const Extent extent = smaller(cuboid.near_extent(std::max<std::int64_t>(0, layer - kTogether + 1)), {nx, ny});
    if (cuboid.near_extent(layer).nx == 0) break;
    if (layer < nz) bytes.kept += Buffer<double>::padded_bytes(values_of(Potentials::kelvin, extent));
    bytes.kept += Buffer<double>::padded_bytes(values_of(Potentials::image, extent));
  }
  bytes.work = static_cast<std::size_t>(threads) * Eigenstrain::near_scratch_bytes(widest);
  return bytes;
}

}  // namespace brinell::influence
