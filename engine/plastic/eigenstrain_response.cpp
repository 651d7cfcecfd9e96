#include "plastic/eigenstrain_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.h"
#include "fft/lane_carrier.h"
#include "fft/lane_tree.h"
#include "influence/eigenstrain.h"
#include "parallel/arena.h"
#include "plastic/box_checks.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

namespace {

using influence::Parities;

/// The shortest tree of at least n values.
std::int64_t shortest_tree(std::int64_t n) {
  while (!fft::is_tree_length(n)) ++n;
  return n;
}

}  // namespace

struct EigenstrainResponse::Geometry {
  Geometry(const fft::Backend& backend, const Box& box)
      : carrier(fft::lane_carrier<double>(backend.kernels.in_double.transform, box.nx, box.ny, Boundary::free, false,
                                          true)),
        along_z(shortest_tree(box.nz), 1, 4),
        lanes(backend.kernels.in_double.transform.lanes),
        depth(static_cast<std::size_t>(box.nz)) {
    transform.columns = carrier->columns();
    transform.along_z = along_z.view();
    transform.nz = box.nz;
    transform.depth = depth.data();
    transform.field_stride = static_cast<std::int64_t>(carrier->field_size());
    const simd::EigenstrainKernels& kernels = backend.kernels.eigenstrain;
    block_scratch = static_cast<std::size_t>(kernels.residual_scratch(transform));
    scratch = (std::max(block_scratch, carrier->scratch_size()) + 7) / 8 * 8;
  }

  std::int64_t positions_y() const { return transform.columns.tree.length; }
  std::int64_t length_z() const { return transform.along_z.length; }
  std::int64_t values_of_block() const { return positions_y() * length_z() * simd::kSpectralValues * lanes; }
  std::size_t spectra_size() const { return static_cast<std::size_t>(carrier->blocks() * values_of_block()); }
  std::size_t field_size() const {
    return static_cast<std::size_t>(6 * transform.nz) * static_cast<std::size_t>(transform.field_stride);
  }
  /// Of one thread while spectra are generated: potentials of a layer, their field, scratch, one spectrum.
  std::size_t generation_size(const Box& box) const {
    const std::size_t layer = static_cast<std::size_t>(simd::kImagePotentials * box.nx * box.ny);
    return (layer + carrier->field_size() + scratch + carrier->spectrum_size() + 24) / 8 * 8;
  }

  std::unique_ptr<const fft::LaneCarrier<double>> carrier;
  fft::LaneTree<double> along_z;
  std::int64_t lanes;
  Buffer<double> depth;  // of the layers, in the unit of the potentials
  simd::ResidualTransform transform{};
  std::size_t block_scratch, scratch;  // of one thread, in doubles
};

EigenstrainResponse::EigenstrainResponse(const fft::Backend& backend, const Box& box, double shear_modulus,
                                         double poissons_ratio)
    : backend_(backend),
      box_(box),
      shear_modulus_(shear_modulus),
      potentials_(std::make_shared<influence::EigenstrainTable>(
          influence::Eigenstrain(box.dx, box.dy, box.dz, poissons_ratio))) {
  check_box(box);
  if (!(shear_modulus > 0) || !std::isfinite(shear_modulus)) {
    fail(Status::invalid_argument, "shear_modulus = " + text(shear_modulus) + ": must be positive");
  }
  generate();
}

EigenstrainResponse::EigenstrainResponse(const EigenstrainResponse& other, const Box& box)
    : backend_(other.backend_),
      box_(other.box_),
      shear_modulus_(other.shear_modulus_),
      potentials_(other.potentials_) {
  resize(box);
}

void EigenstrainResponse::resize(const Box& box) {
  check_box(box);
  if (box == box_ && geometry_ != nullptr) return;
  if (box.dx != box_.dx || box.dy != box_.dy || box.dz != box_.dz) {
    fail(Status::invalid_argument, "a box of cuboids " + text(box.dx) + " x " + text(box.dy) + " x " + text(box.dz) +
                                       ": must be the same as before, " + text(box_.dx) + " x " + text(box_.dy) +
                                       " x " + text(box_.dz));
  }
  geometry_.reset();  // stays away if what follows fails
  box_ = box;
  generate();
}

EigenstrainResponse::~EigenstrainResponse() = default;

