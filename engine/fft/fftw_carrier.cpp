// Columns lie in the field in blocks of as many as fill a cache line. The columns of a block are gathered into
// contiguous sequences, stay in cache through forward transform, product and backward transform, and are scattered
// back:
//
//   field [block][row j][column: re, im]  -->  scratch [column][re sequence, im sequence][j: complex]   (free)
//                                              scratch [column][j: complex]                             (periodic)
//
// The free carrier moves the last block's columns beyond the field along, so that all blocks are of one width.
#include "fft/fftw_carrier.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "fft/good_sizes.h"
#include "fft/plan_cache.h"

namespace brinell::fft {

namespace {

template <class Real>
constexpr std::int64_t kColumns = static_cast<std::int64_t>(kAlignment / (2 * sizeof(Real)));  // of a block

/// Length of arrays that follow each other, so that equal places of neighbours do not fall into the same cache set.
std::int64_t set_apart(std::int64_t reals) {
  return (reals + 15) / 16 * 16 + 16;
}

/// The field's blocks, in Reals.
template <class Real>
struct Blocks {
  Blocks(std::int64_t columns_, std::int64_t ny)
      : columns(columns_),
        count((columns + kColumns<Real> - 1) / kColumns<Real>),
        stride(set_apart(2 * kColumns<Real> * ny)) {}

  std::int64_t first(std::int64_t block) const { return block * kColumns<Real>; }
  std::int64_t last(std::int64_t block) const { return std::min(first(block + 1), columns); }
  std::size_t size() const { return static_cast<std::size_t>(stride * count); }
  /// Reals of one row in a transform's output, rounded up to whole blocks.
  std::int64_t row() const { return 2 * kColumns<Real> * count; }

  /// Row j to and from the blocks.
  void scatter_row(const Real* row, std::int64_t j, Real* field) const {
    for (std::int64_t block = 0; block < count; ++block) {
      Real* part = field + block * stride + j * kWidth;
      __builtin_prefetch(part + 4 * kWidth, 1, 2);  // as in gather_row
      std::memcpy(part, row + block * kWidth, kWidth * sizeof(Real));
    }
  }
  void gather_row(const Real* field, std::int64_t j, Real* row) const {
    for (std::int64_t block = 0; block < count; ++block) {
      const Real* part = field + block * stride + j * kWidth;
      __builtin_prefetch(part + 4 * kWidth, 0, 2);  // far from each other: out of reach of the hardware's fetching
      std::memcpy(row + block * kWidth, part, kWidth * sizeof(Real));
    }
  }

  static constexpr std::int64_t kWidth = 2 * kColumns<Real>;
  std::int64_t columns, count, stride;
};

/// Asks for memory that is read a little later.
template <class Real>
void prefetch(const Real* begin, std::int64_t count) {
  constexpr std::int64_t line = static_cast<std::int64_t>(kAlignment / sizeof(Real));
  for (std::int64_t k = 0; k < count; k += line) __builtin_prefetch(begin + k, 0, 2);
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
        length_x_(good_size(nx)),
        length_y_(good_size(ny)),
        blocks_(length_x_, ny),
        row_(set_apart(blocks_.row())),
        sequence_(set_apart(2 * length_y_)),
        turn_x_(quarter_turn<Real>(length_x_)),
        turn_y_(quarter_turn<Real>(length_y_)),
        forward_x_(plans.transform<Real>(Kind::complex_forward, length_x_)),
        backward_x_(plans.transform<Real>(Kind::complex_backward, length_x_)),
        forward_y_(plans.transform<Real>(Kind::complex_forward, length_y_)),
        backward_y_(plans.transform<Real>(Kind::complex_backward, length_y_)) {}

  Method method() const override { return Method::fftw; }
  std::int64_t padded_nx() const override { return 2 * length_x_; }
  std::int64_t padded_ny() const override { return 2 * length_y_; }
  std::int64_t blocks() const override { return blocks_.count; }
  std::size_t field_size() const override { return blocks_.size(); }
  std::size_t scratch_size() const override {
    return static_cast<std::size_t>(std::max(2 * row_, (2 * kColumns<Real> + 1) * sequence_));
  }
  std::size_t spectrum_size() const override { return static_cast<std::size_t>(length_x_ * length_y_); }
  std::size_t transform_size() const override { return static_cast<std::size_t>(length_x_ * 2 * sequence_); }

  void arrange(std::int64_t block, FunctionRef<double(std::int64_t, std::int64_t)> value,
               Real* spectrum) const override {
    for (std::int64_t mx = blocks_.first(block); mx < blocks_.last(block); ++mx) {
      for (std::int64_t my = 0; my < length_y_; ++my) {
        spectrum[mx * length_y_ + my] = static_cast<Real>(value(mx, my));
      }
    }
  }

  void rows_forward(std::int64_t begin, std::int64_t end, const Real* source, Real* field,
                    Real* scratch) const override {
    Real* row = scratch;
    Real* transformed = scratch + row_;
    std::fill(row + 2 * nx_, row + 2 * length_x_, Real{0});
    for (std::int64_t j = begin; j < end; ++j, source += nx_) {
      for (std::int64_t i = 0; i < nx_; ++i) {
        row[2 * i] = source[i] * turn_x_[2 * i];
        row[2 * i + 1] = source[i] * turn_x_[2 * i + 1];
      }
      forward_x_(row, transformed);
      blocks_.scatter_row(transformed, j, field);
    }
  }

  void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result, Real* scratch) const override {
    Real* row = scratch;
    Real* transformed = scratch + row_;
    for (std::int64_t j = begin; j < end; ++j) {
      blocks_.gather_row(field, j, row);
      backward_x_(row, transformed);
      Real* values = result + j * nx_;
      for (std::int64_t i = 0; i < nx_; ++i) {
        values[i] = transformed[2 * i] * turn_x_[2 * i] + transformed[2 * i + 1] * turn_x_[2 * i + 1];
      }
    }
  }

