#include "simd/kernels/table.inl"

namespace brinell::simd {

const KernelTable& kernels_avx2() {
  static constexpr KernelTable table = make_table<xsimd::fma3<xsimd::avx2>>(Isa::avx2);
  return table;
}

}  // namespace brinell::simd
