// Stress below the surface as textbooks have it, to compare with: for each layer and component the sources padded
// with zeros to 2nx × 2ny, FFTW's r2c of each, the products with stored full complex spectra, their sum, c2r; planned
// by measure. Spectra: the corner sums, one scalar after the other, on the whole padded grid by symmetry, and r2c.
#pragma once

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "base/grid.h"
#include "influence/stress.h"

namespace brinell::bench {

/// 2π times the stress of unit pressure or shear along x on the cell |x| <= a, |y| <= b: eqs. of Love and Johnson.
inline std::array<double, 6> textbook_corner_sums(bool shear, double x, double y, double z, double a, double b,
                                                  double nu) {
  std::array<double, 6> sum{};
  for (const double side_x : {1.0, -1.0}) {
    for (const double side_y : {1.0, -1.0}) {
      const double X = x + side_x * a, Y = y + side_y * b, sign = side_x * side_y;
      const double A = X * X + z * z, B = Y * Y + z * z, rho = std::sqrt(A + Y * Y), m = 1 - 2 * nu;
      const double solid = std::atan2(X * Y, z * rho);
      if (shear) {
        sum[0] += sign * (2 * std::log(Y + rho) + X * X * Y / (A * rho) - m * Y / (rho + z));
        sum[1] += sign * (2 * nu * std::log(Y + rho) - Y / rho + m * Y / (rho + z));
        sum[2] += sign * z * z * Y / (A * rho);
        sum[3] -= sign * z / rho;
        sum[4] += sign * (z * X * Y / (A * rho) - solid);
        sum[5] += sign * (std::log(X + rho) - X / rho + m * X / (rho + z));
      } else {
        sum[0] += sign * (-2 * nu * solid + z * X * Y / (A * rho) - m * std::atan2(X * Y, A + z * rho));
        sum[1] += sign * (-2 * nu * solid + z * X * Y / (B * rho) - m * std::atan2(X * Y, B + z * rho));
        sum[2] += sign * (-solid - z * X * Y / rho * (1 / A + 1 / B));
        sum[3] += sign * z * z * X / (B * rho);
        sum[4] += sign * z * z * Y / (A * rho);
        sum[5] += sign * (-m * std::log(z + rho) - z / rho);
      }
    }
  }
  return sum;
}

class TextbookStress {
 public:
  /// Sources are the first 1 (pressure) or 3 (and both shears) tractions.
  TextbookStress(const Grid& grid, double nu, std::vector<double> depths, int sources)
      : grid_(grid),
        nu_(nu),
        depths_(std::move(depths)),
        sources_(sources),
        row_(2 * (grid.nx + 1)),
        spectrum_size_(static_cast<std::size_t>(row_ * 2 * grid.ny)),
        field_(allocate(spectrum_size_)),
        sum_(allocate(spectrum_size_)) {
    const int rows = static_cast<int>(2 * grid.ny), row = static_cast<int>(2 * grid.nx);
    auto* numbers = reinterpret_cast<fftw_complex*>(field_.get());
    auto* sums = reinterpret_cast<fftw_complex*>(sum_.get());
    forward_ = fftw_plan_dft_r2c_2d(rows, row, field_.get(), numbers, FFTW_MEASURE);
    backward_ = fftw_plan_dft_c2r_2d(rows, row, sums, sum_.get(), FFTW_MEASURE);
  }
  ~TextbookStress() {
    fftw_destroy_plan(forward_);
    fftw_destroy_plan(backward_);
  }
  TextbookStress(const TextbookStress&) = delete;
  TextbookStress& operator=(const TextbookStress&) = delete;

  void make_spectra() {
    spectra_.clear();
    for (std::size_t layer = 0; layer < depths_.size(); ++layer) make_layer(layer);
  }

  /// With stored spectra, or with each layer's generated on the way.
  void compute(const std::array<const double*, 3>& tractions, bool stored, std::span<double* const> fields) {
    const std::size_t nodes = grid_.nodes();
    for (std::size_t layer = 0; layer < depths_.size(); ++layer) {
      if (!stored) {
        spectra_.clear();
        make_layer(layer);
      }
      for (std::size_t c = 0; c < 6; ++c) {
        std::fill_n(sum_.get(), spectrum_size_, 0.0);
        for (int t = 0; t < sources_; ++t) {
          pad(tractions[static_cast<std::size_t>(t)]);
          fftw_execute(forward_);
          add_product(
              spectra_[((stored ? layer : 0) * static_cast<std::size_t>(sources_) + static_cast<std::size_t>(t)) * 6 +
                       c]
                  .get());
        }
        fftw_execute(backward_);
        double* result = fields[c] + layer * nodes;
        for (std::int64_t j = 0; j < grid_.ny; ++j) {
          std::copy_n(sum_.get() + j * row_, grid_.nx, result + j * grid_.nx);
        }
      }
    }
  }

