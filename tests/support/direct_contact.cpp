#include "support/direct_contact.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>

#include "influence/displacement.h"

namespace brinell::support {

namespace {

using Real = long double;

constexpr int kMostChanges = 500;  // of the set of nodes in contact

std::int64_t offset(std::int64_t a, std::int64_t b, std::int64_t n, Boundary boundary) {
  return boundary == Boundary::free ? std::abs(a - b) : ((a - b) % n + n) % n;
}

constexpr Real kTurn = 2 * std::numbers::pi_v<Real>;

std::vector<Real> cosines(std::int64_t n) {
  std::vector<Real> values;
  for (std::int64_t k = 0; k < n; ++k) {
    values.push_back(std::cos(kTurn * static_cast<Real>(k) / static_cast<Real>(n)));
  }
  return values;
}

std::vector<Real> wave_numbers(std::int64_t n, double spacing) {
  std::vector<Real> values;
  for (std::int64_t k = 0; k < n; ++k) {
    values.push_back(kTurn * static_cast<Real>(std::min(k, n - k)) / (static_cast<Real>(n) * spacing));
  }
  return values;
}

/// Σ over wave numbers of 2/|q| cos(q·r) / (nx ny); |q| is even in both directions, so that the sines cancel.
std::vector<double> periodic_response(const Grid& grid) {
  const std::vector<Real> cos_x = cosines(grid.nx), cos_y = cosines(grid.ny);
  const std::vector<Real> q_x = wave_numbers(grid.nx, grid.dx), q_y = wave_numbers(grid.ny, grid.dy);
  std::vector<Real> symbol(grid.nodes());
  for (std::size_t n = 1; n < symbol.size(); ++n) {
    symbol[n] = 2 / std::hypot(q_x[n % q_x.size()], q_y[n / q_x.size()]) / static_cast<Real>(grid.nodes());
  }
  std::vector<double> response(grid.nodes());
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      Real sum = 0;
      for (std::int64_t l = 0; l < grid.ny; ++l) {
        Real row = 0;
        for (std::int64_t k = 0; k < grid.nx; ++k) {
          row += symbol[static_cast<std::size_t>(l * grid.nx + k)] * cos_x[static_cast<std::size_t>(k * i % grid.nx)];
        }
        sum += row * cos_y[static_cast<std::size_t>(l * j % grid.ny)];
      }
      response[static_cast<std::size_t>(j * grid.nx + i)] = static_cast<double>(sum);
    }
  }
  return response;
}

}  // namespace

std::vector<double> response_of(const Grid& grid, Boundary boundary) {
  if (boundary == Boundary::periodic) return periodic_response(grid);
  std::vector<double> response(grid.nodes());
  const influence::Displacement displacement(grid.dx, grid.dy);
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      response[static_cast<std::size_t>(j * grid.nx + i)] = displacement(i, j);
    }
  }
  return response;
}

std::vector<double> displacement_of(const Grid& grid, const std::vector<double>& response, Boundary boundary,
                                    const std::vector<double>& p) {
  std::vector<Real> sums(grid.nodes());
  for (std::int64_t source = 0; source < grid.nx * grid.ny; ++source) {
    const Real pressure = p[static_cast<std::size_t>(source)];
    if (pressure == 0) continue;
    for (std::int64_t j = 0; j < grid.ny; ++j) {
      const std::int64_t row = offset(j, source / grid.nx, grid.ny, boundary) * grid.nx;
      for (std::int64_t i = 0; i < grid.nx; ++i) {
        sums[static_cast<std::size_t>(j * grid.nx + i)] +=
            pressure * response[static_cast<std::size_t>(row + offset(i, source % grid.nx, grid.nx, boundary))];
      }
    }
  }
  std::vector<double> displacement(sums.size());
  std::ranges::transform(sums, displacement.begin(), [](Real sum) { return static_cast<double>(sum); });
  return displacement;
}

