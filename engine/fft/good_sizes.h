// Lengths that FFTW transforms fast.
#pragma once

#include <cstdint>

namespace brinell::fft {

/// The smallest 2^a 3^b 5^c 7^d that is at least n.
std::int64_t good_size(std::int64_t n);

}  // namespace brinell::fft
