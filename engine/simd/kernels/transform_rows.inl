// Transforms of rows to and from the field (RowTransform in transform_kernels.h). A row stays in the nearest cache:
//
//   row of reals  --tree-->  z[position][re, im][lane]  --transpose, last stage-->  field [block][row][re, im][lane]
#pragma once

#include <cstring>

#include "simd/kernels/transform_columns.inl"

namespace brinell::simd {
namespace {

/// Stores past the caches, where the registers of one complex vector fill whole cache lines.
template <std::size_t R, class V, class Real>
[[gnu::always_inline]] inline void stream_parts(const Complex<V> (&x)[R], Real* z, std::int64_t stride) {
  unrolled<R>([&](auto s) __attribute__((always_inline)) {
    Real* part = z + static_cast<std::int64_t>(s) * stride;
    put<true>(x[s].re, part);
    put<true>(x[s].im, part + V::size);
  });
}

/// The last stage, of radix `lanes`: z -> row j of every block. `field` points to the row in block 0. Meanwhile a row
/// to come is fetched: the first stage reads it in several places at once, which the hardware does not foresee.
template <class Arch, class Real>
void lanes_forward(const RowTransform<Real>& transform, const Real* z, Real* field, Prefetch coming) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const Real* twiddles = transform.lane_twiddles;
  const std::int64_t groups = transform.positions / lanes;
  for (std::int64_t group = 0; group < groups; ++group) {
    coming.share(lanes);
    Complex<V> x[lanes];
    load_parts(x, z, 2 * lanes);
    transpose<1>(x);
    unrolled<lanes - 1>([&](auto s) __attribute__((always_inline)) {
      const Complex<V> w = load<V>(twiddles + static_cast<std::int64_t>(s) * 2 * lanes);
      x[s + 1] = times(x[s + 1], w.re, w.im);
    });
    dft<-1>(x);
    if (transform.past_caches) {
      stream_parts(x, field, transform.block_stride);
    } else {
      store_parts(x, field, transform.block_stride);
    }
    z += 2 * lanes * lanes;
    twiddles += 2 * lanes * (lanes - 1);
    field += lanes * transform.block_stride;
  }
  const Real* rest = transform.rest_twiddles;
  for (std::int64_t p = groups * lanes; p < transform.positions; ++p) {
    Complex<Real> x[lanes];
    unrolled<lanes>([&](auto s) __attribute__((always_inline)) { x[s] = {z[s], z[lanes + s]}; });
    unrolled<lanes - 1>([&](auto s) __attribute__((always_inline)) {
      x[s + 1] = times(x[s + 1], rest[2 * s], rest[2 * s + 1]);
    });
    dft<-1>(x);
    unrolled<lanes>([&](auto s) __attribute__((always_inline)) {
      field[s] = x[s].re;
      field[lanes + s] = x[s].im;
    });
    z += 2 * lanes;
    rest += 2 * (lanes - 1);
    field += transform.block_stride;
  }
}

/// Fetches the same group of a row to come into the second-level cache: its parts lie far apart, out of reach of the
/// hardware's prefetching.
template <class Arch, class Real>
[[gnu::always_inline]] inline void fetch_ahead(const RowTransform<Real>& transform, const Real* field) {
  constexpr std::int64_t step = 2 * kLanes<Arch, Real>;
  constexpr std::int64_t rows_ahead = 3;
  for (std::int64_t t = 0; t < kLanes<Arch, Real>; ++t) {
    const char* part = reinterpret_cast<const char*>(field + t * transform.block_stride + rows_ahead * step);
    for (std::size_t byte = 0; byte < step * sizeof(Real); byte += 64) __builtin_prefetch(part + byte, 0, 2);
  }
}

template <class Arch, class Real>
void lanes_backward(const RowTransform<Real>& transform, const Real* field, Real* z) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const Real* twiddles = transform.lane_twiddles;
  const std::int64_t groups = transform.positions / lanes;
  for (std::int64_t group = 0; group < groups; ++group) {
    Complex<V> x[lanes];
    load_parts(x, field, transform.block_stride);
    fetch_ahead<Arch>(transform, field);
    dft<1>(x);
    unrolled<lanes - 1>([&](auto s) __attribute__((always_inline)) {
      const Complex<V> w = load<V>(twiddles + static_cast<std::int64_t>(s) * 2 * lanes);
      x[s + 1] = times_conjugate(x[s + 1], w.re, w.im);
    });
    transpose<1>(x);
    store_parts(x, z, 2 * lanes);
    z += 2 * lanes * lanes;
    twiddles += 2 * lanes * (lanes - 1);
    field += lanes * transform.block_stride;
  }
  const Real* rest = transform.rest_twiddles;
  for (std::int64_t p = groups * lanes; p < transform.positions; ++p) {
    Complex<Real> x[lanes];
    unrolled<lanes>([&](auto s) __attribute__((always_inline)) { x[s] = {field[s], field[lanes + s]}; });
    dft<1>(x);
    unrolled<lanes - 1>([&](auto s) __attribute__((always_inline)) {
      x[s + 1] = times_conjugate(x[s + 1], rest[2 * s], rest[2 * s + 1]);
    });
    unrolled<lanes>([&](auto s) __attribute__((always_inline)) {
      z[s] = x[s].re;
      z[lanes + s] = x[s].im;
    });
    z += 2 * lanes;
    rest += 2 * (lanes - 1);
    field += transform.block_stride;
  }
}

