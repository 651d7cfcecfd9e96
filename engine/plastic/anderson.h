// Acceleration of a fixed-point iteration x = map(x) (D. G. Anderson, 1965; H. F. Walker & P. Ni, 2011). With the
// residuals r_k = map(x_k) − x_k and the differences over the last few iterations,
//
//   gamma = argmin |r_k − Σ_j gamma_j (r_j+1 − r_j)|,   x_k+1 = map(x_k) − Σ_j gamma_j (map(x_j+1) − map(x_j)).
//
// Unknowns come in blocks, most of which are zero for good: only the active ones are read and written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/buffer.h"
#include "parallel/arena.h"

namespace brinell::plastic {

/// Unknowns of one place: `size` values of x and map(x), of which the blocks named are active, in rising order.
struct AndersonPart {
  double* x = nullptr;
  const double* mapped = nullptr;
  std::size_t size = 0;                    // a multiple of Anderson::kBlock
  std::span<const std::int64_t> blocks{};  // those of an iteration before are among them
};

class Anderson {
 public:
  static constexpr std::size_t kBlock = 128;

  explicit Anderson(const parallel::Arena& arena, std::size_t depth) : arena_(arena), depth_(depth) {}

  /// Forgets what was before, for parts of `size` values altogether.
  void start(std::size_t size);

  /// Replaces x by the next iterate. The bits do not depend on the number of threads.
  void advance(std::span<const AndersonPart> parts);

  /// Bytes of one for so many unknowns.
  static std::size_t bytes(std::size_t depth, std::size_t size) {
    return (2 * depth + 2) * Buffer<double>::padded_bytes(size);
  }

 private:
  struct Place {
    double* x;
    const double* mapped;
    std::size_t at;  // in the history
  };
  double* residual_step(std::size_t j) { return history_.data() + (2 + 2 * j) * size_; }
  double* mapped_step(std::size_t j) { return history_.data() + (3 + 2 * j) * size_; }
  std::vector<double> coefficients(std::size_t count);

  const parallel::Arena& arena_;
  std::size_t depth_;
  std::size_t size_ = 0;
  Buffer<double> history_;           // last residual, last mapped, then pairs of differences
  std::vector<std::uint8_t> known_;  // blocks whose history is there
  std::size_t steps_ = 0;            // differences that were taken
  bool begun_ = false;               // a residual is there
  std::vector<double> gram_;         // depth × depth: of the differences of residuals
  std::vector<double> right_;        // depth: with the present residual
};

}  // namespace brinell::plastic
