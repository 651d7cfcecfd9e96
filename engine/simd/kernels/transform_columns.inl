// Convolution along the columns of one block, in cache: forward through the tree, at the leaves times the spectrum,
// and backward. Forward leaf, product and backward leaf are one step in registers.
#pragma once

#include "simd/kernels/transform_tree.inl"

namespace brinell::simd {
namespace {

/// Memory to be fetched while the leaves are worked on, evenly, a share with each leaf.
struct Prefetch {
  const char* next;
  std::int64_t bytes_per_position;

  [[gnu::always_inline]] inline void share(std::int64_t positions) {
    if (next == nullptr) return;
    const char* const end = next + positions * bytes_per_position;
    for (; next < end; next += 64) __builtin_prefetch(next, 0, 2);
  }
};

template <bool turn, class V>
[[gnu::always_inline]] inline Complex<V> product(const Complex<V>& x, const V& spectrum) {
  if constexpr (turn) {
    return {spectrum * x.im, -(spectrum * x.re)};
  } else {
    return {spectrum * x.re, spectrum * x.im};
  }
}

/// `count` neighbouring leaves of radix R, from node `node` of the last stage on.
template <class Arch, std::size_t R, bool turn, class Real>
void convolve_leaves(const Real* twiddles, std::int64_t count, Real* z, const Real* spectrum, Prefetch& prefetch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  for (std::int64_t leaf = 0; leaf < count; ++leaf) {
    prefetch.share(R);
    Complex<V> x[R];
    load_parts(x, z, 2 * lanes);
    split(x, twiddles);
    unrolled<R>([&](auto s) __attribute__((always_inline)) {
      x[s] = product<turn>(x[s], V::load_aligned(spectrum + static_cast<std::int64_t>(s) * lanes));
    });
    join(x, twiddles);
    store_parts(x, z, 2 * lanes);
    z += R * 2 * lanes;
    spectrum += R * lanes;
    twiddles += 2 * (R - 1);
  }
}

/// `count` neighbouring nodes of a stage, each of `length` positions: forward, product, backward.
template <class Arch, bool turn, class Real>
void convolve_nodes(const TransformTree<Real>& tree, std::int32_t stage, std::int64_t node, std::int64_t count,
                    std::int64_t length, Real* z, const Real* spectrum, Prefetch& prefetch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  if (stage == tree.stages) {  // every position is a leaf of its own
    for (std::int64_t p = 0; p < count; ++p) {
      store(z + p * 2 * lanes, product<turn>(load<V>(z + p * 2 * lanes), V::load_aligned(spectrum + p * lanes)));
    }
    return;
  }
  with_radix(tree.radix[stage], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const Real* twiddles = tree.twiddles[stage] + node * 2 * (R - 1);
    const std::int64_t h = length / R;
    if (h == 1) return convolve_leaves<Arch, R, turn>(twiddles, count, z, spectrum, prefetch);
    for (std::int64_t n = 0; n < count; ++n) {
      split_node<Arch, R>(z, h, twiddles);
      convolve_nodes<Arch, turn>(tree, stage + 1, (node + n) * R, R, h, z, spectrum, prefetch);
      join_node<Arch, R>(z, h, twiddles);
      z += length * 2 * lanes;
      spectrum += length * lanes;
      twiddles += 2 * (R - 1);
    }
  });
}

/// One step of the first stage of a real sequence: part s lies `part` Reals after part s − 1. Only the first `given`
/// parts are there, the rest is zero.
template <class V, std::size_t R, bool all, class Real>
[[gnu::always_inline]] inline void split_real_step(const Real* row, std::int64_t part, std::int64_t given,
                                                   const Real* twiddles, Real* z, std::int64_t z_part) {
  Complex<V> x[R];
  unrolled<R>([&](auto s) __attribute__((always_inline)) {
    const bool there = all || static_cast<std::int64_t>(s) < given;
    const V value = there ? V::load_unaligned(row + static_cast<std::int64_t>(s) * part) : V(Real{0});
    if constexpr (s == 0) {
      x[s] = {value, V(Real{0})};
    } else {
      x[s] = {value * V(twiddles[2 * s - 2]), value * V(twiddles[2 * s - 1])};
    }
  });
  dft<-1>(x);
  store_parts(x, z, z_part);
}
/// The reverse, of which only the real part of the given rows is wanted.
template <class V, std::size_t R, bool all, bool past_caches, class Real>
[[gnu::always_inline]] inline void join_real_step(Real* row, std::int64_t part, std::int64_t given,
                                                  const Real* twiddles, const Real* z, std::int64_t z_part) {
  Complex<V> x[R];
  load_parts(x, z, z_part);
  dft<1>(x);
  unrolled<R>([&](auto s) __attribute__((always_inline)) {
    if (!all && static_cast<std::int64_t>(s) >= given) return;
    Real* place = row + static_cast<std::int64_t>(s) * part;
    if constexpr (s == 0) {
      put<past_caches>(x[s].re, place);
    } else {
      put<past_caches>(x[s].re * V(twiddles[2 * s - 2]) + x[s].im * V(twiddles[2 * s - 1]), place);
    }
  });
}

/// The first stage of a real sequence of R·h rows, `stride` Reals apart, of which the first `ny` are given. Each part
/// of z is followed by a gap.
template <class Arch, std::size_t R, class Real>
void split_real(const Real* rows, std::int64_t stride, std::int64_t ny, std::int64_t h, const Real* twiddles, Real* z,
                std::int64_t gap = 0) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t step = 2 * kLanes<Arch, Real>;
  const std::int64_t part = h * step + gap;
  const std::int64_t all = ny - static_cast<std::int64_t>(R - 1) * h;  // steps with every part given
  std::int64_t j = 0;
  for (; j < all; ++j) split_real_step<V, R, true>(rows + j * stride, h * stride, R, twiddles, z + j * step, part);
  for (; j < h; ++j) {
    split_real_step<V, R, false>(rows + j * stride, h * stride, (ny - j + h - 1) / h, twiddles, z + j * step, part);
  }
}
template <class Arch, std::size_t R, bool past_caches = false, class Real>
void join_real(Real* rows, std::int64_t stride, std::int64_t ny, std::int64_t h, const Real* twiddles, const Real* z,
               std::int64_t gap = 0) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t step = 2 * kLanes<Arch, Real>;
  const std::int64_t part = h * step + gap;
  const std::int64_t all = ny - static_cast<std::int64_t>(R - 1) * h;
  std::int64_t j = 0;
  for (; j < all; ++j) {
    join_real_step<V, R, true, past_caches>(rows + j * stride, h * stride, R, twiddles, z + j * step, part);
  }
  for (; j < h; ++j) {
    join_real_step<V, R, false, past_caches>(rows + j * stride, h * stride, (ny - j + h - 1) / h, twiddles,
                                             z + j * step, part);
  }
}

