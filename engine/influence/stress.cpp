#include "influence/stress.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "influence/gauss_legendre.h"
#include "parallel/arena.h"
#include "simd/kernel_table.h"

namespace brinell::influence {

namespace {

// Nodes that a direction needs from this distance on, in sides of the cell along it: error ρ^(−2n), ρ ≈ 4·distance,
// below 1e-13. Nearer than the first, the closed form.
struct NodesFrom {
  double distance;
  int nodes;
};
constexpr std::array<NodesFrom, 6> kNodes{{{3, 8}, {6.5, 6}, {12, 5}, {28, 4}, {112, 3}, {2048, 2}}};

// The first i, for each line of kNodes, from which on it holds.
using Starts = std::array<std::int64_t, kNodes.size()>;

// The first i with i·dx >= x.
std::int64_t first_index(double x, double dx) {
  return x > 0 ? static_cast<std::int64_t>(std::min(std::ceil(x / dx), 9e15)) : 0;
}

double root_or_zero(double square) {
  return square > 0 ? std::sqrt(square) : 0.0;
}

// The line of kNodes that holds at i; −1: none.
int zone_at(const Starts& starts, std::int64_t i) {
  int zone = -1;
  for (const std::int64_t start : starts) zone += start <= i ? 1 : 0;
  return zone;
}

std::int64_t next_start(const Starts& starts, std::int64_t i, std::int64_t end) {
  for (const std::int64_t start : starts) {
    if (start > i) return std::min(start, end);
  }
  return end;
}

}  // namespace

Parities stress_parities(Traction traction, StressComponent component) {
  // A component changes sign under x → −x with each index x of its own and with the traction's.
  const bool x = component == StressComponent::xz || component == StressComponent::xy;
  const bool y = component == StressComponent::yz || component == StressComponent::xy;
  const auto parity = [](bool odd) { return odd ? fft::Parity::odd : fft::Parity::even; };
  return {parity(x != (traction == Traction::shear_x)), parity(y != (traction == Traction::shear_y))};
}

Stress::Stress(double dx, double dy, double depth, double poissons_ratio) {
  for (const auto& [name, side] : {std::pair{"dx", dx}, std::pair{"dy", dy}}) {
    if (!(side > 0) || !std::isfinite(side)) {
      fail(Status::invalid_argument,
           std::string(name) + " = " + text(side) + ": the side of a cell must be positive");
    }
  }
  if (!(depth >= 0) || !std::isfinite(depth)) {
    fail(Status::invalid_argument, "depth = " + text(depth) + ": must be zero (the surface) or positive");
  }
  if (!(poissons_ratio > -1) || !(poissons_ratio < 0.5)) {
    fail(Status::invalid_argument,
         "poissons_ratio = " + text(poissons_ratio) + ": must be greater than -1 and less than 0.5");
  }
  const int exponent = std::ilogb(std::max(dx, dy));
  dx_ = std::ldexp(dx, -exponent);
  dy_ = std::ldexp(dy, -exponent);
  cell_ = {0.5 * dx_, 0.5 * dy_, std::ldexp(depth, -exponent), 1 - 2 * poissons_ratio};
}

void Stress::fill_row(const simd::InfluenceKernels& kernels, Traction traction, std::int64_t j, std::int64_t first,
                      std::int64_t count, const simd::StressRows& rows) const {
  const double y = static_cast<double>(j) * dy_, z2 = cell_.z * cell_.z;
  const double beside = std::max(0.0, y - cell_.b);  // from the row to the cell
  // The integrand over ξ (over η) has its singularities at a distance √(x² + beside² + z²) (its like) from the
  // centre.
  Starts starts_x, starts_y;
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const double far_x = kNodes[k].distance * dx_, far_y = kNodes[k].distance * dy_;
    starts_x[k] = first_index(root_or_zero(far_x * far_x - beside * beside - z2), dx_);
    const double x2 = far_y * far_y - y * y - z2;
    starts_y[k] = x2 > 0 ? first_index(std::sqrt(x2) + cell_.a, dx_) : 0;
  }

  const auto source = static_cast<std::size_t>(traction);
  const std::int64_t end = first + count;
  for (std::int64_t i = first; i < end;) {
    const int zone_x = zone_at(starts_x, i), zone_y = zone_at(starts_y, i);
    const std::int64_t next = std::min(next_start(starts_x, i, end), next_start(starts_y, i, end));
    const simd::RowSpan span{dx_, y, i, next - i};
    simd::StressRows here;
    for (int c = 0; c < 6; ++c) {
      if (rows.component[c] != nullptr) here.component[c] = rows.component[c] + (i - first);
    }
    if (zone_x < 0 || zone_y < 0) {
      kernels.stress_closed[source](cell_, span, here);
    } else {
      kernels.stress_points[source](cell_, gauss_legendre(kNodes[zone_x].nodes), gauss_legendre(kNodes[zone_y].nodes),
                                    span, here);
    }
    i = next;
  }
  // Odd coefficients vanish on their axis; a sum of rounded terms need not.
  for (int c = 0; c < 6; ++c) {
    if (rows.component[c] == nullptr) continue;
    const Parities parities = stress_parities(traction, static_cast<StressComponent>(c));
    if (parities.x == fft::Parity::odd && first == 0) rows.component[c][0] = 0;
    if (parities.y == fft::Parity::odd && j == 0) std::fill_n(rows.component[c], count, 0.0);
  }
}

std::array<double, 6> Stress::operator()(Traction traction, std::int64_t i, std::int64_t j) const {
  std::array<double, 6> stress{};
  simd::StressRows rows;
  for (int c = 0; c < 6; ++c) rows.component[c] = &stress[c];
  fill_row(simd::kernels(simd::Isa::baseline).influence, traction, std::abs(j), std::abs(i), 1, rows);
  for (int c = 0; c < 6; ++c) {
    const Parities parities = stress_parities(traction, static_cast<StressComponent>(c));
    if ((i < 0 && parities.x == fft::Parity::odd) != (j < 0 && parities.y == fft::Parity::odd))
      stress[c] = -stress[c];
  }
  return stress;
}

void Stress::fill(const parallel::Arena& arena, const simd::KernelTable& kernels, Traction traction, std::int64_t nx,
                  std::int64_t ny, const std::array<double*, 6>& coefficients) const {
  constexpr std::int64_t kCoefficientsPerTask = 1 << 11;
  const std::int64_t chunk = std::max<std::int64_t>(1, kCoefficientsPerTask / std::max<std::int64_t>(1, nx));
  arena.for_chunks(ny, chunk, [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t j = begin; j < end; ++j) {
      simd::StressRows rows;
      for (int c = 0; c < 6; ++c) {
        if (coefficients[c] != nullptr) rows.component[c] = coefficients[c] + j * nx;
      }
      fill_row(kernels.influence, traction, j, 0, nx, rows);
    }
  });
}

}  // namespace brinell::influence
