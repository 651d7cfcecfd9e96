// Residual stress that plastic strain, uniform in each cuboid of a box below the surface, leaves in the box.
//
// Cuboid (i, j, k) of the box has its centre at depth (k + 1/2) dz; the box's top is the surface. With the parts of
// influence/eigenstrain.h, cuboids k and k' apart by k − k' layers, the image k + k' + 1 layers above,
//
//   sigma_k = Σ_k' K[k − k'] * strain_k' + (A + z_k B + z_k² C)[k + k' + 1] * strain_k' − 2 mu strain_k,
//
// * the convolution over the layer: a convolution along z for the full space, a correlation for the image. Both are
// products after transforms along x, y, z, every one of which turns n real values into n complex ones at half-integer
// frequencies (fft/carrier.h), so that nothing is padded. Stored are the 15 real and 43 complex spectra of the
// potentials, all of A, B, C and K being sums of them that are formed when they are needed; the transform backward
// along z comes first, and z, z² with it, so that six components go back along y and x.
//
//   strain -- rows --> field [component][layer][block][row] -- one task a block: y, z, product, z, y --> rows ->
//   stress
//
// Plastic strain has no trace: zz is not read, −xx − yy stands for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/buffer.h"
#include "fft/convolution.h"
#include "influence/eigenstrain_table.h"
#include "plastic/tensor_fields.h"

namespace brinell::plastic {

/// nx × ny × nz cuboids from the surface down. Fields are [k][j][i], i inner.
struct Box {
  std::int64_t nx = 0, ny = 0, nz = 0;
  double dx = 0, dy = 0, dz = 0;  // [m]

  std::size_t cuboids() const {
    return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
  }
  friend bool operator==(const Box&, const Box&) = default;
};

class EigenstrainResponse {
 public:
  /// Generates the spectra. Throws Status::invalid_argument for what is no box or material, Status::too_large.
  EigenstrainResponse(const fft::Backend& backend, const Box& box, double shear_modulus, double poissons_ratio);
  /// The same cuboids in another box, with the potentials near them in common: not while another thread uses either.
  EigenstrainResponse(const EigenstrainResponse& other, const Box& box);
  ~EigenstrainResponse();
  EigenstrainResponse(const EigenstrainResponse&) = delete;
  EigenstrainResponse& operator=(const EigenstrainResponse&) = delete;

  /// Another box of the same cuboids. What does not depend on the box is kept, and memory that is large enough.
  void resize(const Box& box);

  /// What it allocates and keeps: spectra, field, scratch of every thread, potentials near the cuboid.
  struct Bytes {
    std::size_t spectra = 0;
    std::size_t work = 0;
    std::size_t generation = 0;  // more, while the spectra are generated
    std::size_t potentials = 0;  // for boxes to come
  };
  static Bytes bytes(const fft::Backend& backend, const Box& box);

  /// Residual stress [Pa] at the centres of the cuboids, six fields; the strain's may be the same memory. Components
  /// and layers without strain cost less. One call at a time; the bits do not depend on the number of threads.
  void stress(const TensorView& strain, const TensorArrays& result);

  const Box& box() const { return box_; }

 private:
  struct Geometry;
  void generate();

  fft::Backend backend_;
  Box box_;
  double shear_modulus_;
  std::shared_ptr<influence::EigenstrainTable> potentials_;
  std::unique_ptr<const Geometry> geometry_;
  Buffer<double> spectra_;  // [block][position in y][position in z][spectral value][lane]
  Buffer<double> field_;    // [component][layer][field of the lane transform]
  Buffer<double> scratch_;  // one part for each thread
  Buffer<unsigned char> given_;
};

}  // namespace brinell::plastic
