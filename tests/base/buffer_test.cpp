#include "base/buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <new>
#include <utility>

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

TEST(Buffer, of_many_bytes_is_zeroed_and_aligned_too) {
  const std::size_t size = kPagesFrom / sizeof(float) + 5;
  Buffer<float> buffer(size);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % kAlignment, 0U);
  for (std::size_t i = 0; i < buffer.bytes() / sizeof(float); ++i) ASSERT_EQ(buffer.data()[i], 0.0F);
}

TEST(Buffer, resized_has_its_size_and_padding_whatever_it_was) {
  const std::size_t many = kPagesFrom / sizeof(float);
  Buffer<float> buffer;
  for (const std::size_t size : {std::size_t{3}, std::size_t{40}, many + 1, 2 * many + 3, many, std::size_t{7},
                                 std::size_t{0}, std::size_t{17}}) {
    buffer.resize(size);
    ASSERT_EQ(buffer.size(), size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % kAlignment, 0U);
    for (float& value : buffer) value = 1;
    for (std::size_t i = size; i < buffer.bytes() / sizeof(float); ++i) EXPECT_EQ(buffer.data()[i], 0.0F);
  }
  const float* memory = buffer.data();
  buffer.resize(many);
  EXPECT_EQ(buffer.data(), memory) << "there was more";
  const Buffer<float> taken(std::move(buffer));
  buffer = Buffer<float>();
  buffer.resize(5);
  EXPECT_EQ(taken.data(), memory);
  EXPECT_NE(buffer.data(), memory);
}

TEST(Buffer, refuses_sizes_whose_bytes_overflow) {
  constexpr std::size_t kTooMany = static_cast<std::size_t>(-1) / 8 + 1;
  EXPECT_THROW(Buffer<double>{kTooMany}, std::bad_array_new_length);
  Buffer<double> buffer(3);
  EXPECT_THROW(buffer.resize(kTooMany), std::bad_array_new_length);
  EXPECT_EQ(buffer.size(), 3U);
}

TEST(Buffer, that_the_system_cannot_give_leaves_the_one_before) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers stop the program instead";
#endif
  constexpr std::size_t kBeyondAddresses = std::size_t{1} << 58;
  Buffer<double> buffer(kPagesFrom / sizeof(double));
  buffer[0] = 4;
  EXPECT_THROW(buffer.resize(kBeyondAddresses), std::bad_alloc);
  EXPECT_EQ(buffer[0], 4);
}

TEST(Text, reads_back_as_the_same_number) {
  for (const double value : {0.0, 0.3, -2.1e11, 1e-300, 0.1 + 0.2}) EXPECT_EQ(std::stod(text(value)), value);
}

}  // namespace
}  // namespace brinell
