// Eight columns at a time are gathered into contiguous sequences, stay in cache through forward transform, product
// and backward transform, and are scattered back:
//
//   field [row j][column: re, im]   --gather-->   scratch [column][re sequence, im sequence][j: complex]   (free)
//                                                 scratch [column][j: complex]                             (periodic)
#include "fft/fftw_carrier.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "fft/good_sizes.h"
#include "fft/plan_cache.h"

namespace brinell::fft {

namespace {

constexpr std::int64_t kColumns = 8;  // gathered at a time: a cache line's worth in single precision, two in double

/// Sequences of 2n Reals, set apart so that equal places of neighbours do not fall into the same cache set.
std::int64_t set_apart(std::int64_t reals) {
  return (reals + 15) / 16 * 16 + 16;
}

/// exp(−2πi j / 4n), j < n: interleaved.
template <class Real>
Buffer<Real> quarter_turn(std::int64_t n) {
  auto turn = Buffer<Real>::uninitialised(static_cast<std::size_t>(2 * n));
  for (std::int64_t j = 0; j < n; ++j) {
    const double angle = std::numbers::pi * static_cast<double>(j) / static_cast<double>(2 * n);
    turn[2 * j] = static_cast<Real>(std::cos(angle));
    turn[2 * j + 1] = static_cast<Real>(-std::sin(angle));
  }
  return turn;
}

template <class Real>
class FreeByFftw final : public Carrier<Real> {
 public:
  FreeByFftw(PlanCache& plans, std::int64_t nx, std::int64_t ny)
      : nx_(nx),
        ny_(ny),
        padded_nx_(good_size(nx)),
        padded_ny_(good_size(ny)),
        row_stride_(set_apart(2 * padded_nx_)),
        sequence_stride_(set_apart(2 * padded_ny_)),
        turn_x_(quarter_turn<Real>(padded_nx_)),
        turn_y_(quarter_turn<Real>(padded_ny_)),
        forward_x_(plans.transform<Real>(Kind::complex_forward, padded_nx_)),
        backward_x_(plans.transform<Real>(Kind::complex_backward, padded_nx_)),
        forward_y_(plans.transform<Real>(Kind::complex_forward, padded_ny_)),
        backward_y_(plans.transform<Real>(Kind::complex_backward, padded_ny_)) {}

  Method method() const override { return Method::fftw; }
  std::int64_t padded_nx() const override { return 2 * padded_nx_; }
  std::int64_t padded_ny() const override { return 2 * padded_ny_; }
  std::int64_t blocks() const override { return (padded_nx_ + kColumns - 1) / kColumns; }
  std::size_t field_size() const override { return static_cast<std::size_t>(row_stride_ * ny_); }
  std::size_t scratch_size() const override { return static_cast<std::size_t>(sequence_stride_ * 2 * kColumns); }
  std::size_t spectrum_size() const override { return static_cast<std::size_t>(padded_nx_ * padded_ny_); }

  void arrange(std::int64_t block, FunctionRef<double(std::int64_t, std::int64_t)> value,
               Real* spectrum) const override {
    for (std::int64_t mx = block * kColumns; mx < last_column(block); ++mx) {
      for (std::int64_t my = 0; my < padded_ny_; ++my) {
        spectrum[mx * padded_ny_ + my] = static_cast<Real>(value(mx, my));
      }
    }
  }

  void rows_forward(std::int64_t begin, std::int64_t end, const Real* source, Real* field, Real*) const override {
    for (std::int64_t j = begin; j < end; ++j) {
      Real* row = field + j * row_stride_;
      const Real* values = source + j * nx_;
      for (std::int64_t i = 0; i < nx_; ++i) {
        row[2 * i] = values[i] * turn_x_[2 * i];
        row[2 * i + 1] = values[i] * turn_x_[2 * i + 1];
      }
      std::fill(row + 2 * nx_, row + 2 * padded_nx_, Real{0});
      forward_x_(row);
    }
  }

  void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result, Real*) const override {
    for (std::int64_t j = begin; j < end; ++j) {
      Real* row = field + j * row_stride_;
      backward_x_(row);
      Real* values = result + j * nx_;
      for (std::int64_t i = 0; i < nx_; ++i) {
        values[i] = row[2 * i] * turn_x_[2 * i] + row[2 * i + 1] * turn_x_[2 * i + 1];
      }
    }
  }

