// Residual stress of a box as textbooks have it, to compare with: every component of strain padded with zeros to
// 2nx × 2ny × 2nz, FFTW's r2c of each, products with full complex spectra of all 36 coefficients of the full space
// and of the three parts of the image (the correlation along z reads the transform at −k_z), c2r of 18 sums; planned
// by measure. With parts = 2 the image has one part only, as if it did not depend on z: not physical, but the least
// that convolution plus correlation can cost.
#pragma once

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "influence/eigenstrain.h"
#include "plastic/eigenstrain_response.h"

namespace brinell::bench {

class TextbookEigenstrain {
 public:
  using Complex = std::complex<double>;

  /// parts: 4 (full space, A, B, C) or 2 (full space, A).
  TextbookEigenstrain(const plastic::Box& box, double shear_modulus, double nu, int parts)
      : box_(box),
        parts_(parts),
        half_(box.nx + 1),
        size_(static_cast<std::size_t>(half_ * 2 * box.ny * 2 * box.nz)),
        shear_modulus_(shear_modulus) {
    for (Memory& strain : strain_) strain = allocate();
    sum_ = allocate();
    const int n[3] = {static_cast<int>(2 * box.nz), static_cast<int>(2 * box.ny), static_cast<int>(2 * box.nx)};
    auto* complex = reinterpret_cast<fftw_complex*>(sum_.get());
    auto* real = reinterpret_cast<double*>(sum_.get());
    forward_ = fftw_plan_dft_r2c(3, n, real, complex, FFTW_MEASURE);
    backward_ = fftw_plan_dft_c2r(3, n, complex, real, FFTW_MEASURE);
    make_spectra(nu);
  }
  ~TextbookEigenstrain() {
    fftw_destroy_plan(forward_);
    fftw_destroy_plan(backward_);
  }
  TextbookEigenstrain(const TextbookEigenstrain&) = delete;
  TextbookEigenstrain& operator=(const TextbookEigenstrain&) = delete;

  std::size_t spectra_bytes() const { return static_cast<std::size_t>(parts_ * 36) * size_ * sizeof(Complex); }

  void stress(const plastic::TensorView& strain, const plastic::TensorArrays& result) {
    for (std::size_t c = 0; c < 6; ++c) {
      pad(strain[c], reinterpret_cast<double*>(strain_[c].get()));
      transform(strain_[c].get());
    }
    for (std::size_t c = 0; c < 6; ++c) {
      for (int power = 0; power < std::max(1, parts_ - 1); ++power) {
        std::fill_n(sum_.get(), size_, Complex{});
        for (std::size_t s = 0; s < 6; ++s) {
          if (power == 0) add(spectrum(0, c, s), strain_[s].get());
          add_flipped(spectrum(1 + power, c, s), strain_[s].get());
        }
        fftw_execute_dft_c2r(backward_, reinterpret_cast<fftw_complex*>(sum_.get()),
                             reinterpret_cast<double*>(sum_.get()));
        take(power, result[c]);
      }
      for (std::size_t n = 0; n < box_.cuboids(); ++n) result[c][n] -= 2 * shear_modulus_ * strain[c][n];
    }
  }

 private:
  struct Release {
    void operator()(Complex* memory) const { fftw_free(memory); }
  };
  using Memory = std::unique_ptr<Complex, Release>;
  Memory allocate() const { return Memory(static_cast<Complex*>(fftw_malloc(sizeof(Complex) * size_))); }

  void transform(Complex* field) const {
    fftw_execute_dft_r2c(forward_, reinterpret_cast<double*>(field), reinterpret_cast<fftw_complex*>(field));
  }
  const Complex* spectrum(int part, std::size_t stress, std::size_t strain) const {
    return spectra_[static_cast<std::size_t>(part) * 36 + stress * 6 + strain].get();
  }

  void pad(const double* source, double* field) const {
    std::fill_n(field, 2 * size_, 0.0);
    for (std::int64_t k = 0; k < box_.nz; ++k) {
      for (std::int64_t j = 0; j < box_.ny; ++j) {
        std::copy_n(source + (k * box_.ny + j) * box_.nx, box_.nx, field + (k * 2 * box_.ny + j) * 2 * half_);
      }
    }
  }

