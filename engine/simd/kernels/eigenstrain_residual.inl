// Eigenstrain to residual stress in one block of frequencies along x: forward along y, then for every frequency along
// y forward along z, times the spectra, backward along z, and backward along y. The field's real and imaginary part
// (of x), a column's (of y) are four real sequences along z for each component.
//
// Factors −i. A spectrum that is odd along x takes one in the complex numbers of x. Let X count the x indices of a
// component; with strains times (−i)^X before and stresses times (−i)^X after the product all spectra are real along
// x and y, but for a −1 where both are odd. Turning by −i exchanges the sequences: no arithmetic.
#pragma once

#include <cstring>

#include "simd/kernels/eigenstrain_tensors.inl"
#include "simd/kernels/transform_sums.inl"

namespace brinell::simd {
namespace {

/// `count` real values, `stride` apart, forward by a tree, and the reverse.
template <class Arch>
void real_forward(const TransformTree<double>& tree, const double* rows, std::int64_t stride, std::int64_t count,
                  double* z) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  if (tree.stages == 0) return store(z, Complex<V>{V::load_aligned(rows), V(0.0)});
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = tree.length / R;
    split_real<Arch, R>(rows, stride, count, h, tree.twiddles[0], z);
    for (std::int64_t t = 0; t < R; ++t) tree_forward<Arch>(tree, 1, t, h, z + t * h * 2 * lanes);
  });
}
template <class Arch>
void real_backward(const TransformTree<double>& tree, double* z, double* rows, std::int64_t stride,
                   std::int64_t count) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  if (tree.stages == 0) return V::load_aligned(z).store_aligned(rows);
  with_radix(tree.radix[0], [&](auto radix) {
    constexpr std::int64_t R = radix;
    const std::int64_t h = tree.length / R;
    for (std::int64_t t = 0; t < R; ++t) tree_backward<Arch>(tree, 1, t, h, z + t * h * 2 * lanes);
    join_real<Arch, R>(rows, stride, count, h, tree.twiddles[0], z);
  });
}

template <class Arch>
std::int64_t spectra_scratch(const TransformTree<double>& along_z) {
  return 4 * along_z.length * kLanes<Arch, double>;
}

template <class Arch>
void transform_spectra(const TransformTree<double>& tree, std::int64_t nz, const double* phase, double scale,
                       double* spectra, double* scratch) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>, stride = kSpectralValues * lanes;
  double *z = scratch, *other = scratch + 2 * tree.length * lanes;
  const V factor(scale);
  for (int k = 0; k < kKelvinPotentials; ++k) {
    double* values = spectra + k * lanes;
    const int m = k < 1 ? 0 : k < 3 ? 1 : k < 6 ? 2 : k < 10 ? 3 : 4;
    const bool odd = (k - m * (m + 1) / 2) % 2 != 0;
    (V::load_aligned(values) * V(0.5)).store_aligned(values);  // stands for both its sides
    real_forward<Arch>(tree, values, stride, nz, z);
    const V twice = odd ? V(-2 * scale) : V(2 * scale);
    for (std::int64_t p = 0; p < tree.length; ++p) {
      (twice * V::load_aligned(z + (2 * p + (odd ? 1 : 0)) * lanes)).store_aligned(values + p * stride);
    }
  }
  for (int k = 0; k < kImagePotentials; ++k) {
    double* re = spectra + (kKelvinPotentials + k) * lanes;
    double* im = re + kImagePotentials * lanes;
    real_forward<Arch>(tree, re, stride, nz, z);
    real_forward<Arch>(tree, im, stride, nz, other);
    for (std::int64_t p = 0; p < tree.length; ++p) {
      const Complex<V> after = load<V>(z + 2 * p * lanes), before = load<V>(other + 2 * p * lanes);
      const Complex<V> sum{factor * (after.re + before.re), factor * (after.im - before.im)};
      const Complex<V> turned = times(sum, V(phase[2 * p]), V(phase[2 * p + 1]));
      turned.re.store_aligned(re + p * stride);
      turned.im.store_aligned(im + p * stride);
    }
  }
}

