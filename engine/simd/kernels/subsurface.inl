// Invariants of stress. Principal values by cyclic Jacobi rotations, in every lane the same number of them: unlike
// the closed form with arc cosines it keeps all digits where values coincide, and has no special cases.
#pragma once

#include <cmath>
#include <cstring>

#include "simd/subsurface_kernels.h"

namespace brinell::simd {
namespace {

inline void von_mises(std::size_t n, const StressArrays& stress, double* __restrict result) {
  const double *xx = stress.component[0], *yy = stress.component[1], *zz = stress.component[2];
  const double *yz = stress.component[3], *xz = stress.component[4], *xy = stress.component[5];
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const double a = xx[i] - yy[i], b = yy[i] - zz[i], c = zz[i] - xx[i];
    const double shear = yz[i] * yz[i] + xz[i] * xz[i] + xy[i] * xy[i];
    result[i] = std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * shear);
  }
}

inline void hydrostatic(std::size_t n, const StressArrays& stress, double* __restrict result) {
  const double *xx = stress.component[0], *yy = stress.component[1], *zz = stress.component[2];
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) result[i] = (xx[i] + yy[i] + zz[i]) / 3;
}

inline double largest(std::size_t n, const double* values) {
  double most = -HUGE_VAL;
#pragma omp simd reduction(max : most)
  for (std::size_t i = 0; i < n; ++i) most = values[i] > most ? values[i] : most;
  return most;
}

/// A symmetric matrix on its way to its diagonal, and the rotations so far: columns of `axis`.
template <class Arch, bool with_axes>
class Diagonalisation {
  using Batch = xsimd::batch<double, Arch>;

 public:
  /// Components in the order xx yy zz yz xz xy.
  explicit Diagonalisation(const Batch* stress) {
    for (int k = 0; k < 3; ++k) {
      value_[k] = stress[k];
      off_[k] = stress[3 + k];
      if constexpr (with_axes) {
        for (int row = 0; row < 3; ++row) axis_[row][k] = Batch(row == k ? 1.0 : 0.0);
      }
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      rotate<1, 2>();
      rotate<0, 2>();
      rotate<0, 1>();
    }
    order<0, 1>();
    order<1, 2>();
    order<0, 1>();
  }

  Batch value(int k) const { return value_[k]; }
  Batch axis(int row, int k) const { return axis_[row][k]; }

 private:
  // Convergence is quadratic: off-diagonal parts of order one are below the last digit after four sweeps.
  static constexpr int kSweeps = 5;

  /// Makes element (p, q) zero; r is the third index, and off_[r] the element whose row and column are not r.
  template <int p, int q>
  void rotate() {
    constexpr int r = 3 - p - q;
    const Batch element = off_[r], difference = value_[q] - value_[p];
    const Batch twice = element + element;
    const Batch magnitude = xsimd::abs(difference) + xsimd::sqrt(difference * difference + twice * twice);
    const Batch safe = xsimd::select(magnitude > Batch(0.0), magnitude, Batch(1.0));
    const Batch ratio = twice / safe;
    const Batch t = xsimd::select(difference < Batch(0.0), Batch(0.0) - ratio, ratio);  // the smaller angle's tangent
    const Batch c = Batch(1.0) / xsimd::sqrt(Batch(1.0) + t * t), s = t * c;
    value_[p] = value_[p] - t * element;
    value_[q] = value_[q] + t * element;
    off_[r] = Batch(0.0);
    const Batch with_p = off_[q], with_q = off_[p];  // elements (r, p) and (r, q)
    off_[q] = c * with_p - s * with_q;
    off_[p] = s * with_p + c * with_q;
    if constexpr (with_axes) {
      for (int row = 0; row < 3; ++row) {
        const Batch along_p = axis_[row][p], along_q = axis_[row][q];
        axis_[row][p] = c * along_p - s * along_q;
        axis_[row][q] = s * along_p + c * along_q;
      }
    }
  }

  template <int p, int q>
  void order() {
    const auto swap = value_[p] < value_[q];
    exchange(swap, value_[p], value_[q]);
    if constexpr (with_axes) {
      for (int row = 0; row < 3; ++row) exchange(swap, axis_[row][p], axis_[row][q]);
    }
  }
  template <class Mask>
  static void exchange(const Mask& swap, Batch& a, Batch& b) {
    const Batch first = xsimd::select(swap, b, a);
    b = xsimd::select(swap, a, b);
    a = first;
  }

  Batch value_[3], off_[3];  // off_ is yz, xz, xy
  Batch axis_[3][3];
};

/// Calls body(stress, done, count) for every register of points; lanes behind the last point are zero.
template <class Arch, class Body>
void for_stresses(std::size_t n, const StressArrays& stress, Body body) {
  using Batch = xsimd::batch<double, Arch>;
  constexpr std::size_t lanes = Batch::size;
  Batch six[6];
  for (std::size_t done = 0; done < n; done += lanes) {
    const std::size_t count = n - done < lanes ? n - done : lanes;
    for (int c = 0; c < 6; ++c) {
      alignas(64) double values[lanes] = {};
      std::memcpy(values, stress.component[c] + done, count * sizeof(double));
      six[c] = Batch::load_aligned(values);
    }
    body(six, done, count);
  }
}

template <class Batch>
void store_some(Batch values, double* memory, std::size_t count) {
  alignas(64) double lanes[Batch::size];
  values.store_aligned(lanes);
  std::memcpy(memory, lanes, count * sizeof(double));
}

template <class Arch>
void tresca(std::size_t n, const StressArrays& stress, double* result) {
  for_stresses<Arch>(n, stress, [result](const auto* six, std::size_t done, std::size_t count) {
    const Diagonalisation<Arch, false> found(six);
    store_some(found.value(0) - found.value(2), result + done, count);
  });
}

template <class Arch, bool with_axes>
void principal_of(std::size_t n, const StressArrays& stress, const PrincipalArrays& result) {
  for_stresses<Arch>(n, stress, [&result](const auto* six, std::size_t done, std::size_t count) {
    const Diagonalisation<Arch, with_axes> found(six);
    for (int k = 0; k < 3; ++k) {
      if (result.value[k] != nullptr) store_some(found.value(k), result.value[k] + done, count);
      if constexpr (with_axes) {
        for (int row = 0; row < 3; ++row) store_some(found.axis(row, k), result.direction[3 * k + row] + done, count);
      }
    }
  });
}

template <class Arch>
void principal(std::size_t n, const StressArrays& stress, const PrincipalArrays& result) {
  if (result.direction[0] != nullptr) {
    principal_of<Arch, true>(n, stress, result);
  } else {
    principal_of<Arch, false>(n, stress, result);
  }
}

template <class Arch>
constexpr SubsurfaceKernels subsurface_kernels() {
  return {von_mises, hydrostatic, tresca<Arch>, principal<Arch>, largest};
}

}  // namespace
}  // namespace brinell::simd
