#include "fft/good_sizes.h"

#include <array>

namespace brinell::fft {

std::int64_t good_size(std::int64_t n) {
  for (std::int64_t candidate = n < 1 ? 1 : n;; ++candidate) {
    std::int64_t rest = candidate;
    for (const std::int64_t prime : std::array{2, 3, 5, 7}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return candidate;
  }
}

}  // namespace brinell::fft
