#include "influence/eigenstrain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "influence/eigenstrain_corners.h"
#include "influence/gauss_legendre.h"
#include "simd/kernel_table.h"
#include "simd/kernels/eigenstrain_tensors.inl"

namespace brinell::influence {

namespace {

using Long = long double;
using Counts = EigenstrainCorner::Counts;

/// From this many longest sides on the rule of 3 × 3 × 3 points serves.
constexpr double kFar = 28;
constexpr int kNodes = 3;

/// How often each axis occurs in derivative number `number` of order `order`.
constexpr Counts derivative_counts(int number, int order) {
  int m = 0;
  while ((m + 1) * (m + 2) / 2 <= number) ++m;
  const int t = number - m * (m + 1) / 2;
  return {order - m, m - t, t};
}

/// x, y and z occur so often in each of the image's potentials.
constexpr Counts image_counts(int potential) {
  constexpr Counts kChi[] = {{3, 1, 0}, {2, 2, 0}, {2, 1, 1}, {1, 2, 1}};
  if (potential < 14) return derivative_counts(potential, 4);
  if (potential < 18) return kChi[potential - 14];
  if (potential < 32) {
    const Counts four = derivative_counts(potential - 18, 4);
    return {four[0], four[1], four[2] + 1};
  }
  if (potential < 34) return potential == 32 ? Counts{2, 1, 0} : Counts{1, 2, 0};
  if (potential < 39) return {38 - potential, potential - 34, 0};
  return {42 - potential, potential - 39, 1};
}

Parities parities(int of_x, int of_y) {
  const auto parity = [](int n) { return n % 2 == 0 ? fft::Parity::even : fft::Parity::odd; };
  return {parity(of_x), parity(of_y)};
}

/// The sums over the corners of all potentials of one kind.
template <int potentials, class AtCorner>
void corner_sums(const simd::Cuboid& cuboid, Long x, Long y, Long z, double* potential, std::int64_t stride,
                 const AtCorner& at_corner) {
  std::array<Long, potentials> sum{};
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [corner](int axis) { return (corner >> axis & 1) != 0 ? -1 : 1; };
    const EigenstrainCorner at(x + side(0) * Long{cuboid.a}, y + side(1) * Long{cuboid.b},
                               z + side(2) * Long{cuboid.c});
    std::array<Long, potentials> values;
    at_corner(at, values);
    const Long sign = side(0) * side(1) * side(2);
    for (int k = 0; k < potentials; ++k)
      sum[static_cast<std::size_t>(k)] += sign * values[static_cast<std::size_t>(k)];
  }
  for (int k = 0; k < potentials; ++k) potential[k * stride] = static_cast<double>(sum[static_cast<std::size_t>(k)]);
}

void kelvin_at(const EigenstrainCorner& at, std::array<Long, simd::kKelvinPotentials>& values) {
  for (int k = 0; k < simd::kKelvinPotentials; ++k) {
    values[static_cast<std::size_t>(k)] = at.psi_4(derivative_counts(k, 4));
  }
}

void image_at(const EigenstrainCorner& at, std::array<Long, simd::kImagePotentials>& values) {
  for (int k = 0; k < simd::kImagePotentials; ++k) {
    const Counts n = image_counts(k);
    Long& value = values[static_cast<std::size_t>(k)];
    if (k < 14) {
      value = at.psi_4(n);
    } else if (k < 18) {
      value = k == 14 ? at.chi_1112() : k == 15 ? at.chi_1122() : at.chi_aab3(k - 16);
    } else if (k < 32) {
      value = at.psi_5(n);
    } else if (k < 34) {
      value = k == 32 ? at.phi_kkl(0, 1) : at.phi_kkl(1, 0);
    } else {
      value = at.phi_4(n);
    }
  }
}

void surface_at(const EigenstrainCorner& at, double nu, std::array<Long, simd::kSurfacePotentials>& values) {
  const Long kappa = 1 - 2 * Long{nu}, phi_3 = at.phi_1(2), all = 2 * Long{nu} * phi_3;
  values = {-(at.psi_3({2, 0, 1}) + kappa * at.chi_aa3(0)) + all,
            -(at.psi_3({0, 2, 1}) + kappa * at.chi_aa3(1)) + all,
            (3 - 2 * Long{nu}) * phi_3 - at.psi_3({0, 0, 3}) + all,
            2 * (at.psi_3({0, 1, 2}) - at.phi_1(1)),
            2 * (at.psi_3({1, 0, 2}) - at.phi_1(0)),
            -2 * (at.psi_3({1, 1, 1}) + kappa * at.chi_123())};
}

/// Of nuclei of stress to those of eigenstrain: s = 2 mu (strain + ν/(1 − 2ν) trace), and the common factor.
void turn_to_strain(StressOfStrain& nuclei, double nu) {
  const double factor = -1 / (8 * std::numbers::pi * (1 - nu)), bulk = nu / (1 - 2 * nu);
  for (auto& row : nuclei) {
    const double all = bulk * (row[0] + row[1] + row[2]);
    for (std::size_t j = 0; j < 3; ++j) row[j] += all;
    for (double& value : row) value *= factor;
  }
}

template <class At, std::size_t... entry>
StressOfStrain matrix_of(double nu, const At& at, std::index_sequence<entry...>) {
  StressOfStrain matrix{};
  ((matrix[entry / 6][entry % 6] =
        at.template operator()<static_cast<int>(entry / 6), static_cast<int>(entry % 6)>()),
   ...);
  turn_to_strain(matrix, nu);
  return matrix;
}

void check_finite(const char* name, double value) {
  if (!std::isfinite(value))
    fail(Status::invalid_argument, std::string(name) + " = " + text(value) + ": must be finite");
}

}  // namespace

