#include "scene/engine.h"

#include <unistd.h>

#include "base/error.h"
#include "simd/kernel_table.h"

namespace brinell::scene {

namespace {

constexpr std::int32_t kMostThreads = 1024;
constexpr char kWisdomSeparator = '\f';  // FFTW's own text holds none

std::int32_t checked_threads(std::int32_t threads) {
  if (threads < 0 || threads > kMostThreads) {
    fail(Status::invalid_argument, "threads = " + std::to_string(threads) +
                                       ": allowed are 0 (what the caller may use) to " +
                                       std::to_string(kMostThreads));
  }
  return threads;
}

const simd::KernelTable& chosen_kernels(std::int32_t isa) {
  if (isa == 0) return simd::best_kernels();
  if (isa < 0 || isa > static_cast<std::int32_t>(simd::Isa::avx512)) {
    fail(Status::invalid_argument,
         "isa = " + std::to_string(isa) + ": allowed are 0 (best), 1 (baseline), 2 (avx2), 3 (avx512)");
  }
  return simd::kernels(static_cast<simd::Isa>(isa));
}

std::uint64_t machine_memory() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

Engine::Engine(const EngineOptions& options)
    : arena_(checked_threads(options.threads)),
      kernels_(chosen_kernels(options.isa)),
      memory_limit_(options.memory_limit != 0 ? options.memory_limit : machine_memory()),
      spectra_(options.cache_limit != 0 ? options.cache_limit : memory_limit_ / 4) {
  if (options.wisdom.empty()) return;
  const std::size_t separator = options.wisdom.find(kWisdomSeparator);
  if (separator == std::string::npos) {
    fail(Status::invalid_argument, "wisdom: the text is not one that brinell exported");
  }
  plans_.import_wisdom<double>(options.wisdom.substr(0, separator));
  plans_.import_wisdom<float>(options.wisdom.substr(separator + 1));
}

std::string Engine::export_wisdom() const {
  return plans_.export_wisdom<double>() + kWisdomSeparator + plans_.export_wisdom<float>();
}

}  // namespace brinell::scene