constexpr bool odd_in_x(int component) {
  return component == 4 || component == 5;
}
constexpr bool odd_in_y(int component) {
  return component == 3 || component == 5;
}
constexpr bool odd_in_z(int component) {
  return component == 3 || component == 4;
}

/// Sequence 2·(part of x) + (part of y): where a component's comes from when it is turned, and its sign.
struct Turn {
  int from;
  bool negative;
};
constexpr Turn turn_of(int component, int sequence) {
  const bool x = odd_in_x(component), y = odd_in_y(component);
  const int from = sequence ^ (x ? 2 : 0) ^ (y ? 1 : 0);
  const bool negative_x = x && (sequence & 2) != 0, negative_y = y && (sequence & 1) != 0;
  return {from, negative_x != negative_y};
}

/// The spectra of one frequency as matrices [stress][plastic strain].
template <class V>
struct ResidualMatrices {
  V kelvin[6][kPlasticComponents];
  Complex<V> a[6][kPlasticComponents], b[6][kPlasticComponents];
  Complex<V> c[6][kPlasticComponents];  // row zz is not filled: −xx − yy
};

/// body(I, J) over all rows and columns of which the row is not `without`.
template <int without, class Body>
[[gnu::always_inline]] inline void every_entry(Body&& body) {
  unrolled<6>([&](auto row) __attribute__((always_inline)) {
    if constexpr (row != without) {
      unrolled<kPlasticComponents>([&](auto column) __attribute__((always_inline)) { body(row, column); });
    }
  });
}

/// An entry of the column, xx and yy with zz = −1 beside them; with the sign of two odd parities.
template <int I, int column, class Entry>
[[gnu::always_inline]] inline auto plastic_entry(const Entry& entry) {
  constexpr int J = kPlasticOrder[column];
  constexpr bool negative = (odd_in_x(I) && odd_in_x(J)) != (odd_in_y(I) && odd_in_y(J));
  if constexpr (J < 2) {
    return entry.template operator()<I, J>() - entry.template operator()<I, 2>();
  } else if constexpr (negative) {
    return -entry.template operator()<I, J>();
  } else {
    return entry.template operator()<I, J>();
  }
}

template <class V>
void fill_kelvin_matrix(const double* values, double nu, double own, ResidualMatrices<V>& matrices) {
  V potential[kKelvinPotentials];
  for (int k = 0; k < kKelvinPotentials; ++k) {
    potential[k] = V::load_aligned(values + k * static_cast<std::int64_t>(V::size));
  }
  KelvinTensors<V> tensors;
  kelvin_tensors(potential, tensors);
  every_entry<-1>([&](auto row, auto column) __attribute__((always_inline)) {
    matrices.kelvin[row][column] = plastic_entry<row, column>([&]<int I, int J>() __attribute__((always_inline)) {
      const V value = kelvin_stress<I, J>(tensors, nu);
      return I == J ? value - V(own) : value;
    });
  });
}

template <bool imaginary, class V>
void fill_image_matrices(const double* values, double nu, ResidualMatrices<V>& matrices) {
  V potential[kImagePotentials];
  for (int k = 0; k < kImagePotentials; ++k) {
    potential[k] = V::load_aligned(values + k * static_cast<std::int64_t>(V::size));
  }
  ImageTensors<V> tensors;
  image_tensors(potential, nu, tensors);
  const auto put = [](Complex<V> & entry, const V& value) __attribute__((always_inline)) {
    (imaginary ? entry.im : entry.re) = value;
  };
  every_entry<-1>([&](auto row, auto column) __attribute__((always_inline)) {
    put(matrices.a[row][column], plastic_entry<row, column>([&]<int I, int J>() __attribute__((always_inline)) {
          return image_stress<ImagePart::a, I, J>(tensors, nu);
        }));
    put(matrices.b[row][column], plastic_entry<row, column>([&]<int I, int J>() __attribute__((always_inline)) {
          return image_stress<ImagePart::b, I, J>(tensors, nu);
        }));
  });
  every_entry<2>([&](auto row, auto column) __attribute__((always_inline)) {
    put(matrices.c[row][column], plastic_entry<row, column>([&]<int I, int J>() __attribute__((always_inline)) {
          return image_stress<ImagePart::c, I, J>(tensors, nu);
        }));
  });
}

