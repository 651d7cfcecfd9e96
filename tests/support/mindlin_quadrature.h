// Eigenstrain of a cuboid below a free surface by brute force: the body forces of R. D. Mindlin (1936) on its faces,
//
//   u_i(x) = Σ over faces ∬ G_ij(x, x') s_jl n_l dS',   s = the stress that would undo the eigenstrain,
//   sigma = C : grad u − s (inside),
//
// differentiated exactly (numbers that carry their gradient) and integrated in long double over panels that are
// halved until each is small against its distance from the field point. Slow, and the authority: it shares nothing
// with the engine.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/legendre_rule.h"

namespace brinell::reference {

using Long = long double;

/// A number with its derivatives along x, y, z.
struct Graded {
  Long value = 0;
  std::array<Long, 3> slope{};

  Graded() = default;
  Graded(Long constant) : value(constant) {}  // NOLINT: constants take part in formulas
  Graded(Long at, int axis) : value(at) { slope[static_cast<std::size_t>(axis)] = 1; }

  template <class Value>
  static Graded chain(Value v, Long of_a, const Graded& a, Long of_b, const Graded& b) {
    Graded result(v);
    for (std::size_t k = 0; k < 3; ++k) result.slope[k] = of_a * a.slope[k] + of_b * b.slope[k];
    return result;
  }
  friend Graded operator+(const Graded& a, const Graded& b) { return chain(a.value + b.value, 1, a, 1, b); }
  friend Graded operator-(const Graded& a, const Graded& b) { return chain(a.value - b.value, 1, a, -1, b); }
  friend Graded operator*(const Graded& a, const Graded& b) {
    return chain(a.value * b.value, b.value, a, a.value, b);
  }
  friend Graded operator/(const Graded& a, const Graded& b) {
    return chain(a.value / b.value, 1 / b.value, a, -a.value / (b.value * b.value), b);
  }
  friend Graded root(const Graded& a) {
    const Long r = std::sqrt(a.value);
    return chain(r, 1 / (2 * r), a, 0, a);
  }
};

/// 16 pi mu (1 − ν) times the displacement [i] at (x, y, z) of a unit force along z, then along x, at (0, 0, c).
inline std::array<Graded, 3> mindlin_normal(const Graded& x, const Graded& y, const Graded& z, Long c, Long nu) {
  const Graded below = z - c, above = z + c, r2 = x * x + y * y;
  const Graded r_1 = root(r2 + below * below), r_2 = root(r2 + above * above);
  const Graded one3 = r_1 * r_1 * r_1, two3 = r_2 * r_2 * r_2, two5 = two3 * r_2 * r_2;
  const Long three = 3 - 4 * nu, q = 4 * (1 - nu) * (1 - 2 * nu);
  const Graded radial = below / one3 + three * below / two3 - q / (r_2 * (r_2 + above)) + 6 * c * z * above / two5;
  return {x * radial, y * radial,
          three / r_1 + (8 * (1 - nu) * (1 - nu) - three) / r_2 + below * below / one3 +
              (three * above * above - 2 * c * z) / two3 + 6 * c * z * above * above / two5};
}
inline std::array<Graded, 3> mindlin_tangential(const Graded& x, const Graded& y, const Graded& z, Long c, Long nu) {
  const Graded below = z - c, above = z + c, r2 = x * x + y * y;
  const Graded r_1 = root(r2 + below * below), r_2 = root(r2 + above * above), s = r_2 + above;
  const Graded one3 = r_1 * r_1 * r_1, two3 = r_2 * r_2 * r_2, two5 = two3 * r_2 * r_2;
  const Long three = 3 - 4 * nu, q = 4 * (1 - nu) * (1 - 2 * nu);
  return {three / r_1 + 1 / r_2 + x * x / one3 + three * x * x / two3 +
              2 * c * z / two3 * (1 - 3 * x * x / (r_2 * r_2)) + q / s * (1 - x * x / (r_2 * s)),
          x * y * (1 / one3 + three / two3 - 6 * c * z / two5 - q / (r_2 * s * s)),
          x * (below / one3 + three * below / two3 - 6 * c * z * above / two5 + q / (r_2 * s))};
}

class MindlinQuadrature {
 public:
  struct Response {
    std::array<std::array<Long, 6>, 6> stress{};  // per 2 mu, [stress][strain], xx yy zz yz xz xy
    std::array<Long, 6> displacement{};           // along z
  };