EigenstrainResponse::Bytes EigenstrainResponse::bytes(const fft::Backend& backend, const Box& box) {
  check_box(box);
  const Geometry geometry(backend, box);
  const auto threads = static_cast<std::size_t>(backend.arena.threads());
  const influence::EigenstrainTable::Bytes potentials = influence::EigenstrainTable::bytes(
      influence::Eigenstrain(box.dx, box.dy, box.dz, 0), backend.arena.threads(), box.nx, box.ny, box.nz);
  return {
      Buffer<double>::padded_bytes(geometry.spectra_size()),
      Buffer<double>::padded_bytes(geometry.field_size()) + Buffer<double>::padded_bytes(geometry.scratch * threads),
      std::max(potentials.work, Buffer<double>::padded_bytes(geometry.generation_size(box) * threads)),
      potentials.kept};
}

void EigenstrainResponse::generate() {
  const influence::Eigenstrain& cuboid = potentials_->cuboid();
  auto geometry = std::make_unique<Geometry>(backend_, box_);
  const Geometry& g = *geometry;
  const fft::LaneCarrier<double>& carrier = *g.carrier;
  const simd::EigenstrainKernels& kernels = backend_.kernels.eigenstrain;
  const std::int64_t nodes = box_.nx * box_.ny, nz = box_.nz;
  for (std::int64_t k = 0; k < nz; ++k) {
    geometry->depth[static_cast<std::size_t>(k)] = (static_cast<double>(k) + 0.5) * box_.dz / cuboid.unit();
  }
  geometry->transform.depth = geometry->depth.data();
  geometry->transform.poissons_ratio = cuboid.poissons_ratio();
  const double points = 0.25 * static_cast<double>(carrier.padded_nx()) * static_cast<double>(carrier.padded_ny());
  geometry->transform.own = 2 * shear_modulus_ / (points * static_cast<double>(g.length_z()));

  potentials_->cover(backend_.arena, box_.nx, box_.ny, nz);
  spectra_.resize(g.spectra_size());
  const std::size_t part = g.generation_size(box_);
  Buffer<double> memory = Buffer<double>::uninitialised(part * static_cast<std::size_t>(backend_.arena.threads()));
  const std::int64_t of_position = g.length_z() * simd::kSpectralValues * g.lanes;

  // Transforms one potential of a layer along x and y and puts it to position `place` along z.
  const auto put = [&](double* quarter, Parities parity, double* work, std::int64_t place, int value) {
    double *field = work, *scratch = field + carrier.field_size(), *spectrum = scratch + g.scratch;
    for (std::int64_t i = 0; parity.y == fft::Parity::even && i < box_.nx; ++i) quarter[i] *= 0.5;
    for (std::int64_t j = 0; parity.x == fft::Parity::even && j < box_.ny; ++j) quarter[j * box_.nx] *= 0.5;
    carrier.rows_forward(0, box_.ny, quarter, field, scratch);
    for (std::int64_t block = 0; block < carrier.blocks(); ++block) {
      carrier.spectrum_block(block, parity.x, parity.y, field, spectrum, scratch);
      const double* from = spectrum + block * g.positions_y() * g.lanes;
      double* to = spectra_.data() + block * g.values_of_block() + (place * simd::kSpectralValues + value) * g.lanes;
      for (std::int64_t p = 0; p < g.positions_y(); ++p, from += g.lanes, to += of_position) {
        for (std::int64_t lane = 0; lane < g.lanes; ++lane) to[lane] = from[lane];
      }
    }
  };
  const std::int64_t layers = nz + 2 * nz - 1;  // of the full space, of the image
  backend_.arena.for_chunks(layers, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    double* work = memory.data() + static_cast<std::size_t>(slot) * part;
    const std::size_t behind = (static_cast<std::size_t>(simd::kImagePotentials * nodes) + 7) / 8 * 8;
    for (std::int64_t layer = begin; layer < end; ++layer) {
      if (layer < nz) {
        potentials_->fill_kelvin(kernels, layer, box_.nx, box_.ny, work);
        for (int k = 0; k < simd::kKelvinPotentials; ++k) {
          put(work + k * nodes, influence::kelvin_parities(k), work + behind, layer, k);
        }
        continue;
      }
      const std::int64_t above = layer - nz + 1;  // 1 … 2nz − 1 layers
      potentials_->fill_image(kernels, above, box_.nx, box_.ny, work);
      const std::int64_t place = std::abs(above - nz);
      const int first = simd::kKelvinPotentials + (above < nz ? simd::kImagePotentials : 0);
      for (int k = 0; k < simd::kImagePotentials; ++k) {
        put(work + k * nodes, influence::image_parities(k), work + behind, place, first + k);
      }
    }
  });

  std::vector<double> phase(static_cast<std::size_t>(2 * g.length_z()));
  const std::vector<std::int64_t>& leaves = g.along_z.leaf_numerators();
  for (std::size_t p = 0; p < leaves.size(); ++p) {
    fft::unit_root<double>(leaves[p] * (nz - 1), g.along_z.leaf_denominator(), phase[2 * p], phase[2 * p + 1]);
  }
  const double scale = -2 * shear_modulus_ /
                       (8 * std::numbers::pi * (1 - cuboid.poissons_ratio()) * static_cast<double>(g.length_z()));
  const auto scratch = (static_cast<std::size_t>(kernels.spectra_scratch(g.transform.along_z)) + 7) / 8 * 8;
  Buffer<double> columns =
      Buffer<double>::uninitialised(scratch * static_cast<std::size_t>(backend_.arena.threads()));
  backend_.arena.for_chunks(
      carrier.blocks() * g.positions_y(), 16, [&](std::int64_t begin, std::int64_t end, int slot) {
        for (std::int64_t p = begin; p < end; ++p) {
          // No image is nz layers above itself: the imaginary parts of the first position.
          std::fill_n(spectra_.data() + p * of_position + (simd::kSpectralValues - simd::kImagePotentials) * g.lanes,
                      simd::kImagePotentials * g.lanes, 0.0);
          kernels.transform_spectra(g.transform.along_z, nz, phase.data(), scale, spectra_.data() + p * of_position,
                                    columns.data() + static_cast<std::size_t>(slot) * scratch);
        }
      });
  geometry_ = std::move(geometry);
  field_.resize(geometry_->field_size());
  scratch_.resize(geometry_->scratch * static_cast<std::size_t>(backend_.arena.threads()));
  given_ = Buffer<unsigned char>(static_cast<std::size_t>(simd::kPlasticComponents * nz));
}

