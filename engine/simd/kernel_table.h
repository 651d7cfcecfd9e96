// Every kernel that is compiled once per instruction set, as plain function pointers. Kernels know arrays and
// plain structs only: no allocation, no threads, no exceptions.
#pragma once

#include <type_traits>

#include "simd/contact_kernels.h"
#include "simd/eigenstrain_kernels.h"
#include "simd/influence_kernels.h"
#include "simd/isa.h"
#include "simd/return_mapping_kernels.h"
#include "simd/subsurface_kernels.h"
#include "simd/transform_kernels.h"

namespace brinell::simd {

/// The kernels that exist in both precisions.
template <class Real>
struct RealKernels {
  ContactKernels<Real> contact;
  ContactKernels<Real> tilting_contact;  // of bodies that may tilt
  TransformKernels<Real> transform;
};

struct KernelTable {
  Isa isa;
  RealKernels<double> in_double;
  RealKernels<float> in_single;
  InfluenceKernels influence;
  SubsurfaceKernels subsurface;
  ReturnMappingKernels return_mapping;
  EigenstrainKernels eigenstrain;

  template <class Real>
  const RealKernels<Real>& of() const {
    if constexpr (std::is_same_v<Real, double>) {
      return in_double;
    } else {
      return in_single;
    }
  }
};

const KernelTable& kernels_baseline();
const KernelTable& kernels_avx2();
const KernelTable& kernels_avx512();

}  // namespace brinell::simd
