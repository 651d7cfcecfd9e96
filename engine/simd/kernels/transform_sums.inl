// The two halves of a convolution along the columns of a block, apart: a source is transformed once, and each result
// is a sum of transformed sources times spectra, transformed back.
#pragma once

#include <cstring>

#include "simd/kernels/transform_columns.inl"

namespace brinell::simd {
namespace {

/// z[position] = (`more`: +=) sign · spectrum · x, times −i if `turn`.
template <class Arch, bool turn, bool more, class Real>
void put_product(const Real* x, const Real* spectrum, Real sign, std::int64_t positions, Real* z) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  for (std::int64_t p = 0; p < positions; ++p) {
    const V factor = V(sign) * V::load_aligned(spectrum + p * lanes);
    const Complex<V> term = product<turn>(load<V>(x + p * 2 * lanes), factor);
    store(z + p * 2 * lanes, more ? load<V>(z + p * 2 * lanes) + term : term);
  }
}

/// z = the sum of all terms for one part of the field (0: real, 1: imaginary). −i (re + i im) = im − i re.
template <class Arch, class Real>
void sum_of_products(const BlockTerm<Real>* terms, std::int64_t count, std::int64_t part, std::int64_t positions,
                     Real* z) {
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  constexpr std::int64_t together = 32;  // positions, so that z stays near while the terms come in
  for (std::int64_t first = 0; first < positions; first += together) {
    const std::int64_t some = positions - first < together ? positions - first : together;
    Real* sum = z + first * 2 * lanes;
    for (const BlockTerm<Real>* term = terms; term != terms + count; ++term) {
      const std::int64_t from = term->turn_x ? 1 - part : part;
      const Real sign = term->turn_x && part == 1 ? Real{-1} : Real{1};
      const Real* x = term->transform + (from * positions + first) * 2 * lanes;
      const Real* spectrum = term->spectrum + first * lanes;
      if (term == terms) {
        const auto put = term->turn_y ? put_product<Arch, true, false, Real> : put_product<Arch, false, false, Real>;
        put(x, spectrum, sign, some, sum);
      } else {
        const auto add = term->turn_y ? put_product<Arch, true, true, Real> : put_product<Arch, false, true, Real>;
        add(x, spectrum, sign, some, sum);
      }
    }
  }
}

/// One part of the field (0: real, 1: imaginary), in which `field` begins.
template <class Arch, class Real>
void forward_of_part(const ColumnTransform<Real>& transform, const Real* field, Real* transformed) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const TransformTree<Real>& tree = transform.tree;
  if (tree.stages == 0) return store(transformed, Complex<V>{V::load_aligned(field), V(Real{0})});
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = tree.length / R;
    split_real<Arch, R>(field, 2 * lanes, transform.ny, h, tree.twiddles[0], transformed);
    for (std::int64_t t = 0; t < R; ++t) tree_forward<Arch>(tree, 1, t, h, transformed + t * h * 2 * lanes);
  });
}

template <class Arch, class Real>
void free_forward(const ColumnTransform<Real>& transform, const Real* field, Real* transformed) {
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  forward_of_part<Arch>(transform, field, transformed);
  forward_of_part<Arch>(transform, field + lanes, transformed + transform.tree.length * 2 * lanes);
}

template <class Arch, class Real>
void free_spectrum(const ColumnTransform<Real>& transform, const Real* field, bool odd_x, bool odd_y, Real scale,
                   Real* spectrum, Real* scratch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  forward_of_part<Arch>(transform, field + (odd_x ? lanes : 0), scratch);
  const V factor(odd_x == odd_y ? scale : -scale);
  for (std::int64_t p = 0; p < transform.tree.length; ++p) {
    const V value = V::load_aligned(scratch + p * 2 * lanes + (odd_y ? lanes : 0));
    (factor * value).store_aligned(spectrum + p * lanes);
  }
}

template <class Arch, class Real>
void free_sum(const ColumnTransform<Real>& transform, const BlockTerm<Real>* terms, std::int64_t count, Real* field,
              Real* scratch) {
  using V = Batch<Arch, Real>;
  constexpr std::int64_t lanes = kLanes<Arch, Real>;
  const TransformTree<Real>& tree = transform.tree;
  for (std::int64_t part = 0; part < 2; ++part, field += lanes) {
    sum_of_products<Arch>(terms, count, part, tree.length, scratch);
    if (tree.stages == 0) {
      V::load_aligned(scratch).store_aligned(field);
      continue;
    }
    with_radix(tree.radix[0], [&](auto radix) {
      constexpr std::int64_t R = radix;
      const std::int64_t h = tree.length / R;
      for (std::int64_t t = 0; t < R; ++t) tree_backward<Arch>(tree, 1, t, h, scratch + t * h * 2 * lanes);
      join_real<Arch, R>(field, 2 * lanes, transform.ny, h, tree.twiddles[0], scratch);
    });
  }
}

template <class Arch, class Real>
void periodic_forward(const ColumnTransform<Real>& transform, const Real* field, Real* transformed) {
  const std::int64_t size = transform.tree.length * 2 * kLanes<Arch, Real>;
  std::memcpy(transformed, field, sizeof(Real) * static_cast<std::size_t>(size));
  tree_forward<Arch>(transform.tree, 0, 0, transform.tree.length, transformed);
}

template <class Arch, class Real>
void periodic_sum(const ColumnTransform<Real>& transform, const BlockTerm<Real>* terms, std::int64_t count,
                  Real* field) {
  sum_of_products<Arch>(terms, count, 0, transform.tree.length, field);
  tree_backward<Arch>(transform.tree, 0, 0, transform.tree.length, field);
}

}  // namespace
}  // namespace brinell::simd
