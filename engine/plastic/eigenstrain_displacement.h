// Residual displacement of the surface that plastic strain in a box of cuboids leaves, on the grid of a contact:
//
//   u(i, j) = Σ over layers and components of coefficient(i − i', j − j') * strain(i', j'),
//
// positive into the body (a heave is negative), which adds to the deformed gap. The products of all layers are summed
// in frequency space, so one transform goes back. The spectra are those of whole layers of the grid, so the box may
// grow and move; each component and layer of strain that is all zero is left out. zz is not read: −xx − yy.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/grid.h"
#include "plastic/eigenstrain_response.h"

namespace brinell::plastic {

class EigenstrainDisplacement {
 public:
  /// For boxes of at most `layers` layers of height dz, with the grid's spacing. Generates the spectra.
  EigenstrainDisplacement(const fft::Backend& backend, const Grid& grid, std::int64_t layers, double dz,
                          double poissons_ratio);
  ~EigenstrainDisplacement();
  EigenstrainDisplacement(const EigenstrainDisplacement&) = delete;
  EigenstrainDisplacement& operator=(const EigenstrainDisplacement&) = delete;

  /// From now on for boxes of so many layers at least; those that are there stay.
  void deepen(std::int64_t layers);

  /// As EigenstrainResponse::bytes.
  static EigenstrainResponse::Bytes bytes(const fft::Backend& backend, const Grid& grid, std::int64_t layers,
                                          double dz);

  /// result: grid.nx × grid.ny values [m]. The box's cuboid (0, 0, k) lies below node (first_x, first_y); all of it
  /// must be below the grid, with the spacings given. One call at a time; the bits do not depend on the number of
  /// threads.
  void displacement(const TensorView& strain, const Box& box, std::int64_t first_x, std::int64_t first_y,
                    double* result);

  const Grid& grid() const { return grid_; }
  std::int64_t layers() const { return static_cast<std::int64_t>(spectra_.size()); }

 private:
  struct Geometry;
  void generate(std::int64_t layers);

  fft::Backend backend_;
  Grid grid_;
  double dz_;
  double poissons_ratio_;
  std::unique_ptr<const Geometry> geometry_;
  std::vector<Buffer<double>> spectra_;  // by layer: [plastic component][spectrum of the lane transform]
  Buffer<double> fields_;                // [layer of a group][plastic component][field of the lane transform]
  Buffer<double> sum_;                   // [block] transform along x and y
  Buffer<double> scratch_;               // one part for each thread
};

}  // namespace brinell::plastic