  void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    Real* place = field + block * blocks_.stride;
    Real* sequences = scratch + sequence_;
    const std::int64_t share = blocks_.stride / (2 * columns);
    gather(place, columns, sequences);
    for (std::int64_t c = 0; c < columns; ++c) {
      const Real* values = spectrum.values.data() + (first + c) * length_y_;
      for (int part = 0; part < 2; ++part) {
        Real* sequence = sequences + (2 * c + part) * sequence_;
        // A share of the next block and of the next column of the spectrum with each transform.
        prefetch(place + blocks_.stride + (2 * c + part) * share, share);
        prefetch(values + length_y_ + part * length_y_ / 2, length_y_ / 2);
        forward_y_(sequence, scratch);
        multiply(values, spectrum.parity_y, scratch);
        backward_y_(scratch, sequence);
      }
    }
    // A kernel odd in x carries a factor −i, by which (re, im) becomes (im, −re).
    if (spectrum.parity_x == Parity::even) {
      scatter(sequences, 0, 1, place);
    } else {
      scatter(sequences, 1, -1, place);
    }
  }

  void transform_block(std::int64_t block, const Real* field, Real* transform, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    gather(field + block * blocks_.stride, columns, scratch);
    for (std::int64_t s = 0; s < 2 * columns; ++s) {
      forward_y_(scratch + s * sequence_, transform + (2 * first + s) * sequence_);
    }
  }

  void sum_block(std::int64_t block, std::span<const Term<Real>> terms, Real* field, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    Real* sequences = scratch + sequence_;
    for (std::int64_t s = 0; s < 2 * columns; ++s) {
      std::fill(scratch, scratch + 2 * length_y_, Real{0});
      for (const Term<Real>& term : terms) {
        const bool turn_x = term.spectrum->parity_x == Parity::odd;
        const std::int64_t from = turn_x ? s ^ 1 : s;
        const Real sign = turn_x && s % 2 == 1 ? Real{-1} : Real{1};
        add_product(term.spectrum->values.data() + (first + s / 2) * length_y_, term.spectrum->parity_y, sign,
                    term.source->values.data() + (2 * first + from) * sequence_, scratch);
      }
      backward_y_(scratch, sequences + s * sequence_);
    }
    scatter(sequences, 0, 1, field + block * blocks_.stride);
  }

 private:
  void add_product(const Real* values, Parity parity_y, Real sign, const Real* sequence, Real* sum) const {
    for (std::int64_t m = 0; m < length_y_; ++m) {
      const Real factor = sign * values[m];
      const Real re = factor * sequence[2 * m];
      const Real im = factor * sequence[2 * m + 1];
      sum[2 * m] += parity_y == Parity::even ? re : im;
      sum[2 * m + 1] += parity_y == Parity::even ? im : -re;
    }
  }

