// What all runs of one program share: threads, kernels, transform plans and influence coefficients.
#pragma once

#include <cstdint>
#include <string>

#include "contact/problem.h"
#include "fft/plan_cache.h"
#include "influence/spectrum_cache.h"
#include "parallel/arena.h"
#include "simd/isa.h"

namespace brinell::scene {

struct EngineOptions {
  std::int32_t threads = 0;        // 0: what the caller may use
  std::int32_t isa = 0;            // simd::Isa, or 0: the best that the machine has
  std::string wisdom;              // of export_wisdom(); empty: none
  std::uint64_t memory_limit = 0;  // [bytes] of one run; 0: the machine's memory
  std::uint64_t cache_limit = 0;   // [bytes]; 0: a quarter of memory_limit
};

class Engine {
 public:
  explicit Engine(const EngineOptions& options);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  const parallel::Arena& arena() const { return arena_; }
  const simd::KernelTable& kernels() const { return kernels_; }
  contact::Resources resources() { return {{arena_, kernels_, plans_}, spectra_}; }
  std::uint64_t memory_limit() const { return memory_limit_; }
  std::uint64_t cache_limit() const { return spectra_.byte_limit(); }

  /// Plans of double and single precision transforms as one text.
  std::string export_wisdom() const;

 private:
  parallel::Arena arena_;
  const simd::KernelTable& kernels_;
  std::uint64_t memory_limit_;
  fft::PlanCache plans_;
  influence::SpectrumCache spectra_;
};

}  // namespace brinell::scene
