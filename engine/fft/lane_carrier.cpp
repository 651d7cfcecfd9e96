#include "fft/lane_carrier.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "fft/good_sizes.h"
#include "fft/lane_tree.h"

namespace brinell::fft {

namespace {

/// Positions after the last whole group of lanes are finished one by one: such a position costs about as much more
/// as this many whole blocks.
double cost_of_rest(std::int64_t positions, std::int64_t lanes) {
  return 0.25 * static_cast<double>(lanes) * static_cast<double>(positions % lanes);
}

/// The length >= n (in units of `unit`) whose transform costs least; the best is never far above n.
template <class Cost>
std::int64_t cheapest_length(std::int64_t n, const Cost& cost) {
  std::int64_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t length = n; length <= 2 * n; ++length) {
    if (!is_tree_length(length)) continue;
    const double now = cost(length);
    if (now < least) {
      least = now;
      best = length;
    }
  }
  return best;
}

/// Fields larger than this are written past the caches, and so is the result: measured, convolution and one pass over
/// its result together gain from 1.5 MB on, on a second-level cache of 1 MB and a shared one of 32 MB.
constexpr std::size_t kStaysInCache = std::size_t{3} << 19;

/// More than one only to see whether the regression check notices (bench/regress): the same result, but later.
#ifdef BRINELL_PLANT_SLOWDOWN
constexpr int kTurnsOfRows = 3;  // a third of the convolution's time more
#else
constexpr int kTurnsOfRows = 1;
#endif

/// One of the frequencies in x, and how often it counts (a pair of conjugates is kept once).
struct Frequency {
  std::int64_t m;
  double weight;
};

template <class Real>
class ByLanes final : public LaneCarrier<Real> {
 public:
  ByLanes(const simd::TransformKernels<Real>& kernels, std::int64_t nx, std::int64_t ny, std::int64_t length_x,
          std::int64_t length_y, Boundary boundary)
      : kernels_(kernels),
        lanes_(kernels.lanes),
        boundary_(boundary),
        length_y_(length_y),
        tree_y_(length_y, boundary == Boundary::free ? 1 : 0, boundary == Boundary::free ? 4 : 1) {
    rows_.nx = nx;
    rows_.length = length_x;
    cut_into_pieces();
    lane_stage();
    // Blocks are set apart so that equal rows of neighbours do not fall into the same cache set.
    rows_.block_stride = ny * 2 * lanes_ + static_cast<std::int64_t>(2 * kAlignment / sizeof(Real));
    rows_.past_caches = field_size() * sizeof(Real) > kStaysInCache;
    columns_.ny = ny;
    columns_.tree = tree_y_.view();
  }

  const simd::RowTransform<Real>& rows() const override { return rows_; }
  const simd::ColumnTransform<Real>& columns() const override { return columns_; }

  Method method() const override { return Method::lanes; }
  std::int64_t padded_nx() const override { return (boundary_ == Boundary::free ? 2 : 1) * rows_.length; }
  std::int64_t padded_ny() const override { return (boundary_ == Boundary::free ? 2 : 1) * length_y_; }
  std::int64_t blocks() const override { return rows_.positions; }
  std::size_t field_size() const override { return static_cast<std::size_t>(rows_.block_stride * blocks()); }
  std::size_t scratch_size() const override {
    return static_cast<std::size_t>(std::max(3 * rows_.length, 2 * lanes_ * (length_y_ + simd::kMaxRadix)));
  }
  std::size_t spectrum_size() const override { return static_cast<std::size_t>(blocks() * length_y_ * lanes_); }

  std::size_t transform_size() const override { return static_cast<std::size_t>(blocks() * transform_of_block()); }

  void arrange(std::int64_t block, FunctionRef<double(std::int64_t, std::int64_t)> value,
               Real* spectrum) const override {
    const bool free = boundary_ == Boundary::free;
    Real* place = spectrum + block * length_y_ * lanes_;
    for (const std::int64_t numerator : tree_y_.leaf_numerators()) {
      const std::int64_t my = free ? numerator / 4 : numerator;
      for (std::int64_t lane = 0; lane < lanes_; ++lane) {
        const Frequency& x = frequencies_[static_cast<std::size_t>(block * lanes_ + lane)];
        *place++ = static_cast<Real>(x.weight * value(x.m, my));
      }
    }
  }

  void rows_forward(std::int64_t begin, std::int64_t end, const Real* source, Real* field,
                    Real* scratch) const override {
    for (int turn = 0; turn < kTurnsOfRows; ++turn) {
      kernels_.rows_forward(rows_, 0, end - begin, source, field + begin * 2 * lanes_, scratch);
    }
  }

  void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result, Real* scratch) const override {
    kernels_.rows_backward(rows_, begin, end, field, result, scratch);
  }