  void gather(const Real* __restrict block, std::int64_t columns, Real* __restrict sequences) const {
    for (std::int64_t j = 0; j < ny_; ++j) {
      const Real* row = block + j * Blocks<Real>::kWidth;
      const Real cosine = turn_y_[2 * j];
      const Real sine = turn_y_[2 * j + 1];
      Real* place = sequences + 2 * j;
      for (std::int64_t c = 0; c < Blocks<Real>::kWidth; ++c) {
        place[c * sequence_] = row[c] * cosine;
        place[c * sequence_ + 1] = row[c] * sine;
      }
    }
    for (std::int64_t c = 0; c < 2 * columns; ++c) {
      Real* sequence = sequences + c * sequence_;
      std::fill(sequence + 2 * ny_, sequence + 2 * length_y_, Real{0});
    }
  }

  void multiply(const Real* values, Parity parity_y, Real* sequence) const {
    if (parity_y == Parity::even) {
      for (std::int64_t m = 0; m < length_y_; ++m) {
        sequence[2 * m] *= values[m];
        sequence[2 * m + 1] *= values[m];
      }
    } else {
      for (std::int64_t m = 0; m < length_y_; ++m) {
        const Real real = sequence[2 * m];
        sequence[2 * m] = values[m] * sequence[2 * m + 1];
        sequence[2 * m + 1] = -values[m] * real;
      }
    }
  }

  /// Real part of each column from the sequence 2·column + swap, imaginary part from the other one, times sign.
  void scatter(const Real* __restrict sequences, int swap, Real sign, Real* __restrict block) const {
    const Real* const real = sequences + swap * sequence_;
    const Real* const imaginary = sequences + (1 - swap) * sequence_;
    for (std::int64_t j = 0; j < ny_; ++j) {
      Real* row = block + j * Blocks<Real>::kWidth;
      const Real cosine = turn_y_[2 * j];
      const Real sine = turn_y_[2 * j + 1];
      const Real signed_cosine = sign * cosine;
      const Real signed_sine = sign * sine;
      for (std::int64_t c = 0; c < kColumns<Real>; ++c) {
        const std::int64_t at = 2 * (c * sequence_ + j);
        row[2 * c] = real[at] * cosine + real[at + 1] * sine;
        row[2 * c + 1] = imaginary[at] * signed_cosine + imaginary[at + 1] * signed_sine;
      }
    }
  }

  std::int64_t nx_, ny_;
  std::int64_t length_x_, length_y_;  // of the half-integer transforms
  Blocks<Real> blocks_;
  std::int64_t row_, sequence_;  // of the scratch, in Reals
  Buffer<Real> turn_x_, turn_y_;
  Transform<Real> forward_x_, backward_x_, forward_y_, backward_y_;
};

template <class Real>
class PeriodicByFftw final : public Carrier<Real> {
 public:
  PeriodicByFftw(PlanCache& plans, std::int64_t nx, std::int64_t ny)
      : nx_(nx),
        ny_(ny),
        half_ny_(ny / 2 + 1),
        blocks_(nx / 2 + 1, ny),
        row_(set_apart(blocks_.row())),
        sequence_(set_apart(2 * ny)),
        forward_x_(plans.transform<Real>(Kind::real_to_complex, nx)),
        backward_x_(plans.transform<Real>(Kind::complex_to_real, nx)),
        forward_y_(plans.transform<Real>(Kind::complex_forward, ny)),
        backward_y_(plans.transform<Real>(Kind::complex_backward, ny)) {}

  Method method() const override { return Method::fftw; }
  std::int64_t padded_nx() const override { return nx_; }
  std::int64_t padded_ny() const override { return ny_; }
  std::int64_t blocks() const override { return blocks_.count; }
  std::size_t field_size() const override { return blocks_.size(); }
  std::size_t scratch_size() const override {
    return static_cast<std::size_t>(std::max(2 * row_, (kColumns<Real> + 1) * sequence_));
  }
  std::size_t spectrum_size() const override { return static_cast<std::size_t>(blocks_.columns * half_ny_); }
  std::size_t transform_size() const override { return static_cast<std::size_t>(blocks_.columns * sequence_); }

