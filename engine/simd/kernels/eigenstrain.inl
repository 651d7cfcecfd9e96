#pragma once

#include "simd/kernels/eigenstrain_points.inl"

namespace brinell::simd {
namespace {

template <class Arch>
constexpr EigenstrainKernels eigenstrain_kernels() {
  return {
      .kelvin_points = kelvin_points<Arch>,
      .image_points = image_points<Arch>,
      .surface_points = surface_points<Arch>,
      .transform_spectra = nullptr,
      .spectra_scratch = nullptr,
      .residual_block = nullptr,
      .residual_scratch = nullptr,
      .accumulate_rows = nullptr,
      .backward_columns = nullptr,
  };
}

}  // namespace
}  // namespace brinell::simd
