#include "contact/preconditioner.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "influence/displacement.h"
#include "influence/spectra.h"

namespace brinell::contact {

namespace {

constexpr std::int64_t kMostCells = 16;   // per direction: factorising 256 unknowns costs less than one transform
constexpr std::int64_t kFewestNodes = 8;  // of a cell, per direction

std::int64_t cell_size(std::int64_t nodes) {
  const std::int64_t cells = std::clamp<std::int64_t>(nodes / kFewestNodes, 1, kMostCells);
  return (nodes + cells - 1) / cells;
}

}  // namespace

template <class Real>
struct Preconditioner<Real>::CellSystem {
  Eigen::MatrixXd compliance;           // S
  Eigen::VectorXd inverse_root;         // D^(-1/2), 0 for cells without contact
  Eigen::LLT<Eigen::MatrixXd> factors;  // of 1 + D^(1/2) S D^(1/2)
};

template <class Real>
Preconditioner<Real>::Preconditioner(const Resources& resources, const Grid& grid, Boundary boundary,
                                     fft::Workspace<Real>& workspace)
    : arena_(resources.backend.arena),
      kernels_(resources.backend.kernels.of<Real>().contact),
      grid_(grid),
      local_(resources.backend, grid.nx, grid.ny, Boundary::periodic),
      spectrum_(influence::conductance_spectrum(resources.spectra, local_, grid)),
      workspace_(workspace),
      cell_nx_(cell_size(grid.nx)),
      cell_ny_(cell_size(grid.ny)),
      cells_x_((grid.nx + cell_nx_ - 1) / cell_nx_),
      cells_y_((grid.ny + cell_ny_ - 1) / cell_ny_),
      cells_(cells_x_ * cells_y_),
      conductance_(grid.nodes()),
      system_(std::make_unique<CellSystem>()) {
  local_.enlarge(workspace_);
  cell_compliance(resources, boundary);
}

template <class Real>
Preconditioner<Real>::~Preconditioner() = default;

/// S(I, J): mean displacement of cell I under a unit pressure on one node, spread over cell J.
template <class Real>
void Preconditioner<Real>::cell_compliance(const Resources& resources, Boundary boundary) {
  const double nodes = static_cast<double>(cell_nx_ * cell_ny_);
  const Grid coarse{cells_x_, cells_y_, static_cast<double>(cell_nx_) * grid_.dx,
                    static_cast<double>(cell_ny_) * grid_.dy};
  Buffer<double> response(coarse.nodes());
  if (boundary == Boundary::periodic) {
    const fft::Convolution<double> convolution(resources.backend, coarse.nx, coarse.ny, Boundary::periodic);
    const auto spectrum = influence::displacement_spectrum(resources.spectra, resources.backend, convolution, coarse,
                                                           Boundary::periodic);
    response[0] = 1;
    convolution.apply(*spectrum, response.data(), response.data(), *convolution.workspace());
  } else {
    influence::Displacement(coarse.dx, coarse.dy)
        .fill(arena_, resources.backend.kernels, coarse.nx, coarse.ny, response.data());
  }
  system_->compliance.resize(cells_, cells_);
  for (std::int64_t a = 0; a < cells_; ++a) {
    for (std::int64_t b = 0; b < cells_; ++b) {
      const std::int64_t i = std::abs(a % cells_x_ - b % cells_x_);
      const std::int64_t j = std::abs(a / cells_x_ - b / cells_x_);
      system_->compliance(a, b) = response[static_cast<std::size_t>(j * cells_x_ + i)] / nodes;
    }
  }
}

/// body(cell, first node, number of nodes) for every part of a row that lies in one cell; one thread for each row of
/// cells.
template <class Real>
template <class Body>
void Preconditioner<Real>::for_segments(const Body& body) const {
  arena_.for_chunks(cells_y_, 1, [&](std::int64_t row, std::int64_t, int) {
    const std::int64_t last = std::min((row + 1) * cell_ny_, grid_.ny);
    for (std::int64_t j = row * cell_ny_; j < last; ++j) {
      for (std::int64_t column = 0; column < cells_x_; ++column) {
        const std::int64_t i = column * cell_nx_;
        body(row * cells_x_ + column, j * grid_.nx + i, static_cast<std::size_t>(std::min(cell_nx_, grid_.nx - i)));
      }
    }
  });
}

template <class Real>
void Preconditioner<Real>::adapt(Passes<Real>& passes, Real* scratch) {
  if (!large_scales_) return;
  passes.indicator(scratch);
  apply_local(scratch);
  passes.conductance(scratch, conductance_.data());

  Eigen::VectorXd root = Eigen::VectorXd::Zero(cells_);
  for_segments([&](std::int64_t cell, std::int64_t first, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      root[cell] += static_cast<double>(conductance_[static_cast<std::size_t>(first) + i]);
    }
  });
  root = root.cwiseSqrt();
  system_->inverse_root = (root.array() > 0).select(root.cwiseInverse(), 0.0);
  Eigen::MatrixXd matrix = root.asDiagonal() * system_->compliance * root.asDiagonal();
  matrix.diagonal().array() += 1;
  system_->factors.compute(matrix);
  if (system_->factors.info() != Eigen::Success) treat_large_scales(false);
}

template <class Real>
void Preconditioner<Real>::apply(Real* z) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(cells_);
  if (large_scales_) {
    for_segments([&](std::int64_t cell, std::int64_t first, std::size_t n) {
      sums[cell] += kernels_.weigh(n, conductance_.data() + first, z + first);
    });
    // (S⁻¹ + D)⁻¹ = D^(-1/2) (1 − (1 + D^(1/2) S D^(1/2))⁻¹) D^(-1/2)
    sums.array() *= system_->inverse_root.array();
    sums -= system_->factors.solve(sums).eval();
    sums.array() *= system_->inverse_root.array();
  }
  apply_local(z);
  if (large_scales_) {
    for_segments([&](std::int64_t cell, std::int64_t first, std::size_t n) {
      if (sums[cell] != 0) kernels_.relax(n, sums[cell], conductance_.data() + first, z + first);
    });
  }
}

template <class Real>
std::size_t Preconditioner<Real>::bytes(const fft::Backend& backend, const Grid& grid) {
  const fft::Convolution<Real> local(backend, grid.nx, grid.ny, Boundary::periodic);
  const std::size_t cells = static_cast<std::size_t>(kMostCells * kMostCells);
  return local.spectrum_bytes() + Buffer<float>::padded_bytes(grid.nodes()) + 3 * cells * cells * sizeof(double);
}

template class Preconditioner<double>;
template class Preconditioner<float>;

}  // namespace brinell::contact