Parities kelvin_parities(int potential) {
  const Counts n = derivative_counts(potential, 4);
  return parities(n[0], n[1]);
}
bool kelvin_odd_in_z(int potential) {
  return derivative_counts(potential, 4)[2] % 2 != 0;
}
Parities image_parities(int potential) {
  const Counts n = image_counts(potential);
  return parities(n[0], n[1]);
}
Parities surface_parities(int component) {
  return parities(component == 4 || component == 5 ? 1 : 0, component == 3 || component == 5 ? 1 : 0);
}

Eigenstrain::Eigenstrain(double dx, double dy, double dz, double poissons_ratio) : nu_(poissons_ratio) {
  for (const auto& [name, side] : {std::pair{"dx", dx}, std::pair{"dy", dy}, std::pair{"dz", dz}}) {
    if (!(side > 0) || !std::isfinite(side)) {
      fail(Status::invalid_argument,
           std::string(name) + " = " + text(side) + ": the side of a cuboid must be positive");
    }
  }
  if (!(poissons_ratio > -1) || !(poissons_ratio < 0.5)) {
    fail(Status::invalid_argument,
         "poissons_ratio = " + text(poissons_ratio) + ": must be greater than -1 and less than 0.5");
  }
  const int exponent = std::ilogb(std::max({dx, dy, dz}));
  unit_ = std::ldexp(1.0, exponent);
  dx_ = std::ldexp(dx, -exponent);
  dy_ = std::ldexp(dy, -exponent);
  dz_ = std::ldexp(dz, -exponent);
}

std::int64_t Eigenstrain::near_count(double side, double beside2, std::int64_t most) const {
  const double far = kFar * std::max({dx_, dy_, dz_});
  auto count = static_cast<std::int64_t>(std::min(static_cast<double>(most), far / side + 2));
  const auto near = [&](std::int64_t i) {
    const double x = static_cast<double>(i) * side;
    return x * x + beside2 < far * far;
  };
  while (count > 0 && !near(count - 1)) --count;
  return count;
}

