// The quarter transform of a kernel that is even or odd along each axis, in double precision: sums of cosines or
// sines at half-integer frequencies,
//
//   even: H_k = K_0 + 2 Σ_{1<=d<n} K_d cos(π (k + 1/2) d / n),    odd: H_k = 2 Σ_{1<=d<n} K_d sin(π (k + 1/2) d / n),
//
// 0 <= k < n; the transform of an odd kernel is −i H. On the frequencies (m + 1/4)/n that the carriers use, m and k
// are the same frequency for k = 2m < n, opposite ones for k = 2n − 1 − 2m < n.
#pragma once

#include <cstdint>

#include "base/buffer.h"
#include "fft/convolution.h"

namespace brinell::fft {

class KernelTransform {
 public:
  /// kernel: nx·ny values at offsets 0 <= i < nx, 0 <= j < ny; n_x >= nx and n_y >= ny are the transforms' lengths.
  KernelTransform(const Backend& backend, const double* kernel, std::int64_t nx, std::int64_t ny, std::int64_t n_x,
                  std::int64_t n_y, Parity parity_x, Parity parity_y);

  /// The value at frequencies (mx + 1/4)/n_x, (my + 1/4)/n_y, without the factors −i, divided by n_x·n_y.
  double operator()(std::int64_t mx, std::int64_t my) const {
    double sign = 1;
    std::int64_t kx = 2 * mx;
    if (kx >= n_x_) {
      kx = 2 * n_x_ - 1 - kx;
      sign = mirror_x_;
    }
    std::int64_t ky = 2 * my;
    if (ky >= n_y_) {
      ky = 2 * n_y_ - 1 - ky;
      sign *= mirror_y_;
    }
    return sign * values_[static_cast<std::size_t>(kx * stride_ + ky)];
  }

 private:
  std::int64_t n_x_, n_y_;
  std::int64_t stride_;         // of the columns in values_
  double mirror_x_, mirror_y_;  // sign at the opposite frequency
  Buffer<double> values_;       // [kx][ky]
};

}  // namespace brinell::fft