 private:
  struct Release {
    void operator()(double* memory) const { fftw_free(memory); }
  };
  using Memory = std::unique_ptr<double, Release>;
  static Memory allocate(std::size_t size) {
    return Memory(static_cast<double*>(fftw_malloc(sizeof(double) * size)));
  }

  void pad(const double* source) {
    std::fill_n(field_.get(), spectrum_size_, 0.0);
    for (std::int64_t j = 0; j < grid_.ny; ++j) {
      std::copy_n(source + j * grid_.nx, grid_.nx, field_.get() + j * row_);
    }
  }

  void add_product(const double* spectrum) {
    const double* x = field_.get();
    double* sum = sum_.get();
    for (std::size_t k = 0; k < spectrum_size_; k += 2) {
      sum[k] += x[k] * spectrum[k] - x[k + 1] * spectrum[k + 1];
      sum[k + 1] += x[k] * spectrum[k + 1] + x[k + 1] * spectrum[k];
    }
  }

  void make_layer(std::size_t layer) {
    const double z = depths_[layer], a = 0.5 * grid_.dx, b = 0.5 * grid_.dy;
    std::vector<double> quarter(6 * grid_.nodes());
    const double scale = 1.0 / (2 * std::numbers::pi * 4.0 * static_cast<double>(grid_.nodes()));
    for (int t = 0; t < sources_; ++t) {
      for (std::int64_t j = 0; j < grid_.ny; ++j) {
        for (std::int64_t i = 0; i < grid_.nx; ++i) {
          const double x = static_cast<double>(i) * grid_.dx, y = static_cast<double>(j) * grid_.dy;
          std::array<double, 6> six{};
          if (t == 2) {
            const std::array<double, 6> turned = textbook_corner_sums(true, y, x, z, b, a, nu_);
            six = {turned[1], turned[0], turned[2], turned[4], turned[3], turned[5]};
          } else {
            six = textbook_corner_sums(t == 1, x, y, z, a, b, nu_);
          }
          for (std::size_t c = 0; c < 6; ++c) {
            quarter[c * grid_.nodes() + static_cast<std::size_t>(j * grid_.nx + i)] = scale * six[c];
          }
        }
      }
      for (int c = 0; c < 6; ++c) {
        const influence::Parities parities = influence::stress_parities(static_cast<influence::Traction>(t),
                                                                        static_cast<influence::StressComponent>(c));
        const double sign_x = parities.x == fft::Parity::odd ? -1 : 1,
                     sign_y = parities.y == fft::Parity::odd ? -1 : 1;
        const double* values = quarter.data() + static_cast<std::size_t>(c) * grid_.nodes();
        std::fill_n(field_.get(), spectrum_size_, 0.0);
        for (std::int64_t j = 0; j < 2 * grid_.ny; ++j) {
          if (j == grid_.ny) continue;
          const std::int64_t from_j = std::min(j, 2 * grid_.ny - j);
          for (std::int64_t i = 0; i < 2 * grid_.nx; ++i) {
            if (i == grid_.nx) continue;
            const std::int64_t from_i = std::min(i, 2 * grid_.nx - i);
            field_.get()[j * row_ + i] =
                (j > grid_.ny ? sign_y : 1) * (i > grid_.nx ? sign_x : 1) * values[from_j * grid_.nx + from_i];
          }
        }
        fftw_execute(forward_);
        spectra_.push_back(allocate(spectrum_size_));
        std::copy_n(field_.get(), spectrum_size_, spectra_.back().get());
      }
    }
  }

  Grid grid_;
  double nu_;
  std::vector<double> depths_;
  int sources_;
  std::int64_t row_;           // of a padded field, in doubles
  std::size_t spectrum_size_;  // in doubles
  Memory field_, sum_;
  std::vector<Memory> spectra_;  // [layer][source][component]
  fftw_plan forward_{}, backward_{};
};

}  // namespace brinell::bench