  void add(const Complex* a, const Complex* x) {
    double* sum = reinterpret_cast<double*>(sum_.get());
    const auto *p = reinterpret_cast<const double*>(a), *q = reinterpret_cast<const double*>(x);
    for (std::size_t n = 0; n < 2 * size_; n += 2) {
      sum[n] += p[n] * q[n] - p[n + 1] * q[n + 1];
      sum[n + 1] += p[n] * q[n + 1] + p[n + 1] * q[n];
    }
  }
  void add_flipped(const Complex* a, const Complex* x) {
    const auto plane = static_cast<std::size_t>(half_ * 2 * box_.ny);
    for (std::int64_t k = 0; k < 2 * box_.nz; ++k) {
      const std::size_t here = static_cast<std::size_t>(k) * plane;
      const std::size_t there = static_cast<std::size_t>((2 * box_.nz - k) % (2 * box_.nz)) * plane;
      auto* sum = reinterpret_cast<double*>(sum_.get() + here);
      const auto *p = reinterpret_cast<const double*>(a + here), *q = reinterpret_cast<const double*>(x + there);
      for (std::size_t n = 0; n < 2 * plane; n += 2) {
        sum[n] += p[n] * q[n] - p[n + 1] * q[n + 1];
        sum[n + 1] += p[n] * q[n + 1] + p[n + 1] * q[n];
      }
    }
  }
  void take(int power, double* result) const {
    const auto* field = reinterpret_cast<const double*>(sum_.get());
    for (std::int64_t k = 0; k < box_.nz; ++k) {
      const double depth = (static_cast<double>(k) + 0.5) * box_.dz;
      const double factor = power == 0 ? 1 : power == 1 ? depth : depth * depth;
      for (std::int64_t j = 0; j < box_.ny; ++j) {
        double* to = result + (k * box_.ny + j) * box_.nx;
        const double* from = field + (k * 2 * box_.ny + j) * 2 * half_;
        for (std::int64_t i = 0; i < box_.nx; ++i) to[i] = (power == 0 ? 0 : to[i]) + factor * from[i];
      }
    }
  }

  void make_spectra(double nu) {
    for (int n = 0; n < parts_ * 36; ++n) {
      spectra_.push_back(allocate());
      std::fill_n(spectra_.back().get(), size_, Complex{});
    }
    const influence::Eigenstrain cuboid(box_.dx, box_.dy, box_.dz, nu);
    const double points = 8.0 * static_cast<double>(box_.cuboids());
    const auto odd_x = [](std::size_t c) { return c == 4 || c == 5; };
    const auto odd_y = [](std::size_t c) { return c == 3 || c == 5; };
    const auto put = [&](int part, const influence::StressOfStrain& matrix, std::int64_t i, std::int64_t j,
                         std::int64_t k) {
      for (std::size_t c = 0; c < 6; ++c) {
        for (std::size_t s = 0; s < 6; ++s) {
          double* field = reinterpret_cast<double*>(spectra_[static_cast<std::size_t>(part) * 36 + c * 6 + s].get());
          const double value = 2 * shear_modulus_ / points * matrix[c][s];
          for (const std::int64_t x : {i, -i}) {
            for (const std::int64_t y : {j, -j}) {
              const bool negative = (x < 0 && odd_x(c) != odd_x(s)) != (y < 0 && odd_y(c) != odd_y(s));
              const std::int64_t to_x = (x + 2 * box_.nx) % (2 * box_.nx), to_y = (y + 2 * box_.ny) % (2 * box_.ny);
              field[((k + 2 * box_.nz) % (2 * box_.nz) * 2 * box_.ny + to_y) * 2 * half_ + to_x] =
                  negative ? -value : value;
            }
          }
        }
      }
    };
    for (std::int64_t k = 1 - box_.nz; k < box_.nz; ++k) {
      for (std::int64_t j = 0; j < box_.ny; ++j) {
        for (std::int64_t i = 0; i < box_.nx; ++i) {
          const double x = static_cast<double>(i) * box_.dx, y = static_cast<double>(j) * box_.dy;
          put(0, cuboid.full_space(x, y, static_cast<double>(k) * box_.dz), i, j, k);
          const auto image = cuboid.image(x, y, static_cast<double>(k + box_.nz) * box_.dz);
          put(1, image.a, i, j, k);
          if (parts_ == 4) put(2, image.b, i, j, k);
          if (parts_ == 4) put(3, image.c, i, j, k);
        }
      }
    }
    for (int n = 0; n < parts_ * 36; ++n) {
      Complex* field = spectra_[static_cast<std::size_t>(n)].get();
      transform(field);
      if (n < 36) continue;
      // The image's sources come in reverse order.
      const auto plane = static_cast<std::size_t>(half_ * 2 * box_.ny);
      for (std::int64_t k = 0; k < 2 * box_.nz; ++k) {
        const Complex phase =
            std::polar(1.0, -std::numbers::pi * static_cast<double>(k * (box_.nz - 1) % (2 * box_.nz)) /
                                static_cast<double>(box_.nz));
        for (std::size_t m = 0; m < plane; ++m) field[static_cast<std::size_t>(k) * plane + m] *= phase;
      }
    }
  }

  plastic::Box box_;
  int parts_;
  std::int64_t half_;  // complex values of a padded row
  std::size_t size_;   // of a spectrum
  double shear_modulus_;
  std::array<Memory, 6> strain_;
  Memory sum_;
  std::vector<Memory> spectra_;  // [part][stress][strain]
  fftw_plan forward_{}, backward_{};
};

}  // namespace brinell::bench