  void arrange(std::int64_t block, FunctionRef<double(std::int64_t, std::int64_t)> value,
               Real* spectrum) const override {
    for (std::int64_t mx = blocks_.first(block); mx < blocks_.last(block); ++mx) {
      for (std::int64_t my = 0; my < half_ny_; ++my) {
        spectrum[mx * half_ny_ + my] = static_cast<Real>(value(mx, my));
      }
    }
  }

  void rows_forward(std::int64_t begin, std::int64_t end, const Real* source, Real* field,
                    Real* scratch) const override {
    for (std::int64_t j = begin; j < end; ++j, source += nx_) {
      std::copy(source, source + nx_, scratch);
      forward_x_(scratch, scratch + row_);
      blocks_.scatter_row(scratch + row_, j, field);
    }
  }

  void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result, Real* scratch) const override {
    for (std::int64_t j = begin; j < end; ++j) {
      blocks_.gather_row(field, j, scratch);
      backward_x_(scratch, scratch + row_);
      std::copy(scratch + row_, scratch + row_ + nx_, result + j * nx_);
    }
  }

  void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    Real* const rows = field + block * blocks_.stride;
    Real* const sequences = scratch + sequence_;
    gather(rows, columns, sequences);
    for (std::int64_t c = 0; c < columns; ++c) {
      Real* sequence = sequences + c * sequence_;
      forward_y_(sequence, scratch);
      std::copy_n(scratch, 2 * ny_, sequence);
      std::fill_n(scratch, 2 * ny_, Real{0});
      add_product(spectrum, first + c, sequence, scratch);
      backward_y_(scratch, sequence);
    }
    scatter(sequences, columns, rows);
  }

  void transform_block(std::int64_t block, const Real* field, Real* transform, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    gather(field + block * blocks_.stride, columns, scratch);
    for (std::int64_t c = 0; c < columns; ++c) {
      forward_y_(scratch + c * sequence_, transform + (first + c) * sequence_);
    }
  }

  void sum_block(std::int64_t block, std::span<const Term<Real>> terms, Real* field, Real* scratch) const override {
    const std::int64_t first = blocks_.first(block);
    const std::int64_t columns = blocks_.last(block) - first;
    Real* const sequences = scratch + sequence_;
    for (std::int64_t c = 0; c < columns; ++c) {
      std::fill(scratch, scratch + 2 * ny_, Real{0});
      for (const Term<Real>& term : terms) {
        add_product(*term.spectrum, first + c, term.source->values.data() + (first + c) * sequence_, scratch);
      }
      backward_y_(scratch, sequences + c * sequence_);
    }
    scatter(sequences, columns, field + block * blocks_.stride);
  }

 private:
  void gather(const Real* block, std::int64_t columns, Real* sequences) const {
    for (std::int64_t j = 0; j < ny_; ++j) {
      const Real* row = block + j * Blocks<Real>::kWidth;
      Real* place = sequences + 2 * j;
      for (std::int64_t c = 0; c < columns; ++c, place += sequence_) std::copy_n(row + 2 * c, 2, place);
    }
  }

  void scatter(const Real* sequences, std::int64_t columns, Real* block) const {
    for (std::int64_t j = 0; j < ny_; ++j) {
      Real* row = block + j * Blocks<Real>::kWidth;
      const Real* place = sequences + 2 * j;
      for (std::int64_t c = 0; c < columns; ++c, place += sequence_) std::copy_n(place, 2, row + 2 * c);
    }
  }

  /// sum += spectrum · source for one column. One factor −i is left where the parities differ.
  void add_product(const Spectrum<Real>& spectrum, std::int64_t column, const Real* source, Real* sum) const {
    const Real* values = spectrum.values.data() + column * half_ny_;
    const Real mirror = spectrum.parity_y == Parity::even ? Real{1} : Real{-1};
    const bool turn = spectrum.parity_x != spectrum.parity_y;
    for (std::int64_t m = 0; m < ny_; ++m) {
      const Real value = m < half_ny_ ? values[m] : mirror * values[ny_ - m];
      const Real re = value * source[2 * m], im = value * source[2 * m + 1];
      sum[2 * m] += turn ? im : re;
      sum[2 * m + 1] += turn ? -re : im;
    }
  }

  std::int64_t nx_, ny_;
  std::int64_t half_ny_;  // independent frequencies in y
  Blocks<Real> blocks_;
  std::int64_t row_, sequence_;  // of the scratch, in Reals
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
