// Instruction sets: which one this processor has, and the table of kernels compiled for each.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace brinell::simd {

struct KernelTable;

/// Weakest to strongest. baseline is what the architecture guarantees: SSE2 on x86-64, NEON on aarch64.
enum class Isa : std::int32_t { baseline = 1, avx2 = 2, avx512 = 3 };

std::string_view name(Isa isa);  // "baseline", "avx2", "avx512"

/// Those that were compiled in and that processor and operating system support, weakest first; never empty.
std::span<const Isa> supported();

/// The kernels of one instruction set. Throws Status::unsupported if this machine cannot run it.
const KernelTable& kernels(Isa isa);

/// The kernels of the strongest supported instruction set.
const KernelTable& best_kernels();

}  // namespace brinell::simd
