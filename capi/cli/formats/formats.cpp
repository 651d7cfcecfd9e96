#include "formats/formats.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "errors.h"

namespace brinell::cli {

RawMap::RawMap() : dx(std::numeric_limits<double>::quiet_NaN()), dy(dx) {}

void fail_file(const std::filesystem::path& path, const std::string& text) {
  throw FileError(path.string() + ": " + text);
}

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail_file(path, "no such file");
  if (std::filesystem::is_directory(status)) fail_file(path, "is a folder, expected a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail_file(path, "cannot be opened for reading");
  std::ostringstream content;
  content << stream.rdbuf();
  if (stream.bad()) fail_file(path, "cannot be read to its end");
  return std::move(content).str();
}

double metres_per(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 13> kUnits{{
      {"m", 1.0},
      {"km", 1e3},
      {"cm", 1e-2},
      {"mm", 1e-3},
      {"um", 1e-6},
      {"\xC2\xB5m", 1e-6},  // micro sign, UTF-8
      {"\xCE\xBCm", 1e-6},  // Greek mu, UTF-8
      {"\xB5m", 1e-6},      // micro sign, Latin-1
      {"nm", 1e-9},
      {"pm", 1e-12},
      {"\xC3\x85", 1e-10},      // Angstrom, UTF-8
      {"\xE2\x84\xAB", 1e-10},  // Angstrom sign, UTF-8
      {"\xC5", 1e-10},          // Angstrom, Latin-1
  }};
  for (const auto& [name, metres] : kUnits) {
    if (name == unit) return metres;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double in_metres(double value, double scale) {
  return scale < 1 ? value / std::round(1 / scale) : value * scale;
}

std::size_t checked_nodes(const std::filesystem::path& path, std::int64_t nx, std::int64_t ny) {
  constexpr std::int64_t kMostNodes = std::int64_t{1} << 31;
  if (nx < 1 || ny < 1) {
    fail_file(path, "holds " + std::to_string(nx) + " x " + std::to_string(ny) + " points, expected at least 1 x 1");
  }
  if (nx > kMostNodes / ny) {
    fail_file(path, "claims " + std::to_string(nx) + " x " + std::to_string(ny) + " points, at most " +
                        std::to_string(kMostNodes) + " are allowed");
  }
  return static_cast<std::size_t>(nx * ny);
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

namespace {

template <class Number>
bool parse(std::string_view text, Number& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  return parse(text, value);
}
bool parse_integer(std::string_view text, std::int64_t& value) {
  return parse(text, value);
}

std::string number_text(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

}  // namespace brinell::cli
