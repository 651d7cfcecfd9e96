// Memory of fields: aligned to a cache line and a SIMD register of any instruction set.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "base/pages.h"

namespace brinell {

inline constexpr std::size_t kAlignment = 64;

/// Array of trivial T, 64-byte aligned. Its allocation is rounded up to whole cache lines, and the
/// padding behind size() is zero, so that kernels may read (never rely on) whole registers past the end.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;

  /// Zero-filled.
  explicit Buffer(std::size_t size) : Buffer(size, Uninitialised{}) {
    if (size != 0 && !data_.get_deleter().fresh()) {
      std::memset(static_cast<void*>(data_.get()), 0, padded_bytes(size));
    }
  }

  /// Contents undefined but for the padding; for fields that are wholly written before they are read.
  static Buffer uninitialised(std::size_t size) {
    Buffer buffer(size, Uninitialised{});
    buffer.clear_padding();
    return buffer;
  }

  /// Another size, contents undefined but for the padding. Memory that is large enough stays, and if there is too
  /// little it is not held twice.
  void resize(std::size_t size) {
    check_size(size);
    const std::size_t before = data_ == nullptr ? 0 : data_.get_deleter().bytes;
    if (padded_bytes(size) > before) {
      if (before >= kPagesFrom) {
        const std::size_t bytes = padded_bytes(size);
        void* memory = resize_pages(data_.get(), before, bytes);
        static_cast<void>(data_.release());
        data_ = Memory(static_cast<T*>(memory), Release{bytes});
      } else {
        data_.reset();
        size_ = 0;
        *this = Buffer(size, Uninitialised{});
      }
    }
    size_ = size;
    clear_padding();
  }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return padded_bytes(size_); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* begin() { return data_.get(); }
  T* end() { return data_.get() + size_; }
  const T* begin() const { return data_.get(); }
  const T* end() const { return data_.get() + size_; }
  operator std::span<T>() { return {data(), size_}; }
  operator std::span<const T>() const { return {data(), size_}; }

  static constexpr std::size_t padded_bytes(std::size_t size) {
    return (size * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
  }

 private:
  struct Uninitialised {};
  struct Release {
    std::size_t bytes = 0;
    bool fresh() const { return bytes >= kPagesFrom; }  // zero from the system
    void operator()(T* memory) const {
      if (fresh()) return release_pages(memory, bytes);
      ::operator delete[](memory, std::align_val_t{kAlignment});
    }
  };
  using Memory = std::unique_ptr<T[], Release>;

  Buffer(std::size_t size, Uninitialised) : size_(size) {
    if (size == 0) return;
    check_size(size);
    const std::size_t bytes = padded_bytes(size);
    void* memory =
        bytes >= kPagesFrom ? allocate_pages(bytes) : ::operator new[](bytes, std::align_val_t{kAlignment});
    data_ = Memory(static_cast<T*>(memory), Release{bytes});
  }

  static void check_size(std::size_t size) {
    if (size > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
  }

  void clear_padding() {
    if (size_ != 0) std::memset(static_cast<void*>(data_.get() + size_), 0, padded_bytes(size_) - size_ * sizeof(T));
  }

  Memory data_;
  std::size_t size_ = 0;
};

}  // namespace brinell
