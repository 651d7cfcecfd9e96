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

/// The strain that a box takes: five components, zz = −xx − yy.
inline constexpr int kPlasticComponents = 5;
inline constexpr int kPlasticOrder[kPlasticComponents] = {0, 1, 3, 4, 5};  // of xx yy zz yz xz xy

/// Geometry of a box in the lane transform, and what one block of it needs. A sequence along z is transformed as one
/// along y is: nz real values, then zeros, by a tree of root 1/4.
struct ResidualTransform {
  ColumnTransform<double> columns;  // along y
  TransformTree<double> along_z;
  std::int64_t nz;            // layers
  const double* depth;        // of each layer, in the unit of the spectra's potentials
  std::int64_t field_stride;  // of a layer in the field of one component, in doubles
  double poissons_ratio;
  double inside;  // spectrum of a unit impulse, times the factor of the potentials: what a cuboid itself has
};

/// One block: field[c] is its part in layer 0 of component xx yy zz yz xz xy; strain in (zz unused), stress out.
struct ResidualBlock {
  double* field[6];
  const unsigned char* given;  // [plastic component][layer]: whether the strain is not all zero
  const double* spectra;       // [position in y][position in z][15 full space, 43 image re, 43 image im][lane]
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

  /// Transforms along z, in place, the spectra of one block and position in y, planes of z as they come from the
  /// transforms along x and y: full space z = 0, 1 … (potentials odd in z: 0 at z = 0); image as real and imaginary
  /// part of position p the planes nz + p and nz − p (p = 0: none), in cuboids above the surface.
  void (*transform_spectra)(const TransformTree<double>& along_z, std::int64_t nz, double scale, double* spectra,
                            double* scratch);
  std::int64_t (*spectra_scratch)(const TransformTree<double>& along_z);

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
