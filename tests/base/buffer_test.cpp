#include "base/buffer.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "base/error.h"

namespace brinell {
namespace {

TEST(Buffer, is_aligned_zeroed_and_padded_with_zeros) {
  for (std::size_t size = 0; size < 70; ++size) {
    Buffer<float> buffer(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % kAlignment, 0U);
    EXPECT_EQ(buffer.size(), size);
    EXPECT_EQ(buffer.bytes() % kAlignment, 0U);
    for (std::size_t i = 0; i < buffer.bytes() / sizeof(float); ++i) EXPECT_EQ(buffer.data()[i], 0.0F);
  }
}

TEST(Buffer, refuses_sizes_whose_bytes_overflow) {
  EXPECT_THROW(Buffer<double>(static_cast<std::size_t>(-1) / 8 + 1), std::bad_array_new_length);
}

TEST(Text, reads_back_as_the_same_number) {
  for (const double value : {0.0, 0.3, -2.1e11, 1e-300, 0.1 + 0.2}) EXPECT_EQ(std::stod(text(value)), value);
}

}  // namespace
}  // namespace brinell
