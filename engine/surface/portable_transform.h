// Fourier transform of any length whose bits are the same on every machine, for generated surfaces: a library's
// transform picks its code by the processor. Scalar Stockham passes of radix 4, 2, 3, 5, 7, 11 and 13; other
// lengths by Bluestein's convolution with a chirp (L. Bluestein 1970).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/buffer.h"

namespace brinell::surface {

struct Complex {
  double re;
  double im;
};

/// X_k = sum over j of x_j · exp(+2·pi·i·j·k/length), not normalised. Immutable: one object serves all threads.
class PortableTransform {
 public:
  explicit PortableTransform(std::int64_t length);

  std::int64_t length() const { return length_; }

  /// Elements of scratch memory that a call needs.
  std::size_t scratch_size() const;

  /// In place.
  void operator()(Complex* values, Complex* scratch) const;

 private:
  void stockham(Complex* values, Complex* scratch) const;
  void bluestein(Complex* values, Complex* scratch) const;

  std::int64_t length_;
  std::vector<int> radices_;                   // of the Stockham passes; their product is length_
  Buffer<Complex> roots_;                      // exp(2·pi·i·k/length_), k < length_
  std::unique_ptr<PortableTransform> padded_;  // null: Stockham. Else its length is a power of two >= 2·length_ − 1
  Buffer<Complex> chirp_;                      // exp(pi·i·k²/length_), k < length_
  Buffer<Complex> chirp_spectrum_;             // of the conjugate chirp, divided by padded_->length()
};

}  // namespace brinell::surface
