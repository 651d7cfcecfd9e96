// Convolutions by the lane transform (simd/transform_kernels.h), where SIMD lanes hold neighbouring frequencies of
// the rows' transform, so that columns are transformed without any shuffling, a block of `lanes` columns at a time:
//
//   source                    field                                           spectrum
//   row 0: | x x x x x x |    block 0: row 0 [re: lanes][im: lanes], row 1 …   block 0: [position in y][lane]
//   row 1: | x x x x x x |    block 1: row 0 [re: lanes][im: lanes], row 1 …   block 1: …
//            rows there  -->  each block is contiguous: forward in y, times spectrum, backward, in cache
//            and back    <--
//
// Sizes: along x lanes·2^a 3^b 5^c, along y 2^a 3^b 5^c; a free grid is padded up to them, a periodic one must have
// them.
#pragma once

#include <memory>

#include "fft/carrier.h"
#include "simd/transform_kernels.h"

namespace brinell::fft {

/// What of it others build on who transform along more than x and y (plastic/eigenstrain_response.h).
template <class Real>
class LaneCarrier : public Carrier<Real> {
 public:
  virtual const simd::RowTransform<Real>& rows() const = 0;
  virtual const simd::ColumnTransform<Real>& columns() const = 0;
};

/// Null if the transform has no such size, or if `must_pay` and FFTW would be faster. A free grid is padded to what
/// takes the least time, or, `densest`, to the fewest frequencies: for who does more with each than transform it.
template <class Real>
std::unique_ptr<const LaneCarrier<Real>> lane_carrier(const simd::TransformKernels<Real>& kernels, std::int64_t nx,
                                                      std::int64_t ny, Boundary boundary, bool must_pay,
                                                      bool densest = false);

}  // namespace brinell::fft