  /// Of the cuboid with half sides `half` centred at (0, 0, depth), at a point that is not on its faces.
  Response operator()(const std::array<Long, 3>& at, Long depth, const std::array<Long, 3>& half, Long nu) const {
    constexpr std::size_t kPair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    Forces forces{};  // [direction l of the normal][i][j]
    for (std::size_t l = 0; l < 3; ++l) {
      const std::size_t u = (l + 1) % 3, v = (l + 2) % 3;
      for (const Long side : {1.0L, -1.0L}) {
        Face face{at, depth, nu, l, side * half[l], side};
        add_panel(face, {-half[u], half[u], -half[v], half[v]}, forces[l]);
      }
    }
    Response response;
    const Long factor = 1 / (8 * std::numbers::pi_v<Long> * (1 - nu)), bulk = nu / (1 - 2 * nu);
    const bool inside = std::abs(at[0]) < half[0] && std::abs(at[1]) < half[1] && std::abs(at[2] - depth) < half[2];
    for (std::size_t strain = 0; strain < 6; ++strain) {
      Long s[3][3] = {};  // per 2 mu
      s[kPair[strain][0]][kPair[strain][1]] = s[kPair[strain][1]][kPair[strain][0]] = 1;
      for (int k = 0; k < 3 && strain < 3; ++k) s[k][k] += bulk;
      std::array<Graded, 3> u{};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          for (std::size_t l = 0; l < 3; ++l) u[i] = u[i] + factor * s[j][l] * forces[l][i][j];
        }
      }
      response.displacement[strain] = u[2].value;
      const Long trace = u[0].slope[0] + u[1].slope[1] + u[2].slope[2];
      for (std::size_t c = 0; c < 6; ++c) {
        const std::size_t i = kPair[c][0], k = kPair[c][1];
        Long sigma = (u[i].slope[k] + u[k].slope[i]) / 2 + (i == k ? bulk * trace : 0);
        if (inside) sigma -= s[i][k];
        response.stress[c][strain] = sigma;
      }
    }
    return response;
  }

 private:
  static constexpr int kNodes = 12;
  using Tensor = std::array<std::array<Graded, 3>, 3>;
  using Forces = std::array<Tensor, 3>;

  struct Face {
    std::array<Long, 3> at;
    Long depth, nu;
    std::size_t axis;
    Long position;  // along the axis, from the centre
    Long sign;
  };
  struct Panel {
    Long left, right, low, high;
  };

  void add_panel(const Face& face, const Panel& panel, Tensor& sum) const {
    const std::size_t u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
    const auto centre = [&](std::size_t axis) { return axis == 2 ? face.depth : 0.0L; };
    const Long width = panel.right - panel.left, height = panel.high - panel.low;
    const Long to_u = face.at[u] - centre(u), to_v = face.at[v] - centre(v);
    const Long away_u = std::max({panel.left - to_u, to_u - panel.right, 0.0L});
    const Long away_v = std::max({panel.low - to_v, to_v - panel.high, 0.0L});
    const Long away = std::hypot(away_u, away_v, face.at[face.axis] - centre(face.axis) - face.position);
    if (std::max(width, height) > 0.8L * away) {
      const Long middle_u = (panel.left + panel.right) / 2, middle_v = (panel.low + panel.high) / 2;
      if (width >= height) {
        add_panel(face, {panel.left, middle_u, panel.low, panel.high}, sum);
        add_panel(face, {middle_u, panel.right, panel.low, panel.high}, sum);
      } else {
        add_panel(face, {panel.left, panel.right, panel.low, middle_v}, sum);
        add_panel(face, {panel.left, panel.right, middle_v, panel.high}, sum);
      }
      return;
    }
    for (std::size_t k = 0; k < kNodes; ++k) {
      for (std::size_t l = 0; l < kNodes; ++l) {
        std::array<Long, 3> source{};
        source[face.axis] = centre(face.axis) + face.position;
        source[u] = centre(u) + (panel.left + panel.right + width * rule_.node[k]) / 2;
        source[v] = centre(v) + (panel.low + panel.high + height * rule_.node[l]) / 2;
        const Graded x(face.at[0] - source[0], 0), y(face.at[1] - source[1], 1), z(face.at[2], 2);
        const auto along_x = mindlin_tangential(x, y, z, source[2], face.nu);
        const auto turned = mindlin_tangential(y, x, z, source[2], face.nu);
        const auto along_z = mindlin_normal(x, y, z, source[2], face.nu);
        const std::array<Graded, 3> along_y{turned[1], turned[0], turned[2]};
        const Graded weight = face.sign * rule_.weight[k] * rule_.weight[l] * width * height / 4;
        for (std::size_t i = 0; i < 3; ++i) {
          sum[i][0] = sum[i][0] + weight * along_x[i];
          sum[i][1] = sum[i][1] + weight * along_y[i];
          sum[i][2] = sum[i][2] + weight * along_z[i];
        }
      }
    }
  }

  LegendreRule<kNodes> rule_;
};

}  // namespace brinell::reference