void Eigenstrain::fill_row(const simd::EigenstrainKernels& kernels, Which which, double z, double y, double dx,
                           std::int64_t first, std::int64_t count, double* rows, std::int64_t stride) const {
  const simd::Cuboid cuboid{0.5 * dx_, 0.5 * dy_, 0.5 * dz_};
  const double far = kFar * std::max({dx_, dy_, dz_}), beside2 = y * y + z * z;
  const std::int64_t end = first + count;
  std::int64_t i = first;
  for (; i < end; ++i) {
    const double x = static_cast<double>(i) * dx;
    if (x * x + beside2 >= far * far) break;
    double* place = rows + (i - first);
    switch (which) {
      case Which::kelvin: corner_sums<simd::kKelvinPotentials>(cuboid, x, y, z, place, stride, kelvin_at); break;
      case Which::image: corner_sums<simd::kImagePotentials>(cuboid, x, y, z, place, stride, image_at); break;
      case Which::surface:
        corner_sums<simd::kSurfacePotentials>(
            cuboid, x, y, z, place, stride,
            [this](const EigenstrainCorner& at, std::array<Long, simd::kSurfacePotentials>& values) {
              surface_at(at, nu_, values);
            });
        break;
    }
  }
  fill_points(kernels, which, z, y, dx, i, end, rows + (i - first), stride);
}

/// By the product rule.
void Eigenstrain::fill_points(const simd::EigenstrainKernels& kernels, Which which, double z, double y, double dx,
                              std::int64_t first, std::int64_t end, double* rows, std::int64_t stride) const {
  if (first == end) return;
  const simd::Cuboid cuboid{0.5 * dx_, 0.5 * dy_, 0.5 * dz_};
  const simd::RowSpan span{dx, y, first, end - first};
  const simd::GaussRule& rule = gauss_legendre(kNodes);
  switch (which) {
    case Which::kelvin: return kernels.kelvin_points(cuboid, rule, z, span, rows, stride);
    case Which::image: return kernels.image_points(cuboid, rule, z, span, rows, stride);
    case Which::surface: return kernels.surface_points(cuboid, rule, z, nu_, span, rows, stride);
  }
}

/// Odd potentials vanish on their axis; a sum of rounded terms need not.
void Eigenstrain::clear_odd(Which which, double z, std::int64_t nx, std::int64_t ny, double* rows) const {
  const std::int64_t nodes = nx * ny;
  const int count = which == Which::kelvin  ? simd::kKelvinPotentials
                    : which == Which::image ? simd::kImagePotentials
                                            : simd::kSurfacePotentials;
  for (int k = 0; k < count; ++k) {
    const Parities odd = which == Which::kelvin  ? kelvin_parities(k)
                         : which == Which::image ? image_parities(k)
                                                 : surface_parities(k);
    double* quarter = rows + k * nodes;
    if (odd.y == fft::Parity::odd) std::fill_n(quarter, nx, 0.0);
    for (std::int64_t j = 0; odd.x == fft::Parity::odd && j < ny; ++j) quarter[j * nx] = 0;
    if (which == Which::kelvin && z == 0 && kelvin_odd_in_z(k)) std::fill_n(quarter, nodes, 0.0);
  }
}

void Eigenstrain::fill(const simd::EigenstrainKernels& kernels, Which which, double z, std::int64_t nx,
                       std::int64_t ny, double* rows) const {
  for (std::int64_t j = 0; j < ny; ++j) {
    fill_row(kernels, which, z, static_cast<double>(j) * dy_, dx_, 0, nx, rows + j * nx, nx * ny);
  }
  clear_odd(which, z, nx, ny, rows);
}

Eigenstrain::Extent Eigenstrain::near_extent(std::int64_t layer) const {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const double z = static_cast<double>(layer) * dz_;
  return {near_count(dx_, z * z, kMost), near_count(dy_, z * z, kMost)};
}

std::size_t Eigenstrain::near_scratch_bytes(const Extent& extent) {
  return 2 * sizeof(Long) * simd::kImagePotentials * static_cast<std::size_t>((extent.nx + 1) * (extent.ny + 1));
}