  void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field, Real* scratch) const override {
    const std::int64_t first = block * kColumns;
    const std::int64_t columns = last_column(block) - first;
    gather(field + 2 * first, columns, scratch);
    for (std::int64_t c = 0; c < columns; ++c) {
      const Real* values = spectrum.values.data() + (first + c) * padded_ny_;
      for (int part = 0; part < 2; ++part) {
        Real* sequence = scratch + (2 * c + part) * sequence_stride_;
        forward_y_(sequence);
        multiply(values, spectrum.parity_y, sequence);
        backward_y_(sequence);
      }
    }
    // A kernel odd in x carries a factor −i, by which (re, im) becomes (im, −re).
    if (spectrum.parity_x == Parity::even) {
      scatter(scratch, 0, 1, columns, field + 2 * first);
    } else {
      scatter(scratch, 1, -1, columns, field + 2 * first);
    }
  }

 private:
  std::int64_t last_column(std::int64_t block) const { return std::min((block + 1) * kColumns, padded_nx_); }

  void gather(const Real* field, std::int64_t columns, Real* scratch) const {
    for (std::int64_t j = 0; j < ny_; ++j) {
      const Real* row = field + j * row_stride_;
      const Real cosine = turn_y_[2 * j];
      const Real sine = turn_y_[2 * j + 1];
      Real* place = scratch + 2 * j;
      for (std::int64_t c = 0; c < 2 * columns; ++c, place += sequence_stride_) {
        place[0] = row[c] * cosine;
        place[1] = row[c] * sine;
      }
    }
    for (std::int64_t c = 0; c < 2 * columns; ++c) {
      Real* sequence = scratch + c * sequence_stride_;
      std::fill(sequence + 2 * ny_, sequence + 2 * padded_ny_, Real{0});
    }
  }

  void multiply(const Real* values, Parity parity_y, Real* sequence) const {
    if (parity_y == Parity::even) {
      for (std::int64_t m = 0; m < padded_ny_; ++m) {
        sequence[2 * m] *= values[m];
        sequence[2 * m + 1] *= values[m];
      }
    } else {
      for (std::int64_t m = 0; m < padded_ny_; ++m) {
        const Real real = sequence[2 * m];
        sequence[2 * m] = values[m] * sequence[2 * m + 1];
        sequence[2 * m + 1] = -values[m] * real;
      }
    }
  }

  /// Real part of each column from the sequence 2·column + swap, imaginary part from the other one, times sign.
  void scatter(const Real* scratch, int swap, Real sign, std::int64_t columns, Real* field) const {
    for (std::int64_t j = 0; j < ny_; ++j) {
      Real* row = field + j * row_stride_;
      const Real cosine = turn_y_[2 * j];
      const Real sine = turn_y_[2 * j + 1];
      const Real* place = scratch + 2 * j;
      for (std::int64_t c = 0; c < columns; ++c, place += 2 * sequence_stride_) {
        const Real* real = place + swap * sequence_stride_;
        const Real* imaginary = place + (1 - swap) * sequence_stride_;
        row[2 * c] = real[0] * cosine + real[1] * sine;
        row[2 * c + 1] = sign * (imaginary[0] * cosine + imaginary[1] * sine);
      }
    }
  }

  std::int64_t nx_, ny_;
  std::int64_t padded_nx_, padded_ny_;  // n of the half-integer transforms
  std::int64_t row_stride_;             // of the field, in Reals
  std::int64_t sequence_stride_;        // of the scratch, in Reals
  Buffer<Real> turn_x_, turn_y_;
  Transform<Real> forward_x_, backward_x_, forward_y_, backward_y_;
};

template <class Real>
class PeriodicByFftw final : public Carrier<Real> {
 public:
  PeriodicByFftw(PlanCache& plans, std::int64_t nx, std::int64_t ny)
      : nx_(nx),
        ny_(ny),
        columns_(nx / 2 + 1),
        half_ny_(ny / 2 + 1),
        row_stride_(set_apart(2 * columns_)),
        sequence_stride_(set_apart(2 * ny)),
        forward_x_(plans.transform<Real>(Kind::real_to_complex, nx)),
        backward_x_(plans.transform<Real>(Kind::complex_to_real, nx)),
        forward_y_(plans.transform<Real>(Kind::complex_forward, ny)),
        backward_y_(plans.transform<Real>(Kind::complex_backward, ny)) {}

