#include "fft/convolution.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "fft/carrier.h"
#include "fft/fftw_carrier.h"
#include "fft/kernel_transform.h"
#include "fft/lane_carrier.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::fft {

namespace {

constexpr std::int64_t kLargestSide = std::int64_t{1} << 24;  // lengths and products stay far from overflow

/// Rows of one task: about 32k nodes, so that small grids are one task and large ones many.
std::int64_t rows_of_a_task(std::int64_t nx) {
  return std::max<std::int64_t>(1, 32768 / nx);
}

/// Frequency m of n stands for m − n in the second half, and for both signs in the middle.
double sign_of_frequency(std::int64_t m, std::int64_t n, Parity parity) {
  if (parity == Parity::even) return 1;
  if (m == 0 || 2 * m == n) return 0;
  return 2 * m < n ? 1 : -1;
}

/// Rows are spread over the whole field: with small pages every store would be another page's. A mere wish.
void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t page = 4096;
  const std::uintptr_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
  if (before < bytes) madvise(static_cast<char*>(memory) + before, (bytes - before) / page * page, MADV_HUGEPAGE);
#endif
}

}  // namespace

template <class Real>
struct Convolution<Real>::Implementation {
  Backend backend;
  std::int64_t nx, ny;
  Boundary boundary;
  std::unique_ptr<const Carrier<Real>> carrier;

  Spectrum<Real> arranged(Parity parity_x, Parity parity_y,
                          FunctionRef<double(std::int64_t, std::int64_t)> value) const {
    Spectrum<Real> spectrum{Buffer<Real>(carrier->spectrum_size()), parity_x, parity_y};
    backend.arena.for_chunks(carrier->blocks(), 1, [&](std::int64_t begin, std::int64_t end, int) {
      for (std::int64_t block = begin; block < end; ++block) carrier->arrange(block, value, spectrum.values.data());
    });
    return spectrum;
  }

  /// A kernel's quarter transformed as sources are.
  Spectrum<Real> transformed_kernel(const Real* kernel, Parity parity_x, Parity parity_y,
                                    Workspace<Real>& workspace) const {
    // Some rows at a time: a copy of the whole kernel would be as large as the spectrum.
    const std::int64_t rows = std::min(rows_of_a_task(nx), ny);
    const std::int64_t tile = (rows * nx + 7) / 8 * 8;
    Buffer<Real> tiles = Buffer<Real>::uninitialised(static_cast<std::size_t>(tile * backend.arena.threads()));
    backend.arena.for_chunks(ny, rows, [&](std::int64_t begin, std::int64_t end, int slot) {
      Real* quarter = tiles.data() + slot * tile;
      std::copy(kernel + begin * nx, kernel + end * nx, quarter);
      for (std::int64_t i = 0; parity_y == Parity::even && begin == 0 && i < nx; ++i) quarter[i] /= 2;
      for (std::int64_t j = 0; parity_x == Parity::even && j < end - begin; ++j) quarter[j * nx] /= 2;
      carrier->rows_forward(begin, end, quarter, workspace.field.data(), scratch_of(workspace, slot));
    });
    Spectrum<Real> spectrum{Buffer<Real>::uninitialised(carrier->spectrum_size()), parity_x, parity_y};
    for_blocks(workspace, [&](std::int64_t block, Real* scratch) {
      carrier->spectrum_block(block, parity_x, parity_y, workspace.field.data(), spectrum.values.data(), scratch);
    });
    return spectrum;
  }

  void check(const Spectrum<Real>& spectrum) const {
    if (spectrum.values.size() != carrier->spectrum_size()) {
      fail(Status::invalid_argument, "the spectrum was made for a convolution of another size");
    }
  }
  void check(const Workspace<Real>& workspace) const {
    if (workspace.field.size() < carrier->field_size() || workspace.scratch_size < carrier->scratch_size() ||
        workspace.scratch.size() < workspace.scratch_size * static_cast<std::size_t>(backend.arena.threads())) {
      fail(Status::invalid_argument,
           "the workspace was made for a convolution of another size or another number of threads");
    }
  }

  static Real* scratch_of(Workspace<Real>& workspace, int slot) {
    return workspace.scratch.data() + static_cast<std::size_t>(slot) * workspace.scratch_size;
  }

