#include "base/pages.h"

#include <new>

// Sanitizers see overruns of what operator new returns.
#if defined(__unix__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BRINELL_MAPS_PAGES
#include <sys/mman.h>
#else
#include <cstring>
#endif

namespace brinell {

#ifdef BRINELL_MAPS_PAGES

namespace {

void* advised(void* memory, std::size_t bytes) {
  if (memory == MAP_FAILED) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kHuge = std::size_t{16} << 20;  // large pages are of 2 MB: little is rounded up
  if (bytes >= kHuge) madvise(memory, bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
  return advised(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), bytes);
}

void* resize_pages(void* memory, std::size_t bytes, std::size_t wanted) {
#ifdef MREMAP_MAYMOVE
  return advised(mremap(memory, bytes, wanted, MREMAP_MAYMOVE), wanted);
#else
  void* other = allocate_pages(wanted);
  release_pages(memory, bytes);
  return other;
#endif
}

void release_pages(void* memory, std::size_t bytes) noexcept {
  munmap(memory, bytes);
}

#else

constexpr std::align_val_t kPage{4096};

void* allocate_pages(std::size_t bytes) {
  void* memory = ::operator new(bytes, kPage);
  std::memset(memory, 0, bytes);
  return memory;
}

void* resize_pages(void* memory, std::size_t bytes, std::size_t wanted) {
  void* other = allocate_pages(wanted);
  release_pages(memory, bytes);
  return other;
}

void release_pages(void* memory, std::size_t) noexcept {
  ::operator delete(memory, kPage);
}

#endif

}  // namespace brinell
