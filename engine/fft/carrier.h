// What carries a convolution out: rows forward, blocks of columns there and back, rows backward,
//
//   source --rows--> field [row][frequency in x] --block: forward in y, times spectrum, backward--> --rows--> result.
//
// Each pass is a set of independent tasks that the Convolution gives to the threads; a carrier does one task.
//
// Free boundary. A real sequence a of length n, zero-padded to 2n, is transformed at half-integer frequencies,
//
//   A_m = Σ_{i<n} a_i exp(−2πi (m + 1/4) i / n),        a_i = Re (1/n) Σ_{m<n} A_m exp(+2πi (m + 1/4) i / n):
//
// of the 2n frequencies (k + 1/2)/2n these are the even k, and the odd ones are their conjugates. So the padded real
// sequence costs one complex transform of length n, without padding, unpacking or special frequencies, and a product
// of such transforms is the linear convolution as far as offsets |d| < n go (sequences continue as a_{i+2n} = −a_i).
// In y, real and imaginary part of a row's transform are two real sequences again. A kernel that is even along an
// axis has a real transform there, an odd one −i times a real one: one real array of n_x·n_y values is all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/function_ref.h"
#include "fft/convolution.h"

namespace brinell::fft {

template <class Real>
class Carrier {
 public:
  virtual ~Carrier() = default;

  virtual Method method() const = 0;
  virtual std::int64_t padded_nx() const = 0;
  virtual std::int64_t padded_ny() const = 0;
  virtual std::int64_t blocks() const = 0;         // tasks of the column pass
  virtual std::size_t field_size() const = 0;      // of the transformed rows, in Reals
  virtual std::size_t scratch_size() const = 0;    // of one task, in Reals
  virtual std::size_t transform_size() const = 0;  // of a source transformed in x and y, in Reals
  virtual std::size_t spectrum_size() const = 0;   // in Reals

  /// The part of a stored spectrum that belongs to one block, from value(mx, my): the kernel's real transform at
  /// frequencies (mx + 1/4)/n_x, (my + 1/4)/n_y on a free boundary, mx/nx, my/ny (all of them, not only a half) on
  /// a periodic one, where the two factors −i of a kernel odd in both are in the values; normalisation included.
  virtual void arrange(std::int64_t block, FunctionRef<double(std::int64_t mx, std::int64_t my)> value,
                       Real* spectrum) const = 0;

  /// Whether the carrier itself can transform kernels given in space, and one block of such a spectrum, from the
  /// field of the kernel's quarter whose values on the axes are halved along even axes: even sums are twice the real
  /// part of what a source's are, odd ones minus twice the imaginary part.
  virtual bool transforms_kernels() const { return false; }
  virtual void spectrum_block(std::int64_t, Parity, Parity, const Real*, Real*, Real*) const {}

  /// `rows` begins with row `begin` of the source, `result` below with row 0.
  virtual void rows_forward(std::int64_t begin, std::int64_t end, const Real* rows, Real* field,
                            Real* scratch) const = 0;
  virtual void convolve_block(std::int64_t block, const Spectrum<Real>& spectrum, Real* field,
                              Real* scratch) const = 0;
  /// The halves of convolve_block apart: forward from the field, and a sum of products backward to the field.
  virtual void transform_block(std::int64_t block, const Real* field, Real* transform, Real* scratch) const = 0;
  virtual void sum_block(std::int64_t block, std::span<const Term<Real>> terms, Real* field, Real* scratch) const = 0;

  virtual void rows_backward(std::int64_t begin, std::int64_t end, Real* field, Real* result,
                             Real* scratch) const = 0;
};

}  // namespace brinell::fft
