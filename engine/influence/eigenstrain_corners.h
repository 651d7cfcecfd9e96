// Triple antiderivatives of the potentials of influence/eigenstrain.h at one corner of a cuboid, in closed form, less
// what does not depend on all three coordinates: with their differences over the eight corners they are the
// potentials of the cuboid. For k, l, j all different:
//
//   L_k = ln(R + x_k)   U_k = atan(x_l x_j/(x_k R))   V_k = 1/(R(R + x_k))   W_k = (2R + x_k)/(R³(R + x_k)²)
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace brinell::influence {

class EigenstrainCorner {
 public:
  using Long = long double;

  EigenstrainCorner(Long x, Long y, Long z) : x_{x, y, z}, r_(std::sqrt(x * x + y * y + z * z)) {
    for (int k = 0; k < 3; ++k) {
      const Long along = x_[k], other = x_[(k + 1) % 3], third = x_[(k + 2) % 3];
      // R + x_k of x_k < 0 would cancel.
      const Long across = other * other + third * third;
      const Long sum = along >= 0 ? r_ + along : across / (r_ - along);
      log_[k] = std::log(sum);
      v_[k] = 1 / (r_ * sum);
      w_[k] = (2 * r_ + along) / (r_ * r_ * r_ * sum * sum);
      const Long product = other * third;
      if (product == 0) {
        angle_[k] = 0;
      } else if (along == 0) {  // on the face: the limit from x_k > 0
        angle_[k] = std::copysign(std::numbers::pi_v<Long> / 2, product);
      } else {
        angle_[k] = std::atan(product / (along * r_));
      }
    }
  }

  Long radius() const { return r_; }
  Long logarithm(int k) const { return log_[k]; }
  Long angle(int k) const { return angle_[k]; }

  /// Phi,k
  Long phi_1(int k) const {
    const int l = (k + 1) % 3, j = (k + 2) % 3;
    return x_[j] * log_[l] + x_[l] * log_[j] - x_[k] * angle_[k];
  }
  /// Phi,kkl; k and l different
  Long phi_kkl(int k, int l) const { return x_[k] * v_[3 - k - l]; }

  /// Derivatives of Psi and Phi by how often each axis occurs.
  using Counts = std::array<int, 3>;
  Long psi_3(const Counts& n) const {
    const Order o(n);
    if (n[o.k] == 3) return x_[o.j] * log_[o.l] + x_[o.l] * log_[o.j] - 2 * x_[o.k] * angle_[o.k];
    if (n[o.k] == 2) return x_[o.k] * log_[o.j];
    return r_;
  }
  Long psi_4(const Counts& n) const {
    const Order o(n);
    if (n[o.k] == 4) return -2 * angle_[o.k] - x_[o.k] * (x_[o.l] * v_[o.j] + x_[o.j] * v_[o.l]);
    if (n[o.k] == 3) return log_[o.j] + x_[o.k] * x_[o.k] * v_[o.j];
    if (n[o.l] == 2) return x_[o.k] * x_[o.l] * v_[o.j];
    return x_[o.k] / r_;
  }
  Long psi_5(const Counts& n) const {
    const Order o(n);
    const Long xk = x_[o.k], xl = x_[o.l], xj = x_[o.j], square = xk * xk;
    if (n[o.k] == 5) return -3 * (xl * v_[o.j] + xj * v_[o.l]) + square * (xl * w_[o.j] + xj * w_[o.l]);
    if (n[o.k] == 4) return 3 * xk * v_[o.j] - square * xk * w_[o.j];
    if (n[o.k] == 3 && n[o.l] == 2) return xl * (v_[o.j] - square * w_[o.j]);
    if (n[o.k] == 3) return 1 / r_ - square / (r_ * r_ * r_);
    return -xk * xl / (r_ * r_ * r_);
  }
  Long phi_4(const Counts& n) const {
    const Order o(n);
    const Long xk = x_[o.k], xl = x_[o.l], xj = x_[o.j];
    if (n[o.k] == 4) return xk * (xl * w_[o.j] + xj * w_[o.l]);
    if (n[o.k] == 3) return v_[o.j] - xk * xk * w_[o.j];
    if (n[o.l] == 2) return -xk * xl * w_[o.j];
    return -xk / (r_ * r_ * r_);
  }

  /// Derivatives of chi's antiderivative, for z >= 0; a, b = x, y or y, x.
  Long chi_1112() const { return -log_[2] / 2 + (x_[1] * x_[1] - x_[0] * x_[0]) / (4 * square_s()); }
  Long chi_1122() const { return -x_[0] * x_[1] / (2 * square_s()); }
  Long chi_aab3(int a) const { return -x_[a] / (r_ + x_[2]); }
  Long chi_123() const { return x_[2] * log_[2] - r_; }
  Long chi_aa3(int a) const {
    const int b = 1 - a;
    return -x_[a] * log_[b] - 2 * x_[2] * std::atan(x_[a] / (r_ + x_[b] + x_[2]));
  }

 private:
  /// Axes by how often they occur: k most often, j least.
  struct Order {
    explicit Order(const Counts& n) {
      for (int axis = 1; axis < 3; ++axis) {
        if (n[axis] > n[k]) k = axis;
      }
      l = k == 0 ? 1 : 0;
      j = 3 - k - l;
      if (n[j] > n[l]) std::swap(l, j);
    }
    int k = 0, l, j;
  };
  Long square_s() const { return (r_ + x_[2]) * (r_ + x_[2]); }

  std::array<Long, 3> x_;
  Long r_;
  std::array<Long, 3> log_{}, angle_{}, v_{}, w_{};
};

}  // namespace brinell::influence
