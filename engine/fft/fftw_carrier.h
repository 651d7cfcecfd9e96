// Convolutions by FFTW's one-dimensional transforms: any size, both boundaries.
#pragma once

#include <memory>

#include "fft/carrier.h"

namespace brinell::fft {

template <class Real>
std::unique_ptr<const Carrier<Real>> fftw_carrier(PlanCache& plans, std::int64_t nx, std::int64_t ny,
                                                  Boundary boundary);

}  // namespace brinell::fft