DirectContact direct_contact(const Grid& grid, Boundary boundary, const std::vector<double>& gap,
                             contact::Drive drive, double target) {
  const std::vector<double> response = response_of(grid, boundary);
  const auto nodes = static_cast<Eigen::Index>(grid.nodes());
  Eigen::MatrixXd compliance(nodes, nodes);
  for (Eigen::Index a = 0; a < nodes; ++a) {
    for (Eigen::Index b = 0; b < nodes; ++b) {
      const std::int64_t i = offset(a % grid.nx, b % grid.nx, grid.nx, boundary);
      const std::int64_t j = offset(a / grid.nx, b / grid.nx, grid.ny, boundary);
      compliance(a, b) = response[static_cast<std::size_t>(j * grid.nx + i)];
    }
  }
  // With the force prescribed, any multiple of 1·1ᵀ may be added: it only moves the approach by itself times P.
  // It makes the periodic K, which knows no mean displacement, definite.
  const double mean = drive == contact::Drive::force && boundary == Boundary::periodic ? grid.dx : 0;
  compliance.array() += mean;

  const Eigen::Map<const Eigen::VectorXd> heights(gap.data(), nodes);
  DirectContact contact{false, target, 0, std::vector<double>(grid.nodes())};
  std::vector<Eigen::Index> active;
  for (Eigen::Index n = 0; n < nodes; ++n) {
    if (drive == contact::Drive::force || gap[static_cast<std::size_t>(n)] < target) active.push_back(n);
  }
  Eigen::VectorXd pressure;
  for (int change = 0; change < kMostChanges && !contact.solved; ++change) {
    const auto count = static_cast<Eigen::Index>(active.size());
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(count);
    Eigen::VectorXd h(count);
    Eigen::MatrixXd among(count, count);
    for (Eigen::Index column = 0; column < count; ++column) {
      h[column] = heights[active[static_cast<std::size_t>(column)]];
      for (Eigen::Index row = 0; row < count; ++row) {
        among(row, column) =
            compliance(active[static_cast<std::size_t>(row)], active[static_cast<std::size_t>(column)]);
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> factors(among);
    if (factors.info() != Eigen::Success) return contact;
    Eigen::VectorXd p;
    if (drive == contact::Drive::force) {
      const Eigen::VectorXd under_approach = factors.solve(ones), under_gap = factors.solve(h);
      contact.approach = (target + under_gap.sum()) / under_approach.sum();
      p = contact.approach * under_approach - under_gap;
    } else {
      p = factors.solve(target * ones - h);
    }
    pressure = Eigen::VectorXd::Zero(nodes);
    for (Eigen::Index at = 0; at < count; ++at) pressure[active[static_cast<std::size_t>(at)]] = p[at];
    const Eigen::VectorXd g = heights + compliance * pressure;
    std::vector<Eigen::Index> next;
    std::vector<bool> was_active(grid.nodes(), false);
    for (const Eigen::Index n : active) was_active[static_cast<std::size_t>(n)] = true;
    for (Eigen::Index n = 0; n < nodes; ++n) {
      if (was_active[static_cast<std::size_t>(n)] ? pressure[n] > 0 : g[n] < contact.approach) next.push_back(n);
    }
    contact.solved = next == active;
    active = std::move(next);
  }
  contact.total = pressure.sum();
  contact.approach -= mean * contact.total;
  std::copy_n(pressure.data(), nodes, contact.pressure.data());
  return contact;
}

contact::Certificate certificate_by_sums(const Grid& grid, Boundary boundary, const std::vector<double>& gap,
                                         const std::vector<double>& p, double approach, contact::Drive drive,
                                         double target) {
  const std::vector<double> u = displacement_of(grid, response_of(grid, boundary), boundary, p);
  double largest = 0, penetration = 0;
  Real complementarity = 0, total = 0;
  double tension = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double open = gap[n] + u[n] - approach;
    largest = std::max(largest, std::fabs(u[n]));
    penetration = std::max(penetration, -open);
    complementarity += std::fabs(static_cast<Real>(p[n]) * open);
    total += p[n];
    tension = std::max(tension, -p[n]);
  }
  const double mean_pressure = static_cast<double>(total / static_cast<Real>(p.size()));
  largest = std::max(largest, mean_pressure * influence::Displacement(grid.dx, grid.dy)(0, 0));
  contact::Certificate certificate;
  certificate.penetration = penetration / largest;
  certificate.complementarity = static_cast<double>(complementarity / (total * largest));
  certificate.tension = tension;
  if (drive == contact::Drive::force) {
    certificate.balance = static_cast<double>(std::fabs(total - target)) / target;
  }
  return certificate;
}

}  // namespace brinell::support