/// A free row: the first stage takes the real values, the others follow.
template <class Arch, class Real>
void tree_of_reals_forward(const TransformTree<Real>& tree, const Real* row, Real* z) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  if (tree.stages == 0) return store(z, Complex<V>{V::load_unaligned(row), V(Real{0})});
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = tree.length / R;
    split_real<Arch, R>(row, lanes, tree.length, h, tree.twiddles[0], z);
    for (std::int64_t t = 0; t < R; ++t) tree_forward<Arch>(tree, 1, t, h, z + t * h * 2 * lanes);
  });
}
template <class Arch, bool past_caches, class Real>
void tree_of_reals_backward(const TransformTree<Real>& tree, Real* z, Real* row) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  if (tree.stages == 0) return put<past_caches>(V::load_aligned(z), row);
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = tree.length / R;
    for (std::int64_t t = 0; t < R; ++t) tree_backward<Arch>(tree, 1, t, h, z + t * h * 2 * lanes);
    join_real<Arch, R, past_caches>(row, lanes, tree.length, h, tree.twiddles[0], z);
  });
}

/// A periodic row. Each piece but the last takes, of the quarters a b c d of what is left of the row, the complex
/// numbers (a − c) − i (b − d), and leaves a + c, b + d. `sums` holds what is left: half a row, then a quarter …
template <class Arch, class Real>
void pieces_forward(const RowTransform<Real>& transform, const Real* row, Real* z, Real* sums) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  std::int64_t left = transform.length;
  for (std::int32_t piece = 0; piece + 1 < transform.pieces; ++piece) {
    const std::int64_t quarter = left / 4;
    for (std::int64_t i = 0; i < quarter; i += lanes) {
      const V a = V::load_unaligned(row + i), b = V::load_unaligned(row + quarter + i);
      const V c = V::load_unaligned(row + 2 * quarter + i), d = V::load_unaligned(row + 3 * quarter + i);
      store(z + 2 * i, Complex<V>{a - c, d - b});
      (a + c).store_aligned(sums + i);
      (b + d).store_aligned(sums + quarter + i);
    }
    tree_forward<Arch>(transform.tree[piece], 0, 0, transform.tree[piece].length, z);
    z += 2 * quarter;
    row = sums;
    left /= 2;
  }
  const TransformTree<Real>& last = transform.tree[transform.pieces - 1];
  for (std::int64_t i = 0; i < left; i += lanes) {
    store(z + 2 * i, Complex<V>{V::load_unaligned(row + i), V(Real{0})});
  }
  tree_forward<Arch>(last, 0, 0, last.length, z);
}
/// The quarters a b c d from (a − c) − i (b − d) in z and a + c, b + d in `sums`, all twice as large there.
template <class V, bool past_caches, class Real>
[[gnu::always_inline]] inline void put_quarters(const Real* z, std::int64_t quarter, const Real* sums, Real* row) {
  for (std::int64_t i = 0; i < quarter; i += static_cast<std::int64_t>(V::size)) {
    const Complex<V> difference = load<V>(z + 2 * i);
    const V first = V::load_unaligned(sums + i), second = V::load_unaligned(sums + quarter + i);
    put<past_caches>(first + difference.re, row + i);
    put<past_caches>(second - difference.im, row + quarter + i);
    put<past_caches>(first - difference.re, row + 2 * quarter + i);
    put<past_caches>(second + difference.im, row + 3 * quarter + i);
  }
}
/// The reverse: from the last piece to the first, each doubling the length of what is put together, in `sums` until
/// the first piece makes the row of it.
template <class Arch, bool past_caches, class Real>
void pieces_backward(const RowTransform<Real>& transform, Real* z, Real* row, Real* sums) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const TransformTree<Real>& last = transform.tree[transform.pieces - 1];
  z += (transform.positions - last.length) * 2 * lanes;
  tree_backward<Arch>(last, 0, 0, last.length, z);
  Real* const start = transform.pieces == 1 ? row : sums;
  for (std::int64_t p = 0; p < last.length; ++p)
    V::load_aligned(z + p * 2 * lanes).store_unaligned(start + p * lanes);
  for (std::int32_t piece = transform.pieces - 2; piece >= 0; --piece) {
    const std::int64_t quarter = transform.tree[piece].length * lanes;
    z -= 2 * quarter;
    tree_backward<Arch>(transform.tree[piece], 0, 0, transform.tree[piece].length, z);
    if (piece > 0) {
      put_quarters<V, false>(z, quarter, sums, sums);
    } else {
      put_quarters<V, past_caches>(z, quarter, sums, row);
    }
  }
}