  void rows_forward(const Real* source, Workspace<Real>& workspace) const {
    backend.arena.for_chunks(ny, rows_of_a_task(nx), [&](std::int64_t begin, std::int64_t end, int slot) {
      carrier->rows_forward(begin, end, source + begin * nx, workspace.field.data(), scratch_of(workspace, slot));
    });
  }
  void rows_backward(Real* result, Workspace<Real>& workspace) const {
    backend.arena.for_chunks(ny, rows_of_a_task(nx), [&](std::int64_t begin, std::int64_t end, int slot) {
      carrier->rows_backward(begin, end, workspace.field.data(), result, scratch_of(workspace, slot));
    });
  }
  /// A small grid's columns are one task as its rows are.
  void for_blocks(Workspace<Real>& workspace, FunctionRef<void(std::int64_t block, Real* scratch)> body) const {
    const std::int64_t blocks = ny <= rows_of_a_task(nx) ? carrier->blocks() : 1;
    backend.arena.for_chunks(carrier->blocks(), blocks, [&](std::int64_t begin, std::int64_t end, int slot) {
      for (std::int64_t block = begin; block < end; ++block) body(block, scratch_of(workspace, slot));
    });
  }
};

template <class Real>
Convolution<Real>::Convolution(const Backend& backend, std::int64_t nx, std::int64_t ny, Boundary boundary,
                               Method method) {
  if (nx < 1 || ny < 1 || nx > kLargestSide || ny > kLargestSide) {
    fail(Status::invalid_argument, "convolution of " + std::to_string(nx) + " x " + std::to_string(ny) +
                                       " nodes: each side must be within 1 .. " + std::to_string(kLargestSide));
  }
  std::unique_ptr<const Carrier<Real>> carrier;
  if (method != Method::fftw) {
    const simd::TransformKernels<Real>& kernels = backend.kernels.template of<Real>().transform;
    carrier = lane_carrier<Real>(kernels, nx, ny, boundary, method == Method::automatic);
    if (carrier == nullptr && method == Method::lanes) {
      fail(Status::unsupported, "the lane transform has no periodic size " + std::to_string(nx) + " x " +
                                    std::to_string(ny) + ": nx must be " + std::to_string(kernels.lanes) +
                                    "·2^a·3^b·5^c, ny 2^a·3^b·5^c");
    }
  }
  if (carrier == nullptr) carrier = fftw_carrier<Real>(backend.plans, nx, ny, boundary);
  implementation_ =
      std::make_unique<const Implementation>(Implementation{backend, nx, ny, boundary, std::move(carrier)});
}

template <class Real>
Convolution<Real>::~Convolution() = default;

template <class Real>
Method Convolution<Real>::method() const {
  return implementation_->carrier->method();
}

template <class Real>
std::int64_t Convolution<Real>::padded_nx() const {
  return implementation_->carrier->padded_nx();
}

template <class Real>
std::int64_t Convolution<Real>::padded_ny() const {
  return implementation_->carrier->padded_ny();
}

template <class Real>
std::size_t Convolution<Real>::spectrum_bytes() const {
  return Buffer<Real>::padded_bytes(implementation_->carrier->spectrum_size());
}

template <class Real>
std::size_t Convolution<Real>::workspace_bytes() const {
  const Implementation& my = *implementation_;
  const auto threads = static_cast<std::size_t>(my.backend.arena.threads());
  return Buffer<Real>::padded_bytes(my.carrier->field_size()) +
         Buffer<Real>::padded_bytes(my.carrier->scratch_size() * threads);
}

template <class Real>
Spectrum<Real> Convolution<Real>::spectrum(const double* kernel, Parity parity_x, Parity parity_y,
                                           Workspace<Real>* workspace) const {
  const Implementation& my = *implementation_;
  if (my.boundary != Boundary::free) {
    fail(Status::wrong_state, "a kernel in space is for a free boundary; this convolution is periodic");
  }
  if constexpr (std::is_same_v<Real, double>) {
    if (my.carrier->transforms_kernels()) {
      std::unique_ptr<Workspace<Real>> own;
      if (workspace == nullptr) {
        own = this->workspace();
        workspace = own.get();
      }
      my.check(*workspace);
      return my.transformed_kernel(kernel, parity_x, parity_y, *workspace);
    }
  }
  const KernelTransform transform(my.backend, kernel, my.nx, my.ny, my.carrier->padded_nx() / 2,
                                  my.carrier->padded_ny() / 2, parity_x, parity_y);
  return my.arranged(parity_x, parity_y, transform);
}

