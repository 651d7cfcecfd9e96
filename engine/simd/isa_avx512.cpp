#include "simd/kernels/table.inl"

namespace brinell::simd {

const KernelTable& kernels_avx512() {
  static constexpr KernelTable table = make_table<xsimd::avx512bw>(Isa::avx512);
  return table;
}

}  // namespace brinell::simd
