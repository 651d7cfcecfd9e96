// Memory of large fields, straight from the system and back to it. The C library's heap keeps what is freed, and
// fields that grow step by step leave holes in it that the next, larger ones do not fit into.
#pragma once

#include <cstddef>

namespace brinell {

inline constexpr std::size_t kPagesFrom = std::size_t{4} << 20;  // bytes

/// Zero-filled. Throws std::bad_alloc.
void* allocate_pages(std::size_t bytes);
/// Other bytes, contents undefined; on failure (std::bad_alloc) the memory is as it was.
void* resize_pages(void* memory, std::size_t bytes, std::size_t wanted);
void release_pages(void* memory, std::size_t bytes) noexcept;

}  // namespace brinell