template <class Real>
Spectrum<Real> Convolution<Real>::spectrum_of_symbol(FunctionRef<double(std::int64_t kx, std::int64_t ky)> symbol,
                                                     Parity parity_x, Parity parity_y) const {
  const Implementation& my = *implementation_;
  if (my.boundary != Boundary::periodic) {
    fail(Status::wrong_state, "a symbol is for a periodic boundary; this convolution is free");
  }
  const bool both_odd = parity_x == Parity::odd && parity_y == Parity::odd;
  const double scale = (both_odd ? -1.0 : 1.0) / (static_cast<double>(my.nx) * static_cast<double>(my.ny));
  return my.arranged(parity_x, parity_y, [&](std::int64_t mx, std::int64_t my_) {
    const double sign = sign_of_frequency(mx, my.nx, parity_x) * sign_of_frequency(my_, my.ny, parity_y);
    return sign == 0 ? 0.0 : sign * scale * symbol(std::min(mx, my.nx - mx), std::min(my_, my.ny - my_));
  });
}

template <class Real>
std::unique_ptr<Workspace<Real>> Convolution<Real>::workspace() const {
  auto workspace = std::make_unique<Workspace<Real>>();
  enlarge(*workspace);
  return workspace;
}

template <class Real>
void Convolution<Real>::enlarge(Workspace<Real>& workspace) const {
  const Implementation& my = *implementation_;
  if (workspace.field.size() < my.carrier->field_size()) {
    workspace.field = {};
    workspace.field = Buffer<Real>::uninitialised(my.carrier->field_size());
    prefer_large_pages(workspace.field.data(), workspace.field.bytes());
    std::fill(workspace.field.begin(), workspace.field.end(), Real{0});
  }
  workspace.scratch_size = std::max(workspace.scratch_size, my.carrier->scratch_size());
  const std::size_t scratch = workspace.scratch_size * static_cast<std::size_t>(my.backend.arena.threads());
  if (workspace.scratch.size() < scratch) workspace.scratch = Buffer<Real>(scratch);
}

template <class Real>
std::size_t Convolution<Real>::transform_bytes() const {
  return Buffer<Real>::padded_bytes(implementation_->carrier->transform_size());
}

template <class Real>
void Convolution<Real>::apply(const Spectrum<Real>& spectrum, const Real* source, Real* result,
                              Workspace<Real>& workspace) const {
  const Implementation& my = *implementation_;
  my.check(spectrum);
  my.check(workspace);
  my.rows_forward(source, workspace);
  my.for_blocks(workspace, [&](std::int64_t block, Real* scratch) {
    my.carrier->convolve_block(block, spectrum, workspace.field.data(), scratch);
  });
  my.rows_backward(result, workspace);
}

template <class Real>
SourceTransform<Real> Convolution<Real>::transform(const Real* source, Workspace<Real>& workspace) const {
  const Implementation& my = *implementation_;
  my.check(workspace);
  SourceTransform<Real> transform{Buffer<Real>::uninitialised(my.carrier->transform_size())};
  my.rows_forward(source, workspace);
  my.for_blocks(workspace, [&](std::int64_t block, Real* scratch) {
    my.carrier->transform_block(block, workspace.field.data(), transform.values.data(), scratch);
  });
  return transform;
}

template <class Real>
void Convolution<Real>::apply(std::span<const Term<Real>> terms, Real* result, Workspace<Real>& workspace) const {
  const Implementation& my = *implementation_;
  if (terms.empty()) fail(Status::invalid_argument, "a sum of convolutions needs at least one term, not 0");
  for (const Term<Real>& term : terms) {
    my.check(*term.spectrum);
    if (term.source->values.size() != my.carrier->transform_size()) {
      fail(Status::invalid_argument, "the transformed source was made for a convolution of another size");
    }
  }
  my.check(workspace);
  my.for_blocks(workspace, [&](std::int64_t block, Real* scratch) {
    my.carrier->sum_block(block, terms, workspace.field.data(), scratch);
  });
  my.rows_backward(result, workspace);
}

template class Convolution<double>;
template class Convolution<float>;

}  // namespace brinell::fft
