#include "influence/displacement.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "influence/gauss_legendre.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::influence {

namespace {

constexpr std::int64_t kClosedCells = 4;
// Distances, in longer sides, from which six, four and three terms of the series leave an error below 1e-16.
constexpr double kSeriesFrom[] = {16, 128, 512};

// Nodes that bring the quadrature's error ρ^(−2n), ρ ≈ 4·distance, below 2e-17.
struct NodesFrom {
  std::int64_t distance;  // cells
  int nodes;
};
constexpr NodesFrom kNodes[] = {{4, 7}, {8, 6}, {16, 5}, {64, 4}, {256, 3}};

const simd::GaussRule& rule_at(std::int64_t distance) {
  int nodes = kNodes[0].nodes;
  for (const NodesFrom& zone : kNodes) {
    if (distance >= zone.distance) nodes = zone.nodes;
  }
  return gauss_legendre(nodes);
}

// A function r^(−order) p(u) of the plane, u = x²/r², by the coefficients of the polynomial p.
using Polynomial = std::vector<long double>;

Polynomial derivative(const Polynomial& p) {
  Polynomial slope;
  for (std::size_t k = 1; k < p.size(); ++k) slope.push_back(static_cast<long double>(k) * p[k]);
  return slope;
}

// alpha·p + (beta + gamma·u)·q
Polynomial combine(long double alpha, const Polynomial& p, long double beta, long double gamma, const Polynomial& q) {
  Polynomial sum(std::max(p.size(), q.size() + 1), 0.0L);
  for (std::size_t k = 0; k < p.size(); ++k) sum[k] += alpha * p[k];
  for (std::size_t k = 0; k < q.size(); ++k) {
    sum[k] += beta * q[k];
    sum[k + 1] += gamma * q[k];
  }
  return sum;
}

// ∂²/∂x² and ∂²/∂y² of r^(−order) p(u) are r^(−order−2) times the polynomials returned, from
// ∂u/∂x = 2x(1 − u)/r², ∂u/∂y = −2yu/r².
Polynomial second_derivative_x(const Polynomial& p, int order) {
  const Polynomial g = combine(-order, p, 2, -2, derivative(p));
  return combine(1, g, 0, 1, combine(-(order + 2), g, 2, -2, derivative(g)));
}

Polynomial second_derivative_y(const Polynomial& p, int order) {
  const Polynomial g = combine(-order, p, 0, -2, derivative(p));
  return combine(1, g, 1, -1, combine(-(order + 2), g, 0, -2, derivative(g)));
}

// The Taylor series of 1/r under the integral: term s is
//   4ab/π Σ_{m+n=s} a^(2m) b^(2n) / ((2m+1)! (2n+1)!) ∂_x^(2m) ∂_y^(2n) (1/r).
simd::DisplacementSeries make_series(long double a, long double b, long double factor) {
  simd::DisplacementSeries series;
  const auto factorial = [](int n) { return std::tgamma(static_cast<long double>(n + 1)); };
  for (int s = 0; s < simd::kSeriesTerms; ++s) {
    std::vector<long double> sum(s + 1, 0.0L);
    for (int m = 0; m <= s; ++m) {
      Polynomial p{1.0L};
      for (int k = 0; k < s; ++k) p = k < m ? second_derivative_x(p, 2 * k + 1) : second_derivative_y(p, 2 * k + 1);
      const long double moment =
          std::pow(a, 2 * m) * std::pow(b, 2 * (s - m)) / (factorial(2 * m + 1) * factorial(2 * (s - m) + 1));
      for (int k = 0; k <= s; ++k) sum[k] += moment * p[k];
    }
    for (int k = 0; k <= s; ++k) {
      series.coefficient[s * (s + 1) / 2 + k] = static_cast<double>(factor * 4 * a * b * sum[k]);
    }
  }
  return series;
}

// ∫ dt/√(c² + t²) from o − h to o + h for c >= 0, o >= 0; zero times infinity is not reached.
long double line_potential(long double c, long double o, long double h) {
  const long double upper = std::hypot(c, o + h), lower = std::hypot(c, o - h);
  const long double denominator = o < h ? c * c / (lower + h - o) : lower + o - h;
  return std::log1p(2 * h * (1 + 2 * o / (upper + lower)) / denominator);
}

}  // namespace