/// The row two after row j, if any: fetching what is not there does no harm.
template <class Real>
Prefetch row_to_come(const RowTransform<Real>& transform, const Real* source, std::int64_t j) {
  const std::int64_t bytes = transform.nx * static_cast<std::int64_t>(sizeof(Real));
  const auto address = reinterpret_cast<std::uintptr_t>(source) + static_cast<std::uintptr_t>((j + 2) * bytes);
  return {reinterpret_cast<const char*>(address), bytes / transform.positions};
}

template <class Arch, class Real>
void rows_forward(const RowTransform<Real>& transform, std::int64_t begin, std::int64_t end, const Real* source,
                  Real* field, Real* scratch) {
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  Real* z = scratch;
  Real* padded = scratch + 2 * lanes * transform.positions;
  const auto given = static_cast<std::size_t>(transform.nx);
  if (transform.nx < transform.length) {
    std::memset(padded + given, 0, sizeof(Real) * static_cast<std::size_t>(transform.length - transform.nx));
  }
  for (std::int64_t j = begin; j < end; ++j) {
    const Real* row = source + j * transform.nx;
    if (transform.nx < transform.length) {
      std::memcpy(padded, row, sizeof(Real) * given);
      row = padded;
    }
    if (transform.pieces == 0) {
      tree_of_reals_forward<Arch>(transform.tree[0], row, z);
    } else {
      pieces_forward<Arch>(transform, row, z, padded);
    }
    lanes_forward<Arch>(transform, z, field + j * 2 * lanes, row_to_come(transform, source, j));
  }
  if (transform.past_caches) finish_streams();
}

template <class Arch, bool past_caches, class Real>
void row_backward(const RowTransform<Real>& transform, Real* z, Real* row, Real* scratch) {
  if (transform.pieces == 0) {
    tree_of_reals_backward<Arch, past_caches>(transform.tree[0], z, row);
  } else {
    pieces_backward<Arch, past_caches>(transform, z, row, scratch);
  }
}

template <class Arch, class Real>
void rows_backward(const RowTransform<Real>& transform, std::int64_t begin, std::int64_t end, const Real* field,
                   Real* result, Real* scratch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  Real* z = scratch;
  Real* padded = scratch + 2 * lanes * transform.positions;
  // Only whole cache lines go past the caches.
  const bool whole_lines = sizeof(V) == 64 && transform.nx == transform.length &&
                           reinterpret_cast<std::uintptr_t>(result) % sizeof(V) == 0;
  const bool past_caches = transform.past_caches && whole_lines;
  for (std::int64_t j = begin; j < end; ++j) {
    lanes_backward<Arch>(transform, field + j * 2 * lanes, z);
    Real* row = result + j * transform.nx;
    if (past_caches) {
      row_backward<Arch, true>(transform, z, row, padded);
    } else if (transform.nx == transform.length) {
      row_backward<Arch, false>(transform, z, row, padded);
    } else {
      row_backward<Arch, false>(transform, z, padded, padded);
      std::memcpy(row, padded, sizeof(Real) * static_cast<std::size_t>(transform.nx));
    }
  }
  if (past_caches) finish_streams();
}

}  // namespace
}  // namespace brinell::simd