/// Strains that are not zero, by number in kPlasticOrder.
struct PlasticColumns {
  int count = 0;
  int column[kPlasticComponents] = {};
};

/// out[sequence] = Σ over columns of image · conj(strain), and of the full space's real (odd along z: −i times real)
/// spectrum · strain. strain: [column][sequence], out: [sequence], `stride` apart.
template <bool with_kelvin, int row, class V>
[[gnu::always_inline]] inline void product_row(const Complex<V> (&image)[6][kPlasticComponents],
                                               const V (&kelvin)[6][kPlasticComponents],
                                               const PlasticColumns& columns, const double* strain,
                                               std::int64_t stride, double* out) {
  V re[4], im[4];
  unrolled<4>([&](auto s) __attribute__((always_inline)) { re[s] = im[s] = V(0.0); });
  for (int n = 0; n < columns.count; ++n) {
    const int column = columns.column[n];
    const Complex<V> a = image[row][column];
    const double* x = strain + column * 4 * stride;
    unrolled<4>([&](auto s) __attribute__((always_inline)) {
      const Complex<V> e = load<V>(x + static_cast<std::int64_t>(s) * stride);
      re[s] = re[s] + a.re * e.re + a.im * e.im;
      im[s] = im[s] + a.im * e.re - a.re * e.im;
      if constexpr (with_kelvin) {
        const V k = kelvin[row][column];
        if (odd_in_z(row) != odd_in_z(kPlasticOrder[column])) {
          re[s] = re[s] + k * e.im;
          im[s] = im[s] - k * e.re;
        } else {
          re[s] = re[s] + k * e.re;
          im[s] = im[s] + k * e.im;
        }
      }
    });
  }
  unrolled<4>([&](auto s) __attribute__((always_inline)) {
    store(out + static_cast<std::int64_t>(s) * stride, Complex<V>{re[s], im[s]});
  });
}

/// The scratch of a block.
struct ResidualScratch {
  std::int64_t layer;     // doubles of one layer's columns
  std::int64_t sequence;  // of one sequence along z
  double* columns;        // [component][layer][part of x][position in y][re, im][lane]
  double* strain;         // [plastic component][sequence][position in z][re, im][lane]
  double* stress;         // [part a b c][component][sequence][position in z][re, im][lane]
  double* layers;         // [three][layer][lane]
  std::int64_t size;
};

template <class Arch>
ResidualScratch residual_scratch_parts(const ResidualTransform& transform, double* memory) {
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  ResidualScratch parts{};
  // Set apart so that equal places of layers, of sequences do not fall into the same cache set.
  parts.layer = 4 * transform.columns.tree.length * lanes + 2 * lanes;
  parts.sequence = 2 * transform.along_z.length * lanes + 2 * lanes;
  const std::int64_t of_columns = 6 * transform.nz * parts.layer, of_strain = kPlasticComponents * 4 * parts.sequence;
  const std::int64_t of_stress = 3 * 6 * 4 * parts.sequence;
  parts.size = of_columns + of_strain + of_stress + 3 * transform.nz * lanes;
  if (memory == nullptr) return parts;
  parts.columns = memory;
  parts.strain = parts.columns + of_columns;
  parts.stress = parts.strain + of_strain;
  parts.layers = parts.stress + of_stress;
  return parts;
}

template <class Arch>
std::int64_t residual_scratch(const ResidualTransform& transform) {
  return residual_scratch_parts<Arch>(transform, nullptr).size;
}

/// Fetches one position in y of all layers and components: they lie far apart, out of reach of the hardware's
/// prefetching.
template <class Arch>
void fetch_position(const ResidualTransform& transform, std::int64_t position, const ResidualScratch& scratch) {
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  constexpr auto bytes = static_cast<std::int64_t>(2 * lanes * sizeof(double));
  for (std::int64_t layer = 0; layer < 6 * transform.nz; ++layer) {
    for (std::int64_t part = 0; part < 2; ++part) {
      const char* line = reinterpret_cast<const char*>(scratch.columns + layer * scratch.layer +
                                                       (part * transform.columns.tree.length + position) * 2 * lanes);
      for (std::int64_t byte = 0; byte < bytes; byte += 64) __builtin_prefetch(line + byte, 1, 2);
    }
  }
}

