// Convolution of a surface field with a kernel of influence coefficients,
//
//   result(i, j) = Σ_{k,l} K(i − k, j − l) · source(k, l),
//
// by FFT: zero-padded on a free boundary (the sum is over the grid), circular on a periodic one. Kernels are even
// or odd in x and in y, so only a quarter of each is ever stored, in space and in frequency, and every spectrum is a
// real array up to a factor i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/buffer.h"
#include "base/function_ref.h"
#include "base/grid.h"

namespace brinell::parallel {
class Arena;
}
namespace brinell::simd {
struct KernelTable;
}

namespace brinell::fft {

class PlanCache;

/// What transforms run on; shared by everything in one engine, all members outlive their users.
struct Backend {
  const parallel::Arena& arena;
  const simd::KernelTable& kernels;
  PlanCache& plans;
};

enum class Parity : std::int32_t { even = 0, odd = 1 };

/// Which transform carries a convolution. automatic: the faster one for the size.
enum class Method : std::int32_t { automatic = 0, lanes = 1, fftw = 2 };

/// The spectrum of one kernel, ready for the Convolution that made it, and for every other of equal geometry, method
/// and instruction set.
/// Immutable: may be shared between threads.
template <class Real>
struct Spectrum {
  Buffer<Real> values;  // layout: private to the Convolution; depends on its method and instruction set
  Parity parity_x = Parity::even;
  Parity parity_y = Parity::even;
};

/// Scratch of one convolution at a time; reused by every following one. Nothing in it lasts from one to the next:
/// between them its memory is free for other use.
template <class Real>
struct Workspace {
  Buffer<Real> field;            // the transformed rows; layout: private to the Convolution
  Buffer<Real> scratch;          // one part for each thread
  std::size_t scratch_size = 0;  // of one part, in Reals
};

/// A source in frequency space, to be convolved with many kernels; made by Convolution::transform.
template <class Real>
struct SourceTransform {
  Buffer<Real> values;  // layout: private to the Convolution
};

/// kernel * source, with both transformed.
template <class Real>
struct Term {
  const SourceTransform<Real>* source;
  const Spectrum<Real>* spectrum;
};

template <class Real>
class Convolution {
 public:
  /// Throws Status::unsupported if `method` cannot carry this size.
  Convolution(const Backend& backend, std::int64_t nx, std::int64_t ny, Boundary boundary,
              Method method = Method::automatic);
  ~Convolution();
  Convolution(const Convolution&) = delete;
  Convolution& operator=(const Convolution&) = delete;

  Method method() const;           // never automatic
  std::int64_t padded_nx() const;  // length of the cyclic convolution that is carried out
  std::int64_t padded_ny() const;
  std::size_t spectrum_bytes() const;   // of one Spectrum
  std::size_t workspace_bytes() const;  // of one Workspace

  /// Spectrum of the kernel whose values at offsets (i, j), 0 <= i < nx, 0 <= j < ny, are kernel[j·nx + i];
  /// negative offsets follow from the parities. Free boundary only. The workspace, if there is one, spares memory.
  Spectrum<Real> spectrum(const double* kernel, Parity parity_x, Parity parity_y,
                          Workspace<Real>* workspace = nullptr) const;

  /// Spectrum given by its own values: symbol(kx, ky) for wave numbers 0 <= kx <= nx/2, 0 <= ky <= ny/2 (cycles per
  /// period); result = Σ_q s(q) source^(q) e^{iqx} with s(q) = symbol(|qx|, |qy|), along an odd axis times −i sign(q)
  /// and zero at the Nyquist wave number, which stands for both signs. Periodic boundary only.
  Spectrum<Real> spectrum_of_symbol(FunctionRef<double(std::int64_t kx, std::int64_t ky)> symbol,
                                    Parity parity_x = Parity::even, Parity parity_y = Parity::even) const;

  std::unique_ptr<Workspace<Real>> workspace() const;

  /// Makes a workspace of another convolution serve this one as well: convolutions that take turns share one.
  void enlarge(Workspace<Real>& workspace) const;

  /// source and result: nx·ny values, row-major; they may be the same array. Threads of the arena share the work;
  /// the bits do not depend on their number.
  void apply(const Spectrum<Real>& spectrum, const Real* source, Real* result, Workspace<Real>& workspace) const;

  /// apply in two halves, for several kernels on one source or sums over several sources: every source is transformed
  /// once, and result = Σ_t kernel_t * source_t costs one transform however many terms there are (at least one).
  SourceTransform<Real> transform(const Real* source, Workspace<Real>& workspace) const;
  void apply(std::span<const Term<Real>> terms, Real* result, Workspace<Real>& workspace) const;
  std::size_t transform_bytes() const;  // of one SourceTransform

 private:
  struct Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace brinell::fft
