// What the tests of this room share.
#pragma once

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "parallel/arena.h"

namespace brinell::surface {

/// FNV-1a of the bytes.
inline std::uint64_t hash_of(std::span<const double> values) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const double value : values) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ULL;
  }
  return hash;
}

/// Expects that make(arena), a field, has the same bits for 1, 2, 3 and 8 threads, with 8 threads really there.
template <class Make>
void expect_same_bits_for_any_threads(const Make& make) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const std::vector<double> one = make(parallel::Arena(1));
  for (const int threads : {2, 3, 8}) {
    const std::vector<double> many = make(parallel::Arena(threads));
    ASSERT_EQ(many.size(), one.size());
    EXPECT_EQ(std::memcmp(many.data(), one.data(), one.size() * sizeof(double)), 0) << threads << " threads";
  }
}

/// Expects that call() is refused as an invalid argument, with every one of the words in the message.
template <class Call>
void expect_refused(const Call& call, std::initializer_list<const char*> words) {
  try {
    call();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    for (const char* word : words) EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

}  // namespace brinell::surface