/// Strains along z at one position in y, turned and transformed.
template <class Arch>
void strains_forward(const ResidualTransform& transform, const PlasticColumns& columns, std::int64_t position,
                     const ResidualScratch& scratch) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  for (int n = 0; n < columns.count; ++n) {
    const int component = kPlasticOrder[columns.column[n]];
    const double* first = scratch.columns + component * transform.nz * scratch.layer;
    for (int s = 0; s < 4; ++s) {
      const Turn turn = turn_of(component, s);
      const double* rows =
          first + ((turn.from >> 1) * transform.columns.tree.length + position) * 2 * lanes + (turn.from & 1) * lanes;
      double* z = scratch.strain + (columns.column[n] * 4 + s) * scratch.sequence;
      real_forward<Arch>(transform.along_z, rows, scratch.layer, transform.nz, z);
      for (std::int64_t k = 0; turn.negative && k < 2 * transform.along_z.length * lanes; k += lanes) {
        (-V::load_aligned(z + k)).store_aligned(z + k);
      }
    }
  }
}

/// Spectra are fetched this many frequencies before they are needed (past the last ones nothing is read).
constexpr std::int64_t kAhead = 2;

template <class Arch>
void strains_to_stress(const ResidualTransform& transform, const PlasticColumns& columns, const double* spectra,
                       const ResidualScratch& scratch) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  ResidualMatrices<V> matrices;
  const std::int64_t part = 6 * 4 * scratch.sequence;
  for (std::int64_t p = 0; p < transform.along_z.length; ++p) {
    Prefetch ahead{reinterpret_cast<const char*>(spectra + kAhead * kSpectralValues * lanes),
                   kSpectralValues * lanes * static_cast<std::int64_t>(sizeof(double)) / 6};
    fill_kelvin_matrix(spectra, transform.poissons_ratio, transform.own, matrices);
    fill_image_matrices<false>(spectra + kKelvinPotentials * lanes, transform.poissons_ratio, matrices);
    fill_image_matrices<true>(spectra + (kKelvinPotentials + kImagePotentials) * lanes, transform.poissons_ratio,
                              matrices);
    const double* strain = scratch.strain + 2 * p * lanes;
    unrolled<6>([&](auto row) __attribute__((always_inline)) {
      ahead.share(1);
      double* out = scratch.stress + static_cast<std::int64_t>(row) * 4 * scratch.sequence + 2 * p * lanes;
      product_row<true, row>(matrices.a, matrices.kelvin, columns, strain, scratch.sequence, out);
      product_row<false, row>(matrices.b, matrices.kelvin, columns, strain, scratch.sequence, out + part);
      if constexpr (row != 2) {
        product_row<false, row>(matrices.c, matrices.kelvin, columns, strain, scratch.sequence, out + 2 * part);
      }
    });
    spectra += kSpectralValues * lanes;
  }
}

/// Backward along z, a + z b + z² c, turned, into the columns.
template <class Arch>
void stresses_backward(const ResidualTransform& transform, std::int64_t position, const ResidualScratch& scratch) {
  using V = Batch<Arch, double>;
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  const std::int64_t part = 6 * 4 * scratch.sequence, of_layers = transform.nz * lanes;
  double *linear = scratch.layers, *square = linear + of_layers, *rest = square + of_layers;
  for (int s = 0; s < 4; ++s) {
    for (int component = 0; component < 6; ++component) {  // zz after xx and yy
      const Turn turn = turn_of(component, s);             // of the result
      double* z = scratch.stress + (component * 4 + turn.from) * scratch.sequence;
      double* rows = scratch.columns + component * transform.nz * scratch.layer +
                     ((s >> 1) * transform.columns.tree.length + position) * 2 * lanes + (s & 1) * lanes;
      real_backward<Arch>(transform.along_z, z, rows, scratch.layer, transform.nz);
      real_backward<Arch>(transform.along_z, z + part, linear, lanes, transform.nz);
      const double* quadratic = rest;  // of zz: minus that of xx and yy
      if (component != 2) {
        double* target = component == 0 ? rest : square;
        real_backward<Arch>(transform.along_z, z + 2 * part, target, lanes, transform.nz);
        quadratic = target;
      }
      for (std::int64_t k = 0; k < transform.nz; ++k) {
        const V depth(transform.depth[k]);
        double* place = rows + k * scratch.layer;
        const V second = V::load_aligned(quadratic + k * lanes);
        const V sum = V::load_aligned(place) + depth * (V::load_aligned(linear + k * lanes) + depth * second);
        (turn.negative ? -sum : sum).store_aligned(place);
        if (component == 1) (-(V::load_aligned(rest + k * lanes) + second)).store_aligned(rest + k * lanes);
      }
    }
  }
}

