// Numbers of any width and byte order, read from a file's bytes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace brinell::cli {

/// The number stored at `bytes`, which need not be aligned.
template <class Number>
Number load_number(const char* bytes, std::endian order) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

/// Reads the number at `bytes` as a double.
using LoadNumber = double (*)(const char* bytes, std::endian order);

template <class Number>
double load_as_double(const char* bytes, std::endian order) {
  return static_cast<double>(load_number<Number>(bytes, order));
}

}  // namespace brinell::cli
