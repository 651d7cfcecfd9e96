// The lane transform: Fourier transforms whose SIMD lanes hold independent sequences, so that no arithmetic ever
// crosses lanes. A "vector" is `lanes` Reals; a complex vector is [re: lanes][im: lanes]. fft/lane_carrier.h tells
// how a convolution is made of it.
//
// The tree. Transforming n values z_0 … z_{n−1} is evaluating the polynomial Σ z_j x^j at the n roots of
// x^n = e(θ), e(θ) = exp(−2πi θ). A node of the tree is the polynomial reduced modulo x^m − e(θ); a stage of radix R
// splits it into R nodes of length h = m/R with x^h = e((θ + t)/R), t = 0 … R−1:
//
//   node θ:   | z_0 … z_{h−1} | z_h … z_{2h−1} | …            |        c = e(θ/R),
//                   \               |              /                   z'_t,j = Σ_s (c^s z_{sh+j}) e(st/R)
//   R nodes:  |   t = 0       |   t = 1        | …            |        (in place of the R parts)
//
// until h = 1. Twiddle factors c^s belong to the node and not to j: they are loaded once for a whole loop, and any
// θ costs the same, so θ = 1/4 (free boundary) needs no pass of its own. Values come out in the order of the tree;
// the backward transform undoes the stages in reverse, so nothing is ever sorted.
#pragma once

#include <cstdint>

namespace brinell::simd {

inline constexpr int kMaxStages = 24;
inline constexpr int kMaxPieces = 24;
inline constexpr int kMaxRadix = 8;

/// A tree of given length and root; see above. Radices are 2, 3, 4, 5 or 8.
template <class Real>
struct TransformTree {
  std::int64_t length;  // product of the radices
  std::int32_t stages;  // 0 for length 1
  std::int32_t radix[kMaxStages];
  const Real* twiddles[kMaxStages];  // [node of the stage][s = 1 … radix−1][re, im] of c^s
};

/// Transform along rows. Lane i0 of vector i1 is node i = i1·lanes + i0, so the tree over i1 leaves, at each of its
/// positions, `lanes` coefficients of a polynomial modulo x^lanes − e(θ). The last stage, of radix `lanes`, first
/// transposes groups of `lanes` positions; its outputs t are then vectors whose lanes are positions. Positions left
/// over from the groups are finished one by one; their lanes are t.
///
/// A periodic row of real values is split before: modulo x^N − 1 = (x^{N/2} − 1)(x^{N/2} + 1), the second factor
/// again into a pair of conjugates, of which x^{N/4} + i is kept: a piece of N/4 complex values with θ = 1/4. The
/// first factor is split in the same way as often as whole vectors last; what remains is the last piece, θ = 0.
template <class Real>
struct RowTransform {
  std::int64_t nx;            // values of a row; zeros follow up to `length`
  std::int64_t length;        // multiple of lanes
  std::int64_t positions;     // over all pieces
  std::int64_t block_stride;  // of the field [block][row][re, im], in Reals; one block = one vector of frequencies
  bool past_caches;           // field and result are too large to stay in cache: they are written around it
  std::int32_t pieces;        // 0: free boundary, tree[0] takes the row as it is
  TransformTree<Real> tree[kMaxPieces];
  const Real* lane_twiddles;  // [group][s = 1 … lanes−1][re, im][lane]
  const Real* rest_twiddles;  // [position after the groups][s = 1 … lanes−1][re, im]
};

/// Transform along columns of one block. Free boundary: real and imaginary part of the field are two real
/// sequences of ny values, followed by zeros. Periodic: one complex sequence of tree.length values.
template <class Real>
struct ColumnTransform {
  std::int64_t ny;
  TransformTree<Real> tree;
};

/// What one block is multiplied with, and what comes after it in memory, to be fetched meanwhile.
template <class Real>
struct BlockProduct {
  const Real* spectrum;       // [position][lane]
  bool turn_x;                // times −i in the complex numbers of the x transform (kernel odd in x)
  bool turn_y;                // times −i in those of the y transform (kernel odd in y); periodic: in the only ones
  const Real* next_field;     // may be null
  const Real* next_spectrum;  // may be null
};

/// One term of a sum of products in one block: a transformed source and the spectrum it is multiplied with.
template <class Real>
struct BlockTerm {
  const Real* transform;  // free: [part: re, im of the field][position][re, im][lane]; periodic: one such part
  const Real* spectrum;   // [position][lane]
  bool turn_x;            // as in BlockProduct
  bool turn_y;
};

template <class Real>
struct TransformKernels {
  std::int64_t lanes;

  /// Rows begin … end − 1 of source (or result) to and from the field. scratch: 3·length Reals.
  void (*rows_forward)(const RowTransform<Real>& transform, std::int64_t begin, std::int64_t end, const Real* source,
                       Real* field, Real* scratch);
  void (*rows_backward)(const RowTransform<Real>& transform, std::int64_t begin, std::int64_t end, const Real* field,
                        Real* result, Real* scratch);

  /// Forward, times spectrum, backward, in place on one block of the field. scratch:
  /// 2·lanes·(length + kMaxRadix) Reals.
  void (*free_block)(const ColumnTransform<Real>& transform, const BlockProduct<Real>& product, Real* field,
                     Real* scratch);
  void (*periodic_block)(const ColumnTransform<Real>& transform, const BlockProduct<Real>& product, Real* field);

  /// The two halves apart: forward from the field to a transform as in BlockTerm; and a sum of products, backward,
  /// to the field. The same scratch.
  void (*free_forward)(const ColumnTransform<Real>& transform, const Real* field, Real* transformed);
  void (*free_sum)(const ColumnTransform<Real>& transform, const BlockTerm<Real>* terms, std::int64_t count,
                   Real* field, Real* scratch);
  /// One block of a kernel's spectrum from the field of its quarter: of the real (odd: minus the imaginary) parts of
  /// both transforms, times scale. scratch: 2·lanes·length Reals.
  void (*free_spectrum)(const ColumnTransform<Real>& transform, const Real* field, bool odd_x, bool odd_y, Real scale,
                        Real* spectrum, Real* scratch);
  void (*periodic_forward)(const ColumnTransform<Real>& transform, const Real* field, Real* transformed);
  void (*periodic_sum)(const ColumnTransform<Real>& transform, const BlockTerm<Real>* terms, std::int64_t count,
                       Real* field);
};

}  // namespace brinell::simd
