#include "simd/kernels/table.inl"

namespace brinell::simd {

const KernelTable& kernels_baseline() {
  static constexpr KernelTable table = make_table<xsimd::default_arch>(Isa::baseline);
  return table;
}

}  // namespace brinell::simd
