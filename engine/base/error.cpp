#include "base/error.h"

#include <array>
#include <charconv>

namespace brinell {

void fail(Status status, const std::string& message) {
  throw Error(status, message);
}

std::string text(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace brinell