void Eigenstrain::fill_near(Potentials which, std::int64_t first, std::int64_t layers, const Extent& extent,
                            double* const* values) const {
  const bool image = which == Potentials::image;
  const int potentials = image ? simd::kImagePotentials : simd::kKelvinPotentials;
  const std::int64_t row = (extent.nx + 1) * potentials;  // of corners
  std::vector<Long> upper(static_cast<std::size_t>((extent.ny + 1) * row)), lower(upper.size());
  const auto beside2 = [](double y, double z) { return y * y + z * z; };
  const auto corners = [&](std::int64_t plane, std::vector<Long>& sums) {  // at z = (plane − 1/2) dz
    const double nearest = static_cast<double>(std::max(plane - 1, first)) * dz_;
    for (std::int64_t j = 0; j <= extent.ny; ++j) {
      const double y = static_cast<double>(std::max<std::int64_t>(0, j - 1)) * dy_;
      const std::int64_t count = near_count(dx_, beside2(y, nearest), extent.nx);
      Long* place = sums.data() + j * row;
      for (std::int64_t i = 0; count > 0 && i <= count; ++i, place += potentials) {
        const auto half = [](std::int64_t n, double side) { return (static_cast<Long>(n) - 0.5L) * Long{side}; };
        const EigenstrainCorner at(half(i, dx_), half(j, dy_), half(plane, dz_));
        if (image) {
          std::array<Long, simd::kImagePotentials> of_corner;
          image_at(at, of_corner);
          std::copy(of_corner.begin(), of_corner.end(), place);
        } else {
          std::array<Long, simd::kKelvinPotentials> of_corner;
          kelvin_at(at, of_corner);
          std::copy(of_corner.begin(), of_corner.end(), place);
        }
      }
    }
  };
  corners(first, lower);
  for (std::int64_t layer = first; layer < first + layers; ++layer) {
    corners(layer + 1, upper);
    const double z = static_cast<double>(layer) * dz_;
    double* result = values[layer - first];
    for (std::int64_t j = 0; j < extent.ny; ++j) {
      const std::int64_t count = near_count(dx_, beside2(static_cast<double>(j) * dy_, z), extent.nx);
      for (std::int64_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(j * row + i * potentials);
        const auto next = static_cast<std::size_t>(potentials), above = static_cast<std::size_t>(row);
        for (std::size_t k = 0; k < next; ++k) {
          const auto face = [&](const std::vector<Long>& sums) {
            return (sums[at + above + next + k] - sums[at + above + k]) - (sums[at + next + k] - sums[at + k]);
          };
          result[(static_cast<std::int64_t>(k) * extent.ny + j) * extent.nx + i] =
              static_cast<double>(face(upper) - face(lower));
        }
      }
    }
    std::swap(upper, lower);
  }
}

void Eigenstrain::fill_layer(const simd::EigenstrainKernels& kernels, Potentials which, std::int64_t layer,
                             std::int64_t nx, std::int64_t ny, const Extent& extent, const double* near,
                             double* potentials) const {
  const bool image = which == Potentials::image;
  const Which kind = image ? Which::image : Which::kelvin;
  const double z = static_cast<double>(layer) * dz_;
  for (std::int64_t j = 0; j < ny; ++j) {
    const double y = static_cast<double>(j) * dy_;
    const std::int64_t count = near_count(dx_, y * y + z * z, nx);
    for (int k = 0; count > 0 && k < (image ? simd::kImagePotentials : simd::kKelvinPotentials); ++k) {
      std::copy_n(near + (k * extent.ny + j) * extent.nx, count, potentials + (k * ny + j) * nx);
    }
    fill_points(kernels, kind, z, y, dx_, count, nx, potentials + j * nx + count, nx * ny);
  }
  clear_odd(kind, z, nx, ny, potentials);
}