  void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field, Real* scratch) const override {
    const bool last = block + 1 == blocks();
    const Real* values = spectrum.values.data() + block * length_y_ * lanes_;
    Real* place = field + block * rows_.block_stride;
    const simd::BlockProduct<Real> product{values, turn_x(spectrum), turn_y(spectrum),
                                           last ? nullptr : place + rows_.block_stride,
                                           last ? nullptr : values + length_y_ * lanes_};
    if (boundary_ == Boundary::free) {
      kernels_.free_block(columns_, product, place, scratch);
    } else {
      kernels_.periodic_block(columns_, product, place);
    }
  }

  void transform_block(std::int64_t block, const Real* field, Real* transform, Real*) const override {
    const auto forward = boundary_ == Boundary::free ? kernels_.free_forward : kernels_.periodic_forward;
    forward(columns_, field + block * rows_.block_stride, transform + block * transform_of_block());
  }

  bool transforms_kernels() const override { return boundary_ == Boundary::free; }

  void spectrum_block(std::int64_t block, Parity parity_x, Parity parity_y, const Real* field, Real* spectrum,
                      Real* scratch) const override {
    const double scale = 4 / (static_cast<double>(rows_.length) * static_cast<double>(length_y_));
    kernels_.free_spectrum(columns_, field + block * rows_.block_stride, parity_x == Parity::odd,
                           parity_y == Parity::odd, static_cast<Real>(scale), spectrum + block * length_y_ * lanes_,
                           scratch);
  }

  void sum_block(std::int64_t block, std::span<const Term<Real>> terms, Real* field, Real* scratch) const override {
    std::vector<simd::BlockTerm<Real>> products;
    products.reserve(terms.size());
    for (const Term<Real>& term : terms) {
      products.push_back({term.source->values.data() + block * transform_of_block(),
                          term.spectrum->values.data() + block * length_y_ * lanes_, turn_x(*term.spectrum),
                          turn_y(*term.spectrum)});
    }
    const auto count = static_cast<std::int64_t>(products.size());
    Real* place = field + block * rows_.block_stride;
    if (boundary_ == Boundary::free) {
      kernels_.free_sum(columns_, products.data(), count, place, scratch);
    } else {
      kernels_.periodic_sum(columns_, products.data(), count, place);
    }
  }

 private:
  std::int64_t transform_of_block() const { return (boundary_ == Boundary::free ? 2 : 1) * length_y_ * 2 * lanes_; }

  /// On a periodic boundary the complex numbers of both transforms are the same.
  bool turn_x(const Spectrum<Real>& spectrum) const {
    return boundary_ == Boundary::free && spectrum.parity_x == Parity::odd;
  }
  bool turn_y(const Spectrum<Real>& spectrum) const {
    return boundary_ == Boundary::free ? spectrum.parity_y == Parity::odd : spectrum.parity_x != spectrum.parity_y;
  }

  void add_piece(std::int64_t length, std::int64_t numerator, std::int64_t denominator) {
    trees_x_.emplace_back(length, numerator, denominator);
    rows_.tree[trees_x_.size() - 1] = trees_x_.back().view();
    rows_.positions += length;
  }

  void cut_into_pieces() {
    rows_.positions = 0;
    rows_.pieces = 0;
    if (boundary_ == Boundary::free) return add_piece(rows_.length / lanes_, 1, 4);
    const std::int64_t vectors = rows_.length / lanes_;
    std::int64_t best = vectors;  // length of the last piece
    double least = std::numeric_limits<double>::infinity();
    for (std::int64_t left = vectors;; left /= 2) {
      const std::int64_t positions = (vectors - left) / 2 + left;
      const double cost = static_cast<double>(positions) + cost_of_rest(positions, lanes_);
      if (cost < least) {
        least = cost;
        best = left;
      }
      if (left % 4 != 0) break;
    }
    for (std::int64_t left = vectors; left > best; left /= 2) add_piece(left / 4, 1, 4);
    add_piece(best, 0, 1);
    rows_.pieces = static_cast<std::int32_t>(trees_x_.size());
  }

  /// Twiddle factors of the last stage in x, and the frequencies that come out of it.
  void lane_stage() {
    struct Position {
      std::int64_t numerator, denominator;  // θ
      std::int64_t scale;                   // frequency of the whole row = scale · that of the piece
      double weight;
    };
    std::vector<Position> positions;
    const bool free = boundary_ == Boundary::free;
    for (std::size_t piece = 0; piece < trees_x_.size(); ++piece) {
      const LaneTree<Real>& tree = trees_x_[piece];
      const bool kept_once = !free && piece + 1 < trees_x_.size();
      for (const std::int64_t numerator : tree.leaf_numerators()) {
        positions.push_back({numerator, tree.leaf_denominator(), rows_.length / (tree.leaf_denominator() * lanes_),
                             kept_once ? 2.0 : 1.0});
      }
    }
    const auto output = [&](const Position& position, std::int64_t t) {
      const std::int64_t numerator = position.numerator + t * position.denominator;
      return free ? Frequency{numerator / 4, 1.0} : Frequency{numerator * position.scale, position.weight};
    };
    const std::int64_t groups = rows_.positions / lanes_;
    const std::int64_t rest = rows_.positions - groups * lanes_;
    lane_twiddles_ = Buffer<Real>(static_cast<std::size_t>(groups * (lanes_ - 1) * 2 * lanes_));
    rest_twiddles_ = Buffer<Real>(static_cast<std::size_t>(rest * (lanes_ - 1) * 2));
    Real* place = lane_twiddles_.data();
    for (std::int64_t group = 0; group < groups; ++group) {
      const Position* first = positions.data() + group * lanes_;
      for (std::int64_t s = 1; s < lanes_; ++s, place += 2 * lanes_) {
        for (std::int64_t lane = 0; lane < lanes_; ++lane) {
          unit_root(s * first[lane].numerator, first[lane].denominator * lanes_, place[lane], place[lanes_ + lane]);
        }
      }
      for (std::int64_t t = 0; t < lanes_; ++t) {
        for (std::int64_t lane = 0; lane < lanes_; ++lane) frequencies_.push_back(output(first[lane], t));
      }
    }
    place = rest_twiddles_.data();
    for (std::int64_t p = groups * lanes_; p < rows_.positions; ++p) {
      const Position& position = positions[static_cast<std::size_t>(p)];
      for (std::int64_t s = 1; s < lanes_; ++s, place += 2) {
        unit_root(s * position.numerator, position.denominator * lanes_, place[0], place[1]);
      }
      for (std::int64_t t = 0; t < lanes_; ++t) frequencies_.push_back(output(position, t));
    }
    rows_.lane_twiddles = lane_twiddles_.data();
    rows_.rest_twiddles = rest_twiddles_.data();
  }

  const simd::TransformKernels<Real>& kernels_;
  std::int64_t lanes_;
  Boundary boundary_;
  std::int64_t length_y_;
  LaneTree<Real> tree_y_;
  std::vector<LaneTree<Real>> trees_x_;
  Buffer<Real> lane_twiddles_, rest_twiddles_;
  std::vector<Frequency> frequencies_;  // [block][lane]
  simd::RowTransform<Real> rows_{};
  simd::ColumnTransform<Real> columns_{};
};

