// Approximate inverse of the compliance K restricted to the nodes in contact, applied once per iteration.
//
// Locally, M = half the square root of the discrete Laplacian, periodic on the unpadded grid, of symbol
//
//   m(kx, ky) = √( sin²(π kx/nx)/dx² + sin²(π ky/ny)/dy² )  ~  |q|/2,
//
// inverts K. The square root of a Laplacian has non-positive off-diagonal coefficients, which |q| sampled on a grid
// has not; that matters below. What M restricted to a ragged contact misses is the response on scales larger than the
// distance of contact spots: there K is far stiffer than the sum of its spots, and a few large eigenvalues of M K per
// such mode remain, more on every finer grid. They are taken out on cells of many nodes (B sums over the nodes of a
// cell): with S the compliance between cells, w = M·1 the conductance of each node in contact, D = Bᵀ w,
//
//   z = M r − w ∘ B (S⁻¹ + D)⁻¹ Bᵀ (w ∘ r).
//
// It stays positive definite: by Cauchy and Schwarz the second term is at most diag(w), and M − diag(M·1) is the
// Laplacian of a graph of non-negative weights.
#pragma once

#include <cstddef>
#include <memory>

#include "base/buffer.h"
#include "contact/passes.h"
#include "contact/problem.h"

namespace brinell::contact {

template <class Real>
class Preconditioner {
 public:
  /// workspace: of a convolution that takes turns with this one; enlarged if need be.
  Preconditioner(const Resources& resources, const Grid& grid, Boundary boundary, fft::Workspace<Real>& workspace);
  ~Preconditioner();

  /// To the nodes in contact as the passes know them; scratch: one field.
  void adapt(Passes<Real>& passes, Real* scratch);

  /// z = residual, zero out of contact, on entry.
  void apply(Real* z);

  /// The local part alone.
  void apply_local(Real* z) const { local_.apply(*spectrum_, z, z, workspace_); }

  /// Whether the large scales are treated; if not, they are left to the iteration.
  void treat_large_scales(bool treat) { large_scales_ = treat; }
  bool treats_large_scales() const { return large_scales_; }

  static std::size_t bytes(const fft::Backend& backend, const Grid& grid);

 private:
  struct CellSystem;
  void cell_compliance(const Resources& resources, Boundary boundary);
  template <class Body>
  void for_segments(const Body& body) const;

  const parallel::Arena& arena_;
  const simd::ContactKernels<Real>& kernels_;
  Grid grid_;
  fft::Convolution<Real> local_;
  std::shared_ptr<const fft::Spectrum<Real>> spectrum_;
  fft::Workspace<Real>& workspace_;

  std::int64_t cell_nx_, cell_ny_;  // nodes of a cell
  std::int64_t cells_x_, cells_y_;
  std::int64_t cells_;
  bool large_scales_ = true;
  Buffer<float> conductance_;  // w, one per node
  std::unique_ptr<CellSystem> system_;
};

}  // namespace brinell::contact
