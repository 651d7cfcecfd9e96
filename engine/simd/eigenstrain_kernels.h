// Eigenstrain in cuboids: potentials of one cuboid, many offsets at a time, and the product of their spectra with
// transformed strains. Formulas and numbering: engine/influence/eigenstrain.h; how the pieces make the residual
// stress of a box: engine/plastic/eigenstrain_response.h.
#pragma once

#include <cstdint>

#include "simd/influence_kernels.h"
#include "simd/transform_kernels.h"

namespace brinell::simd {

inline constexpr int kKelvinPotentials = 15;
inline constexpr int kImagePotentials = 43;
inline constexpr int kSurfacePotentials = 6;

/// Half sides of a cuboid.
struct Cuboid {
  double a = 0, b = 0, c = 0;
};

/// The strain that a box takes: five components of xx yy zz yz xz xy, for zz = −xx − yy. (An inline array would be
/// one symbol of all instruction sets.)
inline constexpr int kPlasticComponents = 5;
constexpr int kPlasticOrder[kPlasticComponents] = {0, 1, 3, 4, 5};

/// Spectral values of one frequency: the full space's potentials, the image's real parts, its imaginary parts.
inline constexpr int kSpectralValues = kKelvinPotentials + 2 * kImagePotentials;

/// Geometry of a box in the lane transform. A sequence along z is transformed as one along y is: nz real values, then
/// zeros, by a tree of root 1/4.
struct ResidualTransform {
  ColumnTransform<double> columns;  // along y
  TransformTree<double> along_z;
  std::int64_t nz;            // layers
  const double* depth;        // of each layer, in the unit of the potentials
  std::int64_t field_stride;  // from layer to layer in the field of one component, in doubles
  double poissons_ratio;
  double own;  // a unit impulse's spectrum: what a cuboid takes off its own stress, in the unit of the spectra
};

/// One block: field[c] is its part in layer 0 of component xx yy zz yz xz xy; strain in (zz unused), stress out.
struct ResidualBlock {
  double* field[6];
  const unsigned char* given;  // [plastic component][layer]: whether the strain is not all zero
  const double* spectra;       // [position in y][position in z][spectral value][lane]
};

struct EigenstrainKernels {
  /// The potentials of a cuboid at offsets x, y and z from its centre (full space), from its image's centre (image),
  /// from its centre to the surface (surface); by the product rule of points. rows: one after another, `stride`
  /// apart.
  void (*kelvin_points)(const Cuboid& cuboid, const GaussRule& rule, double z, const RowSpan& span, double* rows,
                        std::int64_t stride);
  void (*image_points)(const Cuboid& cuboid, const GaussRule& rule, double z, const RowSpan& span, double* rows,
                       std::int64_t stride);
  void (*surface_points)(const Cuboid& cuboid, const GaussRule& rule, double z, double poissons_ratio,
                         const RowSpan& span, double* rows, std::int64_t stride);

  /// Transforms along z, in place, the spectra of one block and position in y, [position in z][spectral value][lane].
  /// Before, position p holds the transforms along x and y of the full space's potentials p layers away, and of the
  /// image's nz + p layers above (real part) and nz − p layers above (imaginary part; none for p = 0), p < nz.
  /// phase: [position][re, im] of exp(−2πi θ (nz − 1)), as the image's sources come in reverse order.
  void (*transform_spectra)(const TransformTree<double>& along_z, std::int64_t nz, const double* phase, double scale,
                            double* spectra, double* scratch);
  std::int64_t (*spectra_scratch)(const TransformTree<double>& along_z);  // doubles

  /// Strain to residual stress in one block.
  void (*residual_block)(const ResidualTransform& transform, const ResidualBlock& block, double* scratch);
  std::int64_t (*residual_scratch)(const ResidualTransform& transform);

  /// transform += spectrum · (rows of a field, transformed along y); rows first … first + count of columns.ny are
  /// given. scratch: 2·lanes·(ny + 2·length) doubles.
  void (*accumulate_rows)(const ColumnTransform<double>& columns, const double* field, std::int64_t first,
                          std::int64_t count, const double* spectrum, bool turn_x, bool turn_y, double* transform,
                          double* scratch);
  /// A block's transform backward along y to its field; destroys the transform.
  void (*backward_columns)(const ColumnTransform<double>& columns, double* transform, double* field);
};

}  // namespace brinell::simd
