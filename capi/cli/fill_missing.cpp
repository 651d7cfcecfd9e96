#include "fill_missing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace brinell::cli {

bool fill_missing(std::int64_t nx, std::int64_t ny, std::vector<double>& heights) {
  std::vector<int> unknown(heights.size(), -1);  // number of each missing point among the missing ones
  std::vector<std::int64_t> missing;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    if (!std::isnan(heights[k])) continue;
    unknown[k] = static_cast<int>(missing.size());
    missing.push_back(static_cast<std::int64_t>(k));
  }
  if (missing.size() == heights.size()) return false;
  if (missing.empty()) return true;

  // Number of neighbours times the height, less the missing neighbours' heights, is the sum of the valid ones'.
  const auto count = static_cast<Eigen::Index>(missing.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(count);
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::int64_t i = missing[row] % nx;
    const std::int64_t j = missing[row] / nx;
    int neighbours = 0;
    for (const auto& [di, dj] : std::array<std::array<int, 2>, 4>{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}}) {
      if (i + di < 0 || i + di >= nx || j + dj < 0 || j + dj >= ny) continue;
      const auto neighbour = static_cast<std::size_t>((j + dj) * nx + i + di);
      ++neighbours;
      if (unknown[neighbour] < 0) {
        right_side[row] += heights[neighbour];
      } else {
        entries.emplace_back(static_cast<int>(row), unknown[neighbour], -1.0);
      }
    }
    entries.emplace_back(static_cast<int>(row), static_cast<int>(row), neighbours);
  }
  Eigen::SparseMatrix<double> laplacian(count, count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).solve(right_side);
  for (Eigen::Index row = 0; row < count; ++row) heights[missing[row]] = solution[row];
  return true;
}

}  // namespace brinell::cli
