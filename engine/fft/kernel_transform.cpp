#include "fft/kernel_transform.h"

#include <algorithm>

#include "fft/plan_cache.h"
#include "parallel/arena.h"

namespace brinell::fft {

namespace {

/// The transform whose input is K_0, K_1 … for even kernels and K_1, K_2 … for odd ones.
Kind kind_of(Parity parity) {
  return parity == Parity::even ? Kind::cosines : Kind::sines;
}
std::int64_t first_offset(Parity parity) {
  return parity == Parity::even ? 0 : 1;
}

constexpr std::int64_t kRows = 8;  // per task, transposed together

}  // namespace

KernelTransform::KernelTransform(const Backend& backend, const double* kernel, std::int64_t nx, std::int64_t ny,
                                 std::int64_t n_x, std::int64_t n_y, Parity parity_x, Parity parity_y)
    : n_x_(n_x),
      n_y_(n_y),
      stride_((n_y + 7) / 8 * 8 + 8),
      mirror_x_(parity_x == Parity::even ? 1 : -1),
      mirror_y_(parity_y == Parity::even ? 1 : -1),
      values_(static_cast<std::size_t>(n_x * stride_)) {
  const auto along_x = backend.plans.transform<double>(kind_of(parity_x), n_x);
  const auto along_y = backend.plans.transform<double>(kind_of(parity_y), n_y);
  const std::int64_t skip_x = first_offset(parity_x);
  const std::int64_t skip_y = first_offset(parity_y);
  const double scale = 1.0 / (static_cast<double>(n_x) * static_cast<double>(n_y));

  // Rows are transformed and written transposed, so that the columns lie contiguous.
  const std::int64_t sequence = (std::max(n_x, n_y) + 7) / 8 * 8 + 8;
  const std::int64_t scratch_size = (kRows + 1) * sequence;
  Buffer<double> scratch(static_cast<std::size_t>(scratch_size * backend.arena.threads()));
  backend.arena.for_chunks(ny - skip_y, kRows, [&](std::int64_t begin, std::int64_t end, int slot) {
    double* row = scratch.data() + slot * scratch_size;
    double* transformed = row + sequence;
    for (std::int64_t j = begin; j < end; ++j) {
      const double* offsets = kernel + (j + skip_y) * nx;
      std::copy(offsets + skip_x, offsets + nx, row);
      std::fill(row + nx - skip_x, row + n_x, 0.0);
      along_x(row, transformed + (j - begin) * sequence);
    }
    for (std::int64_t k = 0; k < n_x; ++k) {
      for (std::int64_t j = begin; j < end; ++j) {
        values_[static_cast<std::size_t>(k * stride_ + j)] = scale * transformed[(j - begin) * sequence + k];
      }
    }
  });
  backend.arena.for_chunks(n_x, kRows, [&](std::int64_t begin, std::int64_t end, int slot) {
    double* column = scratch.data() + slot * scratch_size;
    for (std::int64_t k = begin; k < end; ++k) {
      double* values = values_.data() + k * stride_;
      std::copy(values, values + n_y, column);
      along_y(column, values);
    }
  });
}

}  // namespace brinell::fft
