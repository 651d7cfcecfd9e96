// Rows of numbers as text, with or without the header of Gwyddion's text export:
//
//   # Channel: ZSensor
//   # Width: 10.00 µm         physical size of the whole image: spacing = width / number of columns
//   # Height: 10.00 µm
//   # Value units: m
//
// Gwyddion takes a pixel for an area, so the size is the number of pixels times the spacing. The file may be UTF-8 or
// Latin-1. Lines that start with # and are not of this header are comments. A file has one separator: a semicolon if
// there is one, else a comma, else blanks and tabs.
#include <cmath>
#include <limits>

#include "formats/formats.h"

namespace brinell::cli {

namespace {

struct Reader {
  const std::filesystem::path& path;
  RawMap map{};
  double width = std::numeric_limits<double>::quiet_NaN();
  double height = std::numeric_limits<double>::quiet_NaN();
  char separator = 0;  ///< ';', ',', ' ' for blanks and tabs; 0 until the first row
  std::int64_t line = 0;

  [[noreturn]] void fail_line(const std::string& text) const {
    fail_file(path, "line " + std::to_string(line) + ": " + text);
  }

  /// "10.00 µm" in metres.
  double length(std::string_view text) const {
    const auto blank = text.find_first_of(" \t");
    double value = 0;
    if (blank == std::string_view::npos || !parse_number(text.substr(0, blank), value)) {
      fail_line("expected a length with its unit, for example 10.00 um, found '" + std::string(text) + "'");
    }
    const auto unit = trimmed(text.substr(blank));
    const double metres = in_metres(value, metres_per(unit));
    if (!(metres > 0) || !std::isfinite(metres)) {
      fail_line("expected a positive length in m, mm, um or nm, found '" + std::string(text) + "'");
    }
    return metres;
  }

  void read_comment(std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) return;
    const auto name = trimmed(text.substr(0, colon));
    const auto value = trimmed(text.substr(colon + 1));
    if (name == "Width") width = length(value);
    if (name == "Height") height = length(value);
    if (name == "Value units") map.unit = value;
  }

  void append(std::string_view field) {
    double value = 0;
    field = trimmed(field);
    if (!parse_number(field, value)) {
      fail_line("expected a number such as 1.5e-6 (with a decimal point), found '" +
                std::string(field.substr(0, 40)) + "'");
    }
    map.heights.push_back(value);
  }

  void read_row(std::string_view text) {
    if (separator == 0) {
      separator = text.find(';') != std::string_view::npos   ? ';'
                  : text.find(',') != std::string_view::npos ? ','
                                                             : ' ';
    }
    const std::size_t before = map.heights.size();
    const std::string_view separators = separator == ';' ? ";" : separator == ',' ? "," : " \t";
    while (!text.empty()) {
      const auto end = text.find_first_of(separators);
      append(text.substr(0, end));
      if (end == std::string_view::npos) break;
      text = trimmed(text.substr(end + 1));
    }
    const auto columns = static_cast<std::int64_t>(map.heights.size() - before);
    if (map.ny == 0) map.nx = columns;
    if (columns != map.nx) {
      fail_line("holds " + std::to_string(columns) + " numbers, the rows before it " + std::to_string(map.nx));
    }
    ++map.ny;
  }
};

}  // namespace

RawMap read_text_matrix(const std::filesystem::path& path, const std::string& bytes) {
  if (bytes.find('\0') != std::string::npos) {
    fail_file(path, "is not a text of numbers, and not a Gwyddion Simple Field, NPY, X3P or HDF5 file either");
  }
  Reader reader{path};
  std::string_view rest = bytes;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty()) {
    ++reader.line;
    const auto end = rest.find('\n');
    const auto text = trimmed(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    if (text.empty()) continue;
    if (text[0] == '#') {
      reader.read_comment(text.substr(1));
    } else {
      reader.read_row(text);
    }
  }
  RawMap& map = reader.map;
  if (map.ny == 0) fail_file(path, "holds no numbers");
  map.dx = reader.width / static_cast<double>(map.nx);
  map.dy = reader.height / static_cast<double>(map.ny);
  return std::move(map);
}

}  // namespace brinell::cli
