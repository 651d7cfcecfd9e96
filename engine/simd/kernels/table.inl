// Included by each simd/isa_*.cpp: all kernels for one instruction set. Everything in the .inl files has internal
// linkage, so that code for one instruction set can never stand in for that of another.
#include <xsimd/xsimd.hpp>

#include "simd/kernel_table.h"
#include "simd/kernels/contact.inl"
#include "simd/kernels/eigenstrain.inl"
#include "simd/kernels/influence.inl"
#include "simd/kernels/return_mapping.inl"
#include "simd/kernels/subsurface.inl"
#include "simd/kernels/transform.inl"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
constexpr RealKernels<Real> make_real_kernels() {
  return {contact_kernels<Arch, Real, false>(), contact_kernels<Arch, Real, true>(), transform_kernels<Arch, Real>()};
}

template <class Arch>
constexpr KernelTable make_table(Isa isa) {
  return {isa,
          make_real_kernels<Arch, double>(),
          make_real_kernels<Arch, float>(),
          influence_kernels<Arch>(),
          subsurface_kernels<Arch>(),
          return_mapping_kernels<Arch>(),
          eigenstrain_kernels<Arch>()};
}

}  // namespace
}  // namespace brinell::simd
