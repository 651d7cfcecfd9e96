#include "plastic/eigenstrain_displacement.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "fft/lane_carrier.h"
#include "influence/eigenstrain.h"
#include "parallel/arena.h"
#include "plastic/box_checks.h"
#include "simd/kernel_table.h"

namespace brinell::plastic {

namespace {

constexpr int kColumns = simd::kPlasticComponents;

/// Layers are worked on in groups whose fields take about so many bytes.
constexpr std::size_t kGroupBytes = std::size_t{32} << 20;

Box whole_box(const Grid& grid, std::int64_t layers, double dz) {
  return {grid.nx, grid.ny, layers, grid.dx, grid.dy, dz};
}

}  // namespace

struct EigenstrainDisplacement::Geometry {
  Geometry(const fft::Backend& backend, const Box& box)
      : carrier(
            fft::lane_carrier<double>(backend.kernels.in_double.transform, box.nx, box.ny, Boundary::free, false)),
        lanes(backend.kernels.in_double.transform.lanes) {
    const std::size_t of_layer = kColumns * carrier->field_size() * sizeof(double);
    group =
        std::min<std::int64_t>(box.nz, std::max<std::int64_t>(1, static_cast<std::int64_t>(kGroupBytes / of_layer)));
    const std::size_t rows = static_cast<std::size_t>(box.nx * box.ny);
    const std::size_t columns = static_cast<std::size_t>(2 * lanes * (box.ny + 2 * carrier->columns().tree.length));
    scratch = (std::max(carrier->scratch_size() + rows, columns) + 15) / 8 * 8;
  }

  std::int64_t transform_of_block() const { return 4 * lanes * carrier->columns().tree.length; }
  std::size_t spectra_size() const { return kColumns * carrier->spectrum_size(); }  // of a layer
  std::size_t fields_size() const { return static_cast<std::size_t>(group * kColumns) * carrier->field_size(); }
  std::size_t generation_size(const Box& box) const {
    const std::size_t layer = static_cast<std::size_t>(simd::kSurfacePotentials * box.nx * box.ny);
    return (layer + carrier->field_size() + carrier->scratch_size() + 24) / 8 * 8;
  }

