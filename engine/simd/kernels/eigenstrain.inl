#pragma once

#include "simd/kernels/eigenstrain_points.inl"
#include "simd/kernels/eigenstrain_residual.inl"

namespace brinell::simd {
namespace {

template <class Arch>
constexpr EigenstrainKernels eigenstrain_kernels() {
  return {
      .kelvin_points = kelvin_points<Arch>,
      .image_points = image_points<Arch>,
      .surface_points = surface_points<Arch>,
      .transform_spectra = transform_spectra<Arch>,
      .spectra_scratch = spectra_scratch<Arch>,
      .residual_block = residual_block<Arch>,
      .residual_scratch = residual_scratch<Arch>,
      .accumulate_rows = accumulate_rows<Arch>,
      .backward_columns = backward_columns<Arch>,
  };
}

}  // namespace
}  // namespace brinell::simd
