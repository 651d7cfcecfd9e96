// The convolution as textbooks have it, to compare with: the source padded with zeros to 2nx × 2ny, FFTW's r2c of
// the whole, the product with the stored spectrum, c2r; in place, planned by measure. Periodic: the same unpadded.
#pragma once

#include <fftw3.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>

#include "base/function_ref.h"
#include "base/grid.h"

namespace brinell::bench {

template <class Real>
class TextbookConvolution {
  static constexpr bool kDouble = std::is_same_v<Real, double>;
  using Plan = std::conditional_t<kDouble, fftw_plan, fftwf_plan>;
  using Complex = std::conditional_t<kDouble, fftw_complex, fftwf_complex>;

 public:
  /// Until another is set, the spectrum is that of a smooth even kernel of no meaning.
  TextbookConvolution(std::int64_t nx, std::int64_t ny, Boundary boundary)
      : nx_(nx),
        ny_(ny),
        padded_nx_(boundary == Boundary::free ? 2 * nx : nx),
        padded_ny_(boundary == Boundary::free ? 2 * ny : ny),
        columns_(padded_nx_ / 2 + 1),
        field_(allocate(2 * columns_ * padded_ny_)),
        spectrum_(allocate(columns_ * padded_ny_)) {
    const int rows = static_cast<int>(padded_ny_);
    const int row = static_cast<int>(padded_nx_);
    auto* numbers = reinterpret_cast<Complex*>(field_.get());
    if constexpr (kDouble) {
      forward_ = fftw_plan_dft_r2c_2d(rows, row, field_.get(), numbers, FFTW_MEASURE);
      backward_ = fftw_plan_dft_c2r_2d(rows, row, numbers, field_.get(), FFTW_MEASURE);
    } else {
      forward_ = fftwf_plan_dft_r2c_2d(rows, row, field_.get(), numbers, FFTW_MEASURE);
      backward_ = fftwf_plan_dft_c2r_2d(rows, row, numbers, field_.get(), FFTW_MEASURE);
    }
    const double scale = 1.0 / static_cast<double>(padded_nx_ * padded_ny_);
    for (std::int64_t k = 0; k < columns_ * padded_ny_; ++k) {
      spectrum_.get()[k] = static_cast<Real>(scale / (1.0 + 0.01 * static_cast<double>(k % columns_)));
    }
  }
  ~TextbookConvolution() {
    if constexpr (kDouble) {
      fftw_destroy_plan(forward_);
      fftw_destroy_plan(backward_);
    } else {
      fftwf_destroy_plan(forward_);
      fftwf_destroy_plan(backward_);
    }
  }
  TextbookConvolution(const TextbookConvolution&) = delete;
  TextbookConvolution& operator=(const TextbookConvolution&) = delete;

  /// Free boundary: the kernel's values at offsets 0 <= i < nx, 0 <= j < ny, even in both.
  void set_kernel(const double* kernel) {
    std::fill(field_.get(), field_.get() + 2 * columns_ * padded_ny_, Real{0});
    for (std::int64_t j = 0; j < padded_ny_; ++j) {
      const std::int64_t offset_y = std::min(j, padded_ny_ - j);
      if (offset_y == ny_) continue;  // no two nodes are that far apart
      for (std::int64_t i = 0; i < padded_nx_; ++i) {
        const std::int64_t offset_x = std::min(i, padded_nx_ - i);
        if (offset_x != nx_)
          field_.get()[2 * columns_ * j + i] = static_cast<Real>(kernel[offset_y * nx_ + offset_x]);
      }
    }
    execute(forward_);
    const Real scale = Real{1} / static_cast<Real>(padded_nx_ * padded_ny_);
    for (std::int64_t k = 0; k < columns_ * padded_ny_; ++k) spectrum_.get()[k] = scale * field_.get()[2 * k];
  }

  /// Periodic boundary: the factor of each wave (cycles per period), even in both.
  void set_symbol(FunctionRef<double(std::int64_t kx, std::int64_t ky)> symbol) {
    const double scale = 1.0 / static_cast<double>(padded_nx_ * padded_ny_);
    for (std::int64_t j = 0; j < padded_ny_; ++j) {
      for (std::int64_t i = 0; i < columns_; ++i) {
        spectrum_.get()[j * columns_ + i] = static_cast<Real>(scale * symbol(i, std::min(j, padded_ny_ - j)));
      }
    }
  }

  void apply(const Real* source, Real* result) {
    Real* field = field_.get();
    const std::int64_t stride = 2 * columns_;
    for (std::int64_t j = 0; j < ny_; ++j) {
      std::copy(source + j * nx_, source + (j + 1) * nx_, field + j * stride);
      std::fill(field + j * stride + nx_, field + (j + 1) * stride, Real{0});
    }
    std::fill(field + ny_ * stride, field + padded_ny_ * stride, Real{0});
    execute(forward_);
    const Real* spectrum = spectrum_.get();
    for (std::int64_t k = 0; k < columns_ * padded_ny_; ++k) {
      field[2 * k] *= spectrum[k];
      field[2 * k + 1] *= spectrum[k];
    }
    execute(backward_);
    for (std::int64_t j = 0; j < ny_; ++j) std::copy(field + j * stride, field + j * stride + nx_, result + j * nx_);
  }

 private:
  struct Release {
    void operator()(Real* memory) const { fftw_free(memory); }
  };
  using Memory = std::unique_ptr<Real, Release>;

  static Memory allocate(std::int64_t size) {
    return Memory(static_cast<Real*>(fftw_malloc(sizeof(Real) * static_cast<std::size_t>(size))));
  }
  static void execute(Plan plan) {
    if constexpr (kDouble) {
      fftw_execute(plan);
    } else {
      fftwf_execute(plan);
    }
  }

  std::int64_t nx_, ny_;
  std::int64_t padded_nx_, padded_ny_;
  std::int64_t columns_;  // complex values of a transformed row
  Memory field_, spectrum_;
  Plan forward_{}, backward_{};
};

}  // namespace brinell::bench