void EigenstrainResponse::stress(const TensorView& strain, const TensorArrays& result) {
  check_tensor(strain, "strain");
  check_tensor(result, "result");
  const Geometry& g = *geometry_;
  const fft::LaneCarrier<double>& carrier = *g.carrier;
  const std::int64_t nz = box_.nz, nodes = box_.nx * box_.ny;
  const auto scratch_of = [&](int slot) { return scratch_.data() + static_cast<std::size_t>(slot) * g.scratch; };
  const auto field_of = [&](std::int64_t component, std::int64_t layer) {
    return field_.data() + (component * nz + layer) * g.transform.field_stride;
  };

  backend_.arena.for_chunks(simd::kPlasticComponents * nz, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    for (std::int64_t n = begin; n < end; ++n) {
      const int component = simd::kPlasticOrder[n / nz];
      const double* source = strain[static_cast<std::size_t>(component)] + n % nz * nodes;
      const bool any = std::any_of(source, source + nodes, [](double value) { return value != 0; });
      given_[static_cast<std::size_t>(n)] = any ? 1 : 0;
      if (any) carrier.rows_forward(0, box_.ny, source, field_of(component, n % nz), scratch_of(slot));
    }
  });
  if (std::none_of(given_.begin(), given_.end(), [](unsigned char any) { return any != 0; })) {
    for (double* component : result) std::fill_n(component, nodes * nz, 0.0);
    return;
  }
  const std::int64_t stride = carrier.rows().block_stride;
  backend_.arena.for_chunks(carrier.blocks(), 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    for (std::int64_t n = begin; n < end; ++n) {
      simd::ResidualBlock block{};
      for (int c = 0; c < 6; ++c) block.field[c] = field_of(c, 0) + n * stride;
      block.given = given_.data();
      block.spectra = spectra_.data() + n * g.values_of_block();
      backend_.kernels.eigenstrain.residual_block(g.transform, block, scratch_of(slot));
    }
  });
  backend_.arena.for_chunks(6 * nz, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    for (std::int64_t n = begin; n < end; ++n) {
      carrier.rows_backward(0, box_.ny, field_of(n / nz, n % nz),
                            result[static_cast<std::size_t>(n / nz)] + n % nz * nodes, scratch_of(slot));
    }
  });
}

}  // namespace brinell::plastic