void Eigenstrain::fill_kelvin(const simd::EigenstrainKernels& kernels, double z, std::int64_t nx, std::int64_t ny,
                              double* potentials) const {
  fill(kernels, Which::kelvin, z / unit_, nx, ny, potentials);
}
void Eigenstrain::fill_image(const simd::EigenstrainKernels& kernels, double zeta, std::int64_t nx, std::int64_t ny,
                             double* potentials) const {
  fill(kernels, Which::image, zeta / unit_, nx, ny, potentials);
}
void Eigenstrain::fill_displacement(const simd::EigenstrainKernels& kernels, double depth, std::int64_t nx,
                                    std::int64_t ny, double* displacements) const {
  fill(kernels, Which::surface, depth / unit_, nx, ny, displacements);
  const double factor = unit_ / (2 * std::numbers::pi);
  for (std::int64_t n = 0; n < simd::kSurfacePotentials * nx * ny; ++n) displacements[n] *= factor;
}

StressOfStrain Eigenstrain::full_space(double x, double y, double z) const {
  double potential[simd::kKelvinPotentials];
  fill_row(simd::kernels(simd::Isa::baseline).eigenstrain, Which::kelvin, z / unit_, y / unit_, x / unit_, 1, 1,
           potential, 1);
  simd::KelvinTensors<double> tensors;
  simd::kelvin_tensors(potential, tensors);
  return matrix_of(
      nu_, [&]<int I, int J>() { return simd::kelvin_stress<I, J>(tensors, nu_); }, std::make_index_sequence<36>());
}

Eigenstrain::Image Eigenstrain::image(double x, double y, double zeta) const {
  double potential[simd::kImagePotentials];
  fill_row(simd::kernels(simd::Isa::baseline).eigenstrain, Which::image, zeta / unit_, y / unit_, x / unit_, 1, 1,
           potential, 1);
  simd::ImageTensors<double> tensors;
  simd::image_tensors(potential, nu_, tensors);
  const auto part = [&]<simd::ImagePart which>() {
    return matrix_of(
        nu_, [&]<int I, int J>() { return simd::image_stress<which, I, J>(tensors, nu_); },
        std::make_index_sequence<36>());
  };
  Image image{part.template operator()<simd::ImagePart::a>(), part.template operator()<simd::ImagePart::b>(),
              part.template operator()<simd::ImagePart::c>()};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      image.b[i][j] /= unit_;
      image.c[i][j] /= unit_ * unit_;
    }
  }
  return image;
}

StressOfStrain Eigenstrain::stress(double x, double y, double z, double depth) const {
  for (const auto& [name, value] : {std::pair{"x", x}, std::pair{"y", y}, std::pair{"z", z}})
    check_finite(name, value);
  if (!(z >= 0)) fail(Status::invalid_argument, "z = " + text(z) + ": must be zero (the surface) or positive");
  if (!(depth / unit_ >= 0.5 * dz_) || !std::isfinite(depth)) {
    fail(Status::invalid_argument, "depth = " + text(depth) + ": must be half the cuboid's height or more");
  }
  StressOfStrain sum = full_space(x, y, z - depth);
  const Image above = image(x, y, z + depth);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) sum[i][j] += above.a[i][j] + z * (above.b[i][j] + z * above.c[i][j]);
  }
  // Where a face's own coordinate is zero the corners take the limit from above: the face of least coordinate is
  // inside.
  const auto within = [this](double offset, double side) {
    return offset / unit_ >= -0.5 * side && offset / unit_ < 0.5 * side;
  };
  if (within(x, dx_) && within(y, dy_) && within(z - depth, dz_)) {
    const double bulk = nu_ / (1 - 2 * nu_);
    for (std::size_t i = 0; i < 6; ++i) {
      sum[i][i] -= 1;
      for (std::size_t j = 0; i < 3 && j < 3; ++j) sum[i][j] -= bulk;
    }
  }
  return sum;
}

std::array<double, 6> Eigenstrain::displacement(double x, double y, double depth) const {
  std::array<double, 6> displacement{};
  fill_row(simd::kernels(simd::Isa::baseline).eigenstrain, Which::surface, depth / unit_, y / unit_, x / unit_, 1, 1,
           displacement.data(), 1);
  for (double& value : displacement) value *= unit_ / (2 * std::numbers::pi);
  return displacement;
}

}  // namespace brinell::influence