  Method method() const override { return Method::fftw; }
  std::int64_t padded_nx() const override { return nx_; }
  std::int64_t padded_ny() const override { return ny_; }
  std::int64_t blocks() const override { return (columns_ + kColumns - 1) / kColumns; }
  std::size_t field_size() const override { return static_cast<std::size_t>(row_stride_ * ny_); }
  std::size_t scratch_size() const override { return static_cast<std::size_t>(sequence_stride_ * kColumns); }
  std::size_t spectrum_size() const override { return static_cast<std::size_t>(columns_ * half_ny_); }

  void arrange(std::int64_t block, FunctionRef<double(std::int64_t, std::int64_t)> value,
               Real* spectrum) const override {
    for (std::int64_t mx = block * kColumns; mx < last_column(block); ++mx) {
      for (std::int64_t my = 0; my < half_ny_; ++my) {
        spectrum[mx * half_ny_ + my] = static_cast<Real>(value(mx, my));
      }
    }
  }

  void rows_forward(std::int64_t begin, std::int64_t end, const Real* source, Real* field, Real*) const override {
    for (std::int64_t j = begin; j < end; ++j) {
      Real* row = field + j * row_stride_;
      std::copy(source + j * nx_, source + (j + 1) * nx_, row);
      forward_x_(row);
    }
  }

  void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result, Real*) const override {
    for (std::int64_t j = begin; j < end; ++j) {
      Real* row = field + j * row_stride_;
      backward_x_(row);
      std::copy(row, row + nx_, result + j * nx_);
    }
  }

  void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field, Real* scratch) const override {
    const std::int64_t first = block * kColumns;
    const std::int64_t columns = last_column(block) - first;
    for (std::int64_t j = 0; j < ny_; ++j) {
      const Real* row = field + j * row_stride_ + 2 * first;
      Real* place = scratch + 2 * j;
      for (std::int64_t c = 0; c < columns; ++c, place += sequence_stride_) {
        place[0] = row[2 * c];
        place[1] = row[2 * c + 1];
      }
    }
    for (std::int64_t c = 0; c < columns; ++c) {
      Real* sequence = scratch + c * sequence_stride_;
      forward_y_(sequence);
      multiply(spectrum.values.data() + (first + c) * half_ny_, sequence);
      backward_y_(sequence);
    }
    for (std::int64_t j = 0; j < ny_; ++j) {
      Real* row = field + j * row_stride_ + 2 * first;
      const Real* place = scratch + 2 * j;
      for (std::int64_t c = 0; c < columns; ++c, place += sequence_stride_) {
        row[2 * c] = place[0];
        row[2 * c + 1] = place[1];
      }
    }
  }

 private:
  std::int64_t last_column(std::int64_t block) const { return std::min((block + 1) * kColumns, columns_); }

  void multiply(const Real* values, Real* sequence) const {
    for (std::int64_t m = 0; m < half_ny_; ++m) {
      sequence[2 * m] *= values[m];
      sequence[2 * m + 1] *= values[m];
    }
    for (std::int64_t m = half_ny_; m < ny_; ++m) {
      sequence[2 * m] *= values[ny_ - m];
      sequence[2 * m + 1] *= values[ny_ - m];
    }
  }

  std::int64_t nx_, ny_;
  std::int64_t columns_, half_ny_;  // independent frequencies in x and y
  std::int64_t row_stride_;         // of the field, in Reals
  std::int64_t sequence_stride_;    // of the scratch, in Reals
  Transform<Real> forward_x_, backward_x_, forward_y_, backward_y_;
};

}  // namespace

template <class Real>
std::unique_ptr<const Carrier<Real>> fftw_carrier(PlanCache& plans, std::int64_t nx, std::int64_t ny,
                                                  Boundary boundary) {
  if (boundary == Boundary::periodic) return std::make_unique<const PeriodicByFftw<Real>>(plans, nx, ny);
  return std::make_unique<const FreeByFftw<Real>>(plans, nx, ny);
}

template std::unique_ptr<const Carrier<double>> fftw_carrier<double>(PlanCache&, std::int64_t, std::int64_t,
                                                                     Boundary);
template std::unique_ptr<const Carrier<float>> fftw_carrier<float>(PlanCache&, std::int64_t, std::int64_t, Boundary);

}  // namespace brinell::fft