  std::unique_ptr<const fft::LaneCarrier<double>> carrier;
  std::int64_t lanes;
  std::int64_t group;   // layers at a time
  std::size_t scratch;  // of one thread, in doubles
};

EigenstrainDisplacement::EigenstrainDisplacement(const fft::Backend& backend, const Grid& grid, std::int64_t layers,
                                                 double dz, double poissons_ratio)
    : backend_(backend), grid_(grid), dz_(dz), poissons_ratio_(poissons_ratio) {
  deepen(layers);
}

void EigenstrainDisplacement::deepen(std::int64_t layers) {
  const Box box = whole_box(grid_, layers, dz_);
  check_box(box);
  if (layers <= this->layers()) return;
  geometry_ = std::make_unique<const Geometry>(backend_, box);
  generate(layers);
  const fft::LaneCarrier<double>& carrier = *geometry_->carrier;
  fields_.resize(geometry_->fields_size());
  sum_.resize(static_cast<std::size_t>(carrier.blocks() * geometry_->transform_of_block()));
  scratch_.resize(geometry_->scratch * static_cast<std::size_t>(backend_.arena.threads()));
}

EigenstrainDisplacement::~EigenstrainDisplacement() = default;

EigenstrainResponse::Bytes EigenstrainDisplacement::bytes(const fft::Backend& backend, const Grid& grid,
                                                          std::int64_t layers, double dz) {
  const Box box = whole_box(grid, layers, dz);
  check_box(box);
  const Geometry geometry(backend, box);
  const auto threads = static_cast<std::size_t>(backend.arena.threads());
  const auto sum = static_cast<std::size_t>(geometry.carrier->blocks() * geometry.transform_of_block());
  return {static_cast<std::size_t>(layers) * Buffer<double>::padded_bytes(geometry.spectra_size()),
          Buffer<double>::padded_bytes(geometry.fields_size()) + Buffer<double>::padded_bytes(sum) +
              Buffer<double>::padded_bytes(geometry.scratch * threads),
          Buffer<double>::padded_bytes(geometry.generation_size(box) * threads)};
}

/// The spectra of layers that are not there yet.
void EigenstrainDisplacement::generate(std::int64_t layers) {
  const influence::Eigenstrain cuboid(grid_.dx, grid_.dy, dz_, poissons_ratio_);
  const Geometry& g = *geometry_;
  const fft::LaneCarrier<double>& carrier = *g.carrier;
  const std::int64_t nx = grid_.nx, ny = grid_.ny, nodes = nx * ny;
  const std::size_t part = g.generation_size(whole_box(grid_, layers, dz_));
  Buffer<double> memory = Buffer<double>::uninitialised(part * static_cast<std::size_t>(backend_.arena.threads()));
  const std::int64_t first = this->layers();
  std::vector<Buffer<double>> more(static_cast<std::size_t>(layers - first));
  backend_.arena.for_chunks(layers - first, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
    double* quarters = memory.data() + static_cast<std::size_t>(slot) * part;
    double* field = quarters + (static_cast<std::size_t>(simd::kSurfacePotentials * nodes) + 7) / 8 * 8;
    double* scratch = field + carrier.field_size();
    for (std::int64_t layer = begin; layer < end; ++layer) {
      Buffer<double>& spectra = more[static_cast<std::size_t>(layer)];
      spectra = Buffer<double>::uninitialised(g.spectra_size());
      cuboid.fill_displacement(backend_.kernels.eigenstrain, (static_cast<double>(first + layer) + 0.5) * dz_, nx, ny,
                               quarters);
      for (int column = 0; column < kColumns; ++column) {
        const int component = simd::kPlasticOrder[column];
        const influence::Parities parity = influence::surface_parities(component);
        double* quarter = quarters + component * nodes;
        for (std::int64_t n = 0; component < 2 && n < nodes; ++n) quarter[n] -= quarters[2 * nodes + n];
        for (std::int64_t i = 0; parity.y == fft::Parity::even && i < nx; ++i) quarter[i] *= 0.5;
        for (std::int64_t j = 0; parity.x == fft::Parity::even && j < ny; ++j) quarter[j * nx] *= 0.5;
        carrier.rows_forward(0, ny, quarter, field, scratch);
        double* spectrum = spectra.data() + column * static_cast<std::int64_t>(carrier.spectrum_size());
        for (std::int64_t block = 0; block < carrier.blocks(); ++block) {
          carrier.spectrum_block(block, parity.x, parity.y, field, spectrum, scratch);
        }
      }
    }
  });
  spectra_.insert(spectra_.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void EigenstrainDisplacement::displacement(const TensorView& strain, const Box& box, std::int64_t first_x,
                                           std::int64_t first_y, double* result) {
  check_tensor(strain, "strain");
  check_box(box);
  if (result == nullptr) fail(Status::invalid_argument, "result: is null");
  if (box.dx != grid_.dx || box.dy != grid_.dy || box.dz != dz_ || box.nz > layers()) {
    fail(Status::invalid_argument, "a box of " + std::to_string(box.nz) + " layers of cuboids " + text(box.dx) +
                                       " x " + text(box.dy) + " x " + text(box.dz) + ": must be at most " +
                                       std::to_string(layers()) + " of " + text(grid_.dx) + " x " + text(grid_.dy) +
                                       " x " + text(dz_));
  }
  if (first_x < 0 || first_y < 0 || first_x > grid_.nx - box.nx || first_y > grid_.ny - box.ny) {
    fail(Status::invalid_argument, "a box of " + std::to_string(box.nx) + " x " + std::to_string(box.ny) +
                                       " cuboids from node (" + std::to_string(first_x) + ", " +
                                       std::to_string(first_y) + ") on: must be below the grid's " +
                                       std::to_string(grid_.nx) + " x " + std::to_string(grid_.ny) + " nodes");
  }
  const Geometry& g = *geometry_;
  const fft::LaneCarrier<double>& carrier = *g.carrier;
  const auto field_size = static_cast<std::int64_t>(carrier.field_size());
  const auto spectrum_size = static_cast<std::int64_t>(carrier.spectrum_size());
  const std::int64_t of_block = g.transform_of_block(), stride = carrier.rows().block_stride;
  const std::int64_t spectrum_of_block = carrier.columns().tree.length * g.lanes;
  const auto scratch_of = [&](int slot) { return scratch_.data() + static_cast<std::size_t>(slot) * g.scratch; };

  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::vector<unsigned char> given(static_cast<std::size_t>(g.group * kColumns));
  for (std::int64_t from = 0; from < box.nz; from += g.group) {
    const std::int64_t some = std::min(g.group, box.nz - from) * kColumns;
    backend_.arena.for_chunks(some, 1, [&](std::int64_t begin, std::int64_t end, int slot) {
      double* scratch = scratch_of(slot);
      double* rows = scratch + (carrier.scratch_size() + 7) / 8 * 8;
      for (std::int64_t n = begin; n < end; ++n) {
        const auto component = static_cast<std::size_t>(simd::kPlasticOrder[n % kColumns]);
        const double* source = strain[component] + (from + n / kColumns) * box.nx * box.ny;
        const bool any = std::any_of(source, source + box.nx * box.ny, [](double value) { return value != 0; });
        given[static_cast<std::size_t>(n)] = any ? 1 : 0;
        if (!any) continue;
        std::fill_n(rows, grid_.nx * box.ny, 0.0);
        for (std::int64_t j = 0; j < box.ny; ++j) {
          std::copy_n(source + j * box.nx, box.nx, rows + j * grid_.nx + first_x);
        }
        carrier.rows_forward(0, box.ny, rows, fields_.data() + n * field_size, scratch);
      }
    });
    backend_.arena.for_chunks(carrier.blocks(), 1, [&](std::int64_t begin, std::int64_t end, int slot) {
      for (std::int64_t block = begin; block < end; ++block) {
        for (std::int64_t n = 0; n < some; ++n) {
          if (given[static_cast<std::size_t>(n)] == 0) continue;
          const influence::Parities parity = influence::surface_parities(simd::kPlasticOrder[n % kColumns]);
          backend_.kernels.eigenstrain.accumulate_rows(
              carrier.columns(), fields_.data() + n * field_size + block * stride, first_y, box.ny,
              spectra_[static_cast<std::size_t>(from + n / kColumns)].data() + n % kColumns * spectrum_size +
                  block * spectrum_of_block,
              parity.x == fft::Parity::odd, parity.y == fft::Parity::odd, sum_.data() + block * of_block,
              scratch_of(slot));
        }
      }
    });
  }
  backend_.arena.for_chunks(carrier.blocks(), 1, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t block = begin; block < end; ++block) {
      backend_.kernels.eigenstrain.backward_columns(carrier.columns(), sum_.data() + block * of_block,
                                                    fields_.data() + block * stride);
    }
  });
  constexpr std::int64_t kRows = 16;
  backend_.arena.for_chunks(grid_.ny, kRows, [&](std::int64_t begin, std::int64_t end, int slot) {
    carrier.rows_backward(begin, end, fields_.data(), result, scratch_of(slot));
  });
}

}  // namespace brinell::plastic