/// One part of a transform along y back to the rows of a field.
template <class Arch>
void backward_columns(const ColumnTransform<double>& columns, double* transform, double* field) {
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  for (std::int64_t part = 0; part < 2; ++part) {
    real_backward<Arch>(columns.tree, transform + part * columns.tree.length * 2 * lanes, field + part * lanes,
                        2 * lanes, columns.ny);
  }
}

template <class Arch>
void residual_block(const ResidualTransform& transform, const ResidualBlock& block, double* memory) {
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  const ResidualScratch scratch = residual_scratch_parts<Arch>(transform, memory);
  PlasticColumns columns;
  for (int column = 0; column < kPlasticComponents; ++column) {
    const unsigned char* given = block.given + column * transform.nz;
    const int component = kPlasticOrder[column];
    double* target = scratch.columns + component * transform.nz * scratch.layer;
    bool any = false;
    for (std::int64_t k = 0; k < transform.nz; ++k) any = any || given[k] != 0;
    if (!any) continue;
    columns.column[columns.count++] = column;
    for (std::int64_t k = 0; k < transform.nz; ++k, target += scratch.layer) {
      if (given[k] != 0) {
        free_forward<Arch>(transform.columns, block.field[component] + k * transform.field_stride, target);
      } else {
        std::memset(target, 0, sizeof(double) * static_cast<std::size_t>(scratch.layer));
      }
    }
  }
  const std::int64_t of_position = transform.along_z.length * kSpectralValues * lanes;
  for (std::int64_t position = 0; position < transform.columns.tree.length; ++position) {
    strains_forward<Arch>(transform, columns, position, scratch);
    if (position + 1 < transform.columns.tree.length) fetch_position<Arch>(transform, position + 1, scratch);
    strains_to_stress<Arch>(transform, columns, block.spectra + position * of_position, scratch);
    stresses_backward<Arch>(transform, position, scratch);
  }
  for (int component = 0; component < 6; ++component) {
    double* from = scratch.columns + component * transform.nz * scratch.layer;
    for (std::int64_t k = 0; k < transform.nz; ++k, from += scratch.layer) {
      backward_columns<Arch>(transform.columns, from, block.field[component] + k * transform.field_stride);
    }
  }
}

template <class Arch>
void accumulate_rows(const ColumnTransform<double>& columns, const double* field, std::int64_t first,
                     std::int64_t count, const double* spectrum, bool turn_x, bool turn_y, double* transform,
                     double* scratch) {
  constexpr std::int64_t lanes = kLanes<Arch, double>;
  const std::int64_t length = columns.tree.length;
  double *rows = scratch, *source = scratch + 2 * lanes * columns.ny;
  std::memset(rows, 0, sizeof(double) * static_cast<std::size_t>(2 * lanes * columns.ny));
  std::memcpy(rows + 2 * lanes * first, field, sizeof(double) * static_cast<std::size_t>(2 * lanes * count));
  free_forward<Arch>(columns, rows, source);
  const auto add = turn_y ? put_product<Arch, true, true, double> : put_product<Arch, false, true, double>;
  for (std::int64_t part = 0; part < 2; ++part) {
    const std::int64_t from = turn_x ? 1 - part : part;
    const double sign = turn_x && part == 1 ? -1 : 1;
    add(source + from * length * 2 * lanes, spectrum, sign, length, transform + part * length * 2 * lanes);
  }
}

}  // namespace
}  // namespace brinell::simd
