// The preconditioner as a dense matrix: symmetric and positive definite on any set of nodes in contact, as conjugate
// gradients ask.
#include "contact/preconditioner.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "influence/displacement.h"
#include "support/workbench.h"

namespace brinell::contact {
namespace {

using Nodes = std::vector<Eigen::Index>;

std::vector<double> random_contact(const Grid& grid, double part, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> p(grid.nodes(), 0.0);
  for (double& pressure : p) {
    if (static_cast<double>(random()) * 0x1p-32 < part) pressure = 0.01 + static_cast<double>(random()) * 0x1p-32;
  }
  p[grid.nodes() / 2] = 1;
  return p;
}

Nodes nodes_of(const std::vector<double>& p) {
  Nodes nodes;
  for (std::size_t n = 0; n < p.size(); ++n) {
    if (p[n] > 0) nodes.push_back(static_cast<Eigen::Index>(n));
  }
  return nodes;
}

/// Its columns are what it answers to a unit residual on each node in contact.
template <class Real>
Eigen::MatrixXd matrix_of(Preconditioner<Real>& preconditioner, const Nodes& nodes, std::size_t size) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index column = 0; column < count; ++column) {
    Buffer<Real> z(size);
    z[static_cast<std::size_t>(nodes[static_cast<std::size_t>(column)])] = 1;
    preconditioner.apply(z.data());
    for (Eigen::Index row = 0; row < count; ++row) {
      matrix(row, column) = static_cast<double>(z[static_cast<std::size_t>(nodes[static_cast<std::size_t>(row)])]);
    }
  }
  return matrix;
}

/// Where p > 0.
template <class Real>
void put_in_contact(Passes<Real>& passes, const std::vector<double>& p, Buffer<Real>& scratch) {
  const Buffer<double> no_gap(p.size());
  passes.open_contact();
  passes.residual({}, 0, 0, p.data(), no_gap.data(), scratch.data());
}

template <class Real>
class PreconditionerIn : public testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(PreconditionerIn, Precisions);

TYPED_TEST(PreconditionerIn, is_symmetric_and_positive_definite) {
  using Real = TypeParam;
  const support::Workbench bench;
  for (const Grid grid : {Grid{1, 1, 1, 1}, Grid{12, 11, 1, 1}, Grid{40, 23, 1, 0.3}, Grid{37, 1, 1, 1},
                          Grid{1, 64, 1, 2}, Grid{33, 34, 1, 1}}) {
    for (const Boundary boundary : {Boundary::free, Boundary::periodic}) {
      for (const double part : {0.02, 0.2, 0.6, 1.0}) {
        if (part * static_cast<double>(grid.nodes()) > 500) continue;
        const std::vector<double> p = random_contact(grid, part, 7);
        const Nodes nodes = nodes_of(p);
        fft::Workspace<Real> workspace;
        Preconditioner<Real> preconditioner(bench.resources, grid, boundary, workspace);
        Passes<Real> passes(bench.arena, bench.resources.backend.kernels, PlacedGrid::centred(grid));
        Buffer<Real> scratch(grid.nodes());
        for (const bool large_scales : {true, false}) {
          preconditioner.treat_large_scales(large_scales);
          put_in_contact(passes, p, scratch);
          preconditioner.adapt(passes, scratch.data());
          const Eigen::MatrixXd matrix = matrix_of(preconditioner, nodes, grid.nodes());
          const double largest = matrix.cwiseAbs().maxCoeff();
          // Transforms of a few hundred points, each way: some tens of roundings of the largest coefficient.
          const double round_off = 50 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * largest;
          EXPECT_LE((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), round_off);
          const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (matrix + matrix.transpose()),
                                                                     Eigen::EigenvaluesOnly);
          EXPECT_GT(eigen.eigenvalues().minCoeff(), 0)
              << grid.nx << " x " << grid.ny << ", " << nodes.size() << " nodes, " << static_cast<int>(boundary);
        }
      }
    }
  }
}

// What it is for. Conjugate gradients need about √condition/2 iterations per e-folding of the error; the compliance
// by itself has conditions of 3 to 21 here, and more on larger grids. With it: 1.7, 2.4, 2.9.
TEST(Preconditioner, times_the_compliance_is_well_conditioned) {
  const support::Workbench bench;
  const Grid grid{33, 34, 1, 1};
  const influence::Displacement displacement(1, 1);
  for (const double part : {0.05, 0.2, 0.4}) {
    const std::vector<double> p = random_contact(grid, part, 3);
    const Nodes nodes = nodes_of(p);
    fft::Workspace<double> workspace;
    Preconditioner<double> preconditioner(bench.resources, grid, Boundary::free, workspace);
    Passes<double> passes(bench.arena, bench.resources.backend.kernels, PlacedGrid::centred(grid));
    Buffer<double> scratch(grid.nodes());
    put_in_contact(passes, p, scratch);
    preconditioner.adapt(passes, scratch.data());
    const Eigen::MatrixXd inverse = matrix_of(preconditioner, nodes, grid.nodes());
    const auto count = static_cast<Eigen::Index>(nodes.size());
    Eigen::MatrixXd compliance(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index m = nodes[static_cast<std::size_t>(a)], n = nodes[static_cast<std::size_t>(b)];
        compliance(a, b) = displacement(m % grid.nx - n % grid.nx, m / grid.nx - n / grid.nx);
      }
    }
    // M K has the eigenvalues of Lᵀ K L, M = L Lᵀ.
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(0.5 * (inverse + inverse.transpose())).matrixL();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> together(root.transpose() * compliance * root,
                                                                  Eigen::EigenvaluesOnly);
    EXPECT_LT(together.eigenvalues().maxCoeff(), 4 * together.eigenvalues().minCoeff()) << part;
  }
}

}  // namespace
}  // namespace brinell::contact
