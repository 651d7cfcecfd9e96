// Stress and surface displacement that a uniform eigenstrain in one cuboid of a half-space leaves behind (R. D.
// Mindlin, D. H. Cheng, 1950; S. B. P. Chiu, 1978, by way of Mindlin's point forces of 1936). The cuboid, sides dx dy
// dz, lies with its centre at depth c; z points into the body, tension is positive, the surface z = 0 is free.
//
//   sigma(x, y, z) = K(x, y, z − c) + A(x, y, zeta) + z B(x, y, zeta) + z² C(x, y, zeta) − (own part, inside),
//
// zeta = z + c: K is the whole space's, the others are the image's above the surface. All are derivatives of three
// potentials of the points of the cuboid (of its image), xi the way to the field point, R = |xi|,
//
//   phi = 1/R,   psi = R,   chi = xi_3 ln(R + xi_3) − R,
//
// contracted with the eigenstrain. With 16 pi mu (1 − ν) G = 4(1−ν) delta_ij phi − psi,ij (full space), and for the
// image I0 + z I1 + z² I2, q = 4(1−ν)(1−2ν), i the displacement, j the force, a b from x y:
//
//   ij   I0                                                 I1                             I2
//   ab   4(1−ν) delta_ab phi − (3−4ν) psi,ab − q chi,ab      −2 psi,ab3                      2 phi,ab
//   3b   (3−4ν) psi,b3 + q chi,b3                            −4(1−2ν) phi,b − 2 psi,b33      2 phi,b3
//   a3   (3−4ν) psi,a3 − q chi,a3                            2 psi,a33 − 8(1−ν) phi,a       −2 phi,a3
//   33   8(1−ν)² phi − (3−4ν) psi,33                         2 psi,333 − 4 phi,3            −2 phi,33
//
// As phi and chi are harmonic, chi,33 = phi, psi's Laplacian is 2 phi, all of it follows from few real derivatives:
//
//   full space, 15:  psi,ijkl                       in the order 1111 1112 1113 1122 1123 1133 1222 … 3333
//   image, 43:       psi,ijkl but 3333 (14); chi,1112 1122 1123 1223; psi,ijkl3 but 33333 (14); phi,112 122;
//                    phi,1111 1112 1122 1222 2222 1113 1123 1223 2223
//
// They are what spectra are made of (engine/plastic). A potential has the parity of its number of 1s in x, of 2s in
// y, and in the full space of 3s in z.
//
// Near the cuboid closed forms, differences over its corners in long double; from 28 longest sides on a rule of
// 3 × 3 × 3 points. Error: 1e-9 of the largest coefficient at the point, mostly far less.
#pragma once

#include <array>
#include <cstdint>

#include "influence/stress.h"
#include "simd/eigenstrain_kernels.h"

namespace brinell::influence {

/// [stress xx yy zz yz xz xy][strain xx yy zz yz xz xy]; a shear's column has both tensor components 1.
using StressOfStrain = std::array<std::array<double, 6>, 6>;

class Eigenstrain {
 public:
  /// Sides [m] positive and finite, −1 < poissons_ratio < 0.5. Throws Status::invalid_argument.
  Eigenstrain(double dx, double dy, double dz, double poissons_ratio);

  /// Stress per 2·(shear modulus) at (x, y, z), z >= 0 [m], of the cuboid centred at (0, 0, depth), depth >= dz/2;
  /// its own part is taken off inside, where also the faces of least x, y, z count; on an edge it is infinite.
  StressOfStrain stress(double x, double y, double z, double depth) const;

  /// Its part K, z from the centre, without the own part; and the image's.
  StressOfStrain full_space(double x, double y, double z) const;
  struct Image {
    StressOfStrain a, b, c;  // per metre^0, ^-1, ^-2
  };
  Image image(double x, double y, double zeta) const;

  /// Displacement of the surface into the body [m] at (x, y).
  std::array<double, 6> displacement(double x, double y, double depth) const;

  /// The potentials on a quarter grid of nx × ny offsets of whole cells, [potential][j·nx + i], lengths in units of
  /// unit(): full space at z from the centre, image at zeta, both not negative; displacement of the surface [m].
  void fill_kelvin(const simd::EigenstrainKernels& kernels, double z, std::int64_t nx, std::int64_t ny,
                   double* potentials) const;
  void fill_image(const simd::EigenstrainKernels& kernels, double zeta, std::int64_t nx, std::int64_t ny,
                  double* potentials) const;
  void fill_displacement(const simd::EigenstrainKernels& kernels, double depth, std::int64_t nx, std::int64_t ny,
                         double* displacements) const;

  /// Near the cuboid the offsets of layer after layer share the corners of the closed forms. Layer `layer` lies at
  /// z = layer·dz; it is near at offsets i·dx, j·dy within a circle, which the rectangle of what is returned holds.
  enum class Potentials { kelvin, image };
  struct Extent {
    std::int64_t nx = 0, ny = 0;
    friend bool operator==(const Extent&, const Extent&) = default;
  };
  Extent near_extent(std::int64_t layer) const;
  /// values[n]: [potential][j·nx + i] of layer first + n where it is near, the rest is left alone; first >= 1 for the
  /// image. The extent is at most that of the first layer.
  void fill_near(Potentials which, std::int64_t first, std::int64_t layers, const Extent& extent,
                 double* const* values) const;
  static std::size_t near_scratch_bytes(const Extent& extent);  // of one call

  /// As fill_kelvin and fill_image at z = layer·dz, with what fill_near made of an extent at least as large.
  void fill_layer(const simd::EigenstrainKernels& kernels, Potentials which, std::int64_t layer, std::int64_t nx,
                  std::int64_t ny, const Extent& extent, const double* near, double* potentials) const;

  double unit() const { return unit_; }  // a power of two near the longest side [m]
  double poissons_ratio() const { return nu_; }

 private:
  enum class Which { kelvin, image, surface };
  /// How many offsets of whole cells of this side are near, beside2 the square of the distance across.
  std::int64_t near_count(double side, double beside2, std::int64_t most) const;
  void fill_row(const simd::EigenstrainKernels& kernels, Which which, double z, double y, double dx,
                std::int64_t first, std::int64_t count, double* rows, std::int64_t stride) const;
  void fill_points(const simd::EigenstrainKernels& kernels, Which which, double z, double y, double dx,
                   std::int64_t first, std::int64_t end, double* rows, std::int64_t stride) const;
  void clear_odd(Which which, double z, std::int64_t nx, std::int64_t ny, double* rows) const;
  void fill(const simd::EigenstrainKernels& kernels, Which which, double z, std::int64_t nx, std::int64_t ny,
            double* rows) const;

  double unit_;
  double dx_, dy_, dz_;  // in units
  double nu_;
};

/// How a potential continues to negative offsets.
Parities kelvin_parities(int potential);
bool kelvin_odd_in_z(int potential);
Parities image_parities(int potential);
/// The same for the displacement of the surface, of a strain component.
Parities surface_parities(int component);

}  // namespace brinell::influence