/// One lane transform is about this many times faster than FFTW's of the same size.
constexpr double kAdvantage = 2.5;

}  // namespace

template <class Real>
std::unique_ptr<const LaneCarrier<Real>> lane_carrier(const simd::TransformKernels<Real>& kernels, std::int64_t nx,
                                                      std::int64_t ny, Boundary boundary, bool must_pay,
                                                      bool densest) {
  const std::int64_t lanes = kernels.lanes;
  if (boundary == Boundary::periodic) {
    if (nx % lanes != 0 || !is_tree_length(nx / lanes) || !is_tree_length(ny)) return nullptr;
    return std::make_unique<const ByLanes<Real>>(kernels, nx, ny, nx, ny, boundary);
  }
  const auto count = [](std::int64_t n) { return static_cast<double>(n); };
  const std::int64_t length_y = densest ? cheapest_length(ny, count) : cheapest_length(ny, tree_cost);
  // Each vector of a row costs its part of the row's transform, and of two transforms of its block's columns.
  const double of_columns = 2 * tree_cost(length_y) / static_cast<double>(length_y);
  const auto cost = [&](std::int64_t n) {
    return densest ? count(n) : tree_cost(n) + of_columns * (count(n) + cost_of_rest(n, lanes));
  };
  const std::int64_t length_x = lanes * cheapest_length((nx + lanes - 1) / lanes, cost);
  const double nodes = static_cast<double>(length_x) * static_cast<double>(length_y);
  const double nodes_by_fftw = static_cast<double>(good_size(nx)) * static_cast<double>(good_size(ny));
  if (must_pay && nodes > kAdvantage * nodes_by_fftw) return nullptr;
  return std::make_unique<const ByLanes<Real>>(kernels, nx, ny, length_x, length_y, boundary);
}

template std::unique_ptr<const LaneCarrier<double>> lane_carrier<double>(const simd::TransformKernels<double>&,
                                                                         std::int64_t, std::int64_t, Boundary, bool,
                                                                         bool);
template std::unique_ptr<const LaneCarrier<float>> lane_carrier<float>(const simd::TransformKernels<float>&,
                                                                       std::int64_t, std::int64_t, Boundary, bool,
                                                                       bool);

}  // namespace brinell::fft
