// a = b + s·c over arrays of doubles: the measure of memory bandwidth (J. D. McCalpin, STREAM, 1995).
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/buffer.h"
#include "parallel/arena.h"

namespace brinell::bench {

class StreamTriad {
 public:
  explicit StreamTriad(std::size_t length) : a_(length), b_(length), c_(length) {
    for (std::size_t i = 0; i < length; ++i) {
      b_[i] = 1;
      c_[i] = 2;
    }
  }

  void run(const parallel::Arena& arena) {
    arena.for_chunks(static_cast<std::int64_t>(a_.size()), std::int64_t{1} << 16,
                     [this](std::int64_t begin, std::int64_t end, int) {
                       double* a = a_.data();
                       const double* b = b_.data();
                       const double* c = c_.data();
                       for (std::int64_t i = begin; i < end; ++i) a[i] = b[i] + 3.0 * c[i];
                     });
  }

  /// Counted as STREAM does: two arrays read and one written.
  std::size_t bytes() const { return 3 * sizeof(double) * a_.size(); }
  const double* result() const { return a_.data(); }

 private:
  Buffer<double> a_, b_, c_;
};

}  // namespace brinell::bench
