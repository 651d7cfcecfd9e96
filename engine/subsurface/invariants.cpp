#include "subsurface/invariants.h"

#include "simd/kernel_table.h"

namespace brinell::subsurface {

namespace {

simd::StressArrays arrays_of(const Tensor& stress) {
  simd::StressArrays arrays;
  for (std::size_t c = 0; c < 6; ++c) arrays.component[c] = &stress[c];
  return arrays;
}

const simd::SubsurfaceKernels& for_one() {
  return simd::kernels(simd::Isa::baseline).subsurface;
}

constexpr std::size_t kFirstPrincipal = static_cast<std::size_t>(Invariant::principal_1);

}  // namespace

double von_mises(const Tensor& stress) {
  double result = 0;
  for_one().von_mises(1, arrays_of(stress), &result);
  return result;
}

double tresca(const Tensor& stress) {
  double result = 0;
  for_one().tresca(1, arrays_of(stress), &result);
  return result;
}

double hydrostatic(const Tensor& stress) {
  double result = 0;
  for_one().hydrostatic(1, arrays_of(stress), &result);
  return result;
}

Principal principal(const Tensor& stress) {
  Principal result{};
  simd::PrincipalArrays arrays;
  for (std::size_t k = 0; k < 3; ++k) {
    arrays.value[k] = &result.value[k];
    for (std::size_t axis = 0; axis < 3; ++axis) arrays.direction[3 * k + axis] = &result.direction[k][axis];
  }
  for_one().principal(1, arrays_of(stress), arrays);
  return result;
}

void fill_invariants(const simd::KernelTable& kernels, std::size_t n, const simd::StressArrays& stress,
                     const InvariantArrays& result) {
  const simd::SubsurfaceKernels& fill = kernels.subsurface;
  const auto wanted = [&result](Invariant invariant) {
    return result.invariant[static_cast<std::size_t>(invariant)];
  };
  if (double* values = wanted(Invariant::von_mises)) fill.von_mises(n, stress, values);
  if (double* values = wanted(Invariant::hydrostatic)) fill.hydrostatic(n, stress, values);
  if (double* values = wanted(Invariant::tresca)) fill.tresca(n, stress, values);
  simd::PrincipalArrays principal;
  bool any = result.direction[0] != nullptr;
  for (std::size_t k = 0; k < 3; ++k) {
    principal.value[k] = result.invariant[kFirstPrincipal + k];
    any = any || principal.value[k] != nullptr;
  }
  for (std::size_t k = 0; k < 9; ++k) principal.direction[k] = result.direction[k];
  if (any) fill.principal(n, stress, principal);
}

}  // namespace brinell::subsurface