template <class Arch, bool turn, class Real>
void convolve_real(const TransformTree<Real>& tree, std::int64_t ny, Real* rows, const Real* spectrum, Real* scratch,
                   Prefetch prefetch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  if (tree.stages == 0) {  // one value: its transform is itself, and −i times a real number has no real part
    const V value = V::load_aligned(rows);
    (turn ? V(Real{0}) : value * V::load_aligned(spectrum)).store_aligned(rows);
    return;
  }
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    constexpr std::int64_t gap = 2 * lanes;  // equal places of long parts would all fall into the same cache set
    const std::int64_t h = tree.length / R;
    split_real<Arch, R>(rows, 2 * lanes, ny, h, tree.twiddles[0], scratch, gap);
    for (std::int64_t t = 0; t < R; ++t) {
      convolve_nodes<Arch, turn>(tree, 1, t, 1, h, scratch + t * (2 * lanes * h + gap), spectrum + t * h * lanes,
                                 prefetch);
    }
    join_real<Arch, R>(rows, 2 * lanes, ny, h, tree.twiddles[0], scratch, gap);
  });
}

template <class Arch, class Real>
void free_block(const ColumnTransform<Real>& transform, const BlockProduct<Real>& product, Real* field,
                Real* scratch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const auto bytes = static_cast<std::int64_t>(sizeof(Real)) * lanes;
  const Prefetch ahead[2] = {{reinterpret_cast<const char*>(product.next_field), 2 * bytes},
                             {reinterpret_cast<const char*>(product.next_spectrum), bytes}};
  for (int part = 0; part < 2; ++part) {
    if (product.turn_y) {
      convolve_real<Arch, true>(transform.tree, transform.ny, field + part * lanes, product.spectrum, scratch,
                                ahead[part]);
    } else {
      convolve_real<Arch, false>(transform.tree, transform.ny, field + part * lanes, product.spectrum, scratch,
                                 ahead[part]);
    }
  }
  if (!product.turn_x) return;
  for (std::int64_t j = 0; j < transform.ny; ++j, field += 2 * lanes) {
    store(field, turned<-1>(load<V>(field)));
  }
}

template <class Arch, class Real>
void periodic_block(const ColumnTransform<Real>& transform, const BlockProduct<Real>& product, Real* field) {
  const auto bytes = static_cast<std::int64_t>(sizeof(Real)) * kLanes<Arch, Real>;
  Prefetch prefetch{reinterpret_cast<const char*>(product.next_field), 2 * bytes};
  const auto convolve = product.turn_y ? convolve_nodes<Arch, true, Real> : convolve_nodes<Arch, false, Real>;
  convolve(transform.tree, 0, 0, 1, transform.tree.length, field, product.spectrum, prefetch);
}

}  // namespace
}  // namespace brinell::simd