Displacement::Displacement(double dx, double dy) {
  for (const auto& [name, side] : {std::pair{"dx", dx}, std::pair{"dy", dy}}) {
    if (!(side > 0) || !std::isfinite(side)) {
      fail(Status::invalid_argument,
           std::string(name) + " = " + text(side) + ": the side of a cell must be positive");
    }
  }
  const int exponent = std::ilogb(std::max(dx, dy));
  unit_ = std::ldexp(1.0, exponent);
  dx_ = std::ldexp(dx, -exponent);
  dy_ = std::ldexp(dy, -exponent);
  longer_ = std::max(dx_, dy_);
  series_ = make_series(0.5L * dx_, 0.5L * dy_, unit_ / std::numbers::pi_v<long double>);
}

double Displacement::closed_form(std::int64_t i, std::int64_t j) const {
  const long double a = 0.5L * dx_, b = 0.5L * dy_;
  const long double x = static_cast<long double>(i) * dx_, y = static_cast<long double>(j) * dy_;
  // Σ ±c·D(|c|): even in c, so that x − a < 0 needs no form of its own.
  const auto edge = [](long double c, long double o, long double h) { return c * line_potential(std::abs(c), o, h); };
  const long double sum = edge(x + a, y, b) - edge(x - a, y, b) + edge(y + b, x, a) - edge(y - b, x, a);
  return static_cast<double>(sum * unit_ / std::numbers::pi_v<long double>);
}

void Displacement::fill_row(const simd::InfluenceKernels& kernels, std::int64_t j, std::int64_t first,
                            std::int64_t count, double* row) const {
  const double y = static_cast<double>(j) * dy_;
  const double a = 0.5 * dx_, b = 0.5 * dy_;
  const double scale = unit_ / std::numbers::pi;
  std::int64_t done = first;
  // The offsets from where the last zone ended to `end` are one zone: within(span, where to write).
  const auto zone = [&](std::int64_t end, auto within) {
    end = std::min(end, first + count);
    if (end <= done) return;
    within(simd::RowSpan{dx_, y, done, end - done}, row + (done - first));
    done = end;
  };
  const auto cells_to = [&](double distance) {
    const double x2 = distance * distance - y * y;
    return x2 > 0 ? static_cast<std::int64_t>(std::ceil(std::sqrt(x2) / dx_)) : std::int64_t{0};
  };

  const std::int64_t series_from = cells_to(kSeriesFrom[0] * longer_);
  if (j < kClosedCells) {
    zone(std::min(kClosedCells, series_from), [&](const simd::RowSpan& span, double* out) {
      for (std::int64_t k = 0; k < span.count; ++k) out[k] = closed_form(span.first + k, j);
    });
  } else {
    zone(std::min(j, series_from), [&](const simd::RowSpan& span, double* out) {
      kernels.displacement_along_y(rule_at(j), a, b, scale, span, out);
    });
  }
  while (done < std::min(series_from, first + count)) {
    const auto next = std::find_if(std::begin(kNodes), std::end(kNodes),
                                   [&](const NodesFrom& nodes) { return nodes.distance > done; });
    zone(next == std::end(kNodes) ? series_from : std::min(series_from, next->distance),
         [&](const simd::RowSpan& span, double* out) {
           kernels.displacement_along_x(rule_at(span.first), a, b, scale, span, out);
         });
  }
  for (int part = 0; part < 3; ++part) {
    zone(part < 2 ? cells_to(kSeriesFrom[part + 1] * longer_) : first + count,
         [&](const simd::RowSpan& span, double* out) { kernels.displacement_series[part](series_, span, out); });
  }
}

double Displacement::operator()(std::int64_t i, std::int64_t j) const {
  double coefficient = 0;
  fill_row(simd::kernels(simd::Isa::baseline).influence, std::abs(j), std::abs(i), 1, &coefficient);
  return coefficient;
}

void Displacement::fill(const parallel::Arena& arena, const simd::KernelTable& kernels, std::int64_t nx,
                        std::int64_t ny, double* coefficients) const {
  constexpr std::int64_t kCoefficientsPerTask = 1 << 15;
  const std::int64_t rows = std::max<std::int64_t>(1, kCoefficientsPerTask / std::max<std::int64_t>(1, nx));
  arena.for_chunks(ny, rows, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) fill_row(kernels.influence, j, 0, nx, coefficients + j * nx);
  });
}

}  // namespace brinell::influence
