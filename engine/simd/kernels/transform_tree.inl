// The stages of a transform tree (transform_kernels.h) over complex vectors z[position][re, im][lane], walked depth
// first: a node is finished, down to its leaves, while it lies in the nearest cache.
#pragma once

#include "simd/kernels/transform_dft.inl"
#include "simd/transform_kernels.h"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
using Batch = xsimd::batch<Real, Arch>;

template <class Arch, class Real>
inline constexpr std::int64_t kLanes = static_cast<std::int64_t>(Batch<Arch, Real>::size);

/// Makes the compiler keep a value in a register, where gcc would rather load it anew for each of its uses.
template <class Register>
[[gnu::always_inline]] inline void keep(Register& value) {
#if defined(__x86_64__)
  asm("" : "+v"(value));
#else
  static_cast<void>(value);
#endif
}

template <class V, class Real>
[[gnu::always_inline]] inline Complex<V> load(const Real* z) {
  typename V::register_type re = V::load_aligned(z), im = V::load_aligned(z + V::size);
  keep(re);
  keep(im);
  return {V(re), V(im)};
}
template <class V, class Real>
[[gnu::always_inline]] inline void store(Real* z, const Complex<V>& value) {
  value.re.store_aligned(z);
  value.im.store_aligned(z + V::size);
}

/// Stores a register; `past_caches`: around the caches, to a place aligned to it.
template <bool past_caches, class V, class Real>
[[gnu::always_inline]] inline void put(const V& value, Real* place) {
  if constexpr (past_caches) {
#if defined(__AVX512F__)
    _mm512_stream_si512(reinterpret_cast<__m512i*>(place), __m512i(typename V::register_type(value)));
#elif defined(__AVX2__)
    _mm256_stream_si256(reinterpret_cast<__m256i*>(place), __m256i(typename V::register_type(value)));
#else
    value.store_aligned(place);
#endif
  } else {
    value.store_unaligned(place);
  }
}
/// Makes what went past the caches visible to other threads.
inline void finish_streams() {
#if defined(__AVX2__)
  _mm_sfence();
#endif
}

/// x_s := c^s x_s, and the transform of the node.
template <std::size_t R, class V, class Real>
[[gnu::always_inline]] inline void split(Complex<V> (&x)[R], const Real* twiddles) {
  unrolled<R - 1>([&](auto s) __attribute__((always_inline)) {
    x[s + 1] = times(x[s + 1], V(twiddles[2 * s]), V(twiddles[2 * s + 1]));
  });
  dft<-1>(x);
}
/// The reverse, times R.
template <std::size_t R, class V, class Real>
[[gnu::always_inline]] inline void join(Complex<V> (&x)[R], const Real* twiddles) {
  dft<1>(x);
  unrolled<R - 1>([&](auto s) __attribute__((always_inline)) {
    x[s + 1] = times_conjugate(x[s + 1], V(twiddles[2 * s]), V(twiddles[2 * s + 1]));
  });
}

template <std::size_t R, class V, class Real>
[[gnu::always_inline]] inline void load_parts(Complex<V> (&x)[R], const Real* z, std::int64_t stride) {
  unrolled<R>([&](auto s)
                  __attribute__((always_inline)) { x[s] = load<V>(z + static_cast<std::int64_t>(s) * stride); });
}
template <std::size_t R, class V, class Real>
[[gnu::always_inline]] inline void store_parts(const Complex<V> (&x)[R], Real* z, std::int64_t stride) {
  unrolled<R>([&](auto s) __attribute__((always_inline)) { store(z + static_cast<std::int64_t>(s) * stride, x[s]); });
}

/// One stage on one node whose parts are h positions long.
template <class Arch, std::size_t R, class Real>
void split_node(Real* z, std::int64_t h, const Real* twiddles) {
  using V = Batch<Arch, Real>;
  const std::int64_t stride = 2 * kLanes<Arch, Real> * h;
  for (const Real* end = z + stride; z != end; z += 2 * kLanes<Arch, Real>) {
    Complex<V> x[R];
    load_parts(x, z, stride);
    split(x, twiddles);
    store_parts(x, z, stride);
  }
}
template <class Arch, std::size_t R, class Real>
void join_node(Real* z, std::int64_t h, const Real* twiddles) {
  using V = Batch<Arch, Real>;
  const std::int64_t stride = 2 * kLanes<Arch, Real> * h;
  for (const Real* end = z + stride; z != end; z += 2 * kLanes<Arch, Real>) {
    Complex<V> x[R];
    load_parts(x, z, stride);
    join(x, twiddles);
    store_parts(x, z, stride);
  }
}

/// Calls body with the radix as a compile-time constant.
template <class Body>
[[gnu::always_inline]] inline void with_radix(std::int32_t radix, Body&& body) {
  switch (radix) {
    case 2: return body(std::integral_constant<std::size_t, 2>{});
    case 3: return body(std::integral_constant<std::size_t, 3>{});
    case 4: return body(std::integral_constant<std::size_t, 4>{});
    case 5: return body(std::integral_constant<std::size_t, 5>{});
    default: return body(std::integral_constant<std::size_t, 8>{});
  }
}

/// Node `node` of stage `stage`, `length` positions from z on, down to the leaves.
template <class Arch, class Real>
void tree_forward(const TransformTree<Real>& tree, std::int32_t stage, std::int64_t node, std::int64_t length,
                  Real* z) {
  if (stage == tree.stages) return;
  with_radix(tree.radix[stage], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = length / R;
    split_node<Arch, R>(z, h, tree.twiddles[stage] + node * 2 * (R - 1));
    if (h == 1) return;
    for (std::int64_t t = 0; t < R; ++t) {
      tree_forward<Arch>(tree, stage + 1, node * R + t, h, z + t * h * 2 * kLanes<Arch, Real>);
    }
  });
}

template <class Arch, class Real>
void tree_backward(const TransformTree<Real>& tree, std::int32_t stage, std::int64_t node, std::int64_t length,
                   Real* z) {
  if (stage == tree.stages) return;
  with_radix(tree.radix[stage], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = length / R;
    if (h > 1) {
      for (std::int64_t t = 0; t < R; ++t) {
        tree_backward<Arch>(tree, stage + 1, node * R + t, h, z + t * h * 2 * kLanes<Arch, Real>);
      }
    }
    join_node<Arch, R>(z, h, tree.twiddles[stage] + node * 2 * (R - 1));
  });
}

}  // namespace
}  // namespace brinell::simd
