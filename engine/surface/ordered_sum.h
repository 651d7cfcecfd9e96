// Sums over a field whose bits depend on the grid alone, not on the number of threads: rows in fixed chunks, each
// summed with compensation (Neumaier 1974), the chunks combined in order.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parallel/arena.h"

namespace brinell::surface {

/// Adds numbers with the error of one rounding, and of the square of the unit roundoff times the sum of magnitudes.
class CompensatedSum {
 public:
  void add(double value) {
    const double sum = sum_ + value;
    lost_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
    sum_ = sum;
  }
  void add(const CompensatedSum& other) {
    add(other.sum_);
    lost_ += other.lost_;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0;
  double lost_ = 0;
};

/// Rows of nx nodes that one task takes: enough to be worth a task, few enough to share.
inline std::int64_t rows_per_chunk(std::int64_t nx) {
  constexpr std::int64_t kNodesPerChunk = 16384;
  return std::max<std::int64_t>(1, kNodesPerChunk / nx);
}

/// The Partials that visit(partial, j) gathers over the rows j of each chunk, in chunk order.
template <class Partial, class Visit>
std::vector<Partial> gather_rows(std::int64_t nx, std::int64_t ny, const parallel::Arena& arena, const Visit& visit) {
  const std::int64_t rows = rows_per_chunk(nx);
  std::vector<Partial> partials(static_cast<std::size_t>((ny + rows - 1) / rows));
  arena.for_chunks(ny, rows, [&](std::int64_t begin, std::int64_t end, int) {
    Partial partial;
    for (std::int64_t j = begin; j < end; ++j) visit(partial, j);
    partials[static_cast<std::size_t>(begin / rows)] = partial;
  });
  return partials;
}

}  // namespace brinell::surface
