// Gwyddion Simple Field 1.0: a magic line, "name = value" lines, one to four NUL bytes up to a multiple of four, then
// XRes · YRes little-endian single-precision numbers by rows. Missing points are NaN. XReal and YReal are the size of
// the whole image, so that spacing = size / resolution. (Gwyddion user guide, "Gwyddion Simple Field".)
#include <cmath>
#include <map>
#include <optional>

#include "formats/binary.h"
#include "formats/formats.h"

namespace brinell::cli {

namespace {

constexpr std::string_view kMagic = "Gwyddion Simple Field 1.0\n";

class Header {
 public:
  Header(const std::filesystem::path& path, std::string_view text) : path_(path) {
    while (!text.empty()) {
      const auto end = text.find('\n');
      const auto line = text.substr(0, end);
      text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
      const auto equals = line.find('=');
      if (equals == std::string_view::npos) continue;
      values_.emplace(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
    }
  }

  std::string text(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? "" : found->second;
  }

  std::int64_t resolution(const std::string& name) const {
    std::int64_t value = 0;
    if (!values_.contains(name)) fail_file(path_, "its header has no " + name);
    if (!parse_integer(text(name), value) || value < 1) {
      fail_file(path_, name + " = " + text(name) + ", expected a whole number of at least 1");
    }
    return value;
  }

  std::optional<double> size(const std::string& name) const {
    if (!values_.contains(name)) return std::nullopt;
    double value = 0;
    if (!parse_number(text(name), value) || !(value > 0) || !std::isfinite(value)) {
      fail_file(path_, name + " = " + text(name) + ", expected a positive number");
    }
    return value;
  }

 private:
  const std::filesystem::path& path_;
  std::map<std::string, std::string> values_;
};

}  // namespace

RawMap read_gsf(const std::filesystem::path& path, const std::string& bytes) {
  if (!bytes.starts_with(kMagic)) {
    fail_file(path, "is not a Gwyddion Simple Field: the first line is not 'Gwyddion Simple Field 1.0'");
  }
  const auto nul = bytes.find('\0');
  if (nul == std::string::npos) fail_file(path, "ends inside its header");
  const Header header(path, std::string_view(bytes).substr(kMagic.size(), nul - kMagic.size()));

  RawMap map;
  map.nx = header.resolution("XRes");
  map.ny = header.resolution("YRes");
  map.unit = header.text("ZUnits");
  const std::string lateral = header.text("XYUnits");
  const auto width = header.size("XReal");
  const auto height = header.size("YReal");
  if (!lateral.empty()) {
    const double metres = metres_per(lateral);
    if (std::isnan(metres)) fail_file(path, "XYUnits = " + lateral + ", expected a unit of length such as m");
    if (width) map.dx = in_metres(*width, metres) / static_cast<double>(map.nx);
    if (height) map.dy = in_metres(*height, metres) / static_cast<double>(map.ny);
  }

  const std::size_t nodes = checked_nodes(path, map.nx, map.ny);
  const std::size_t begin = (nul / 4 + 1) * 4;
  const std::size_t expected = begin + 4 * nodes;
  if (bytes.size() != expected) {
    fail_file(path, "holds " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected) +
                        " for " + std::to_string(map.nx) + " x " + std::to_string(map.ny) + " points");
  }
  map.heights.resize(nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    map.heights[k] = load_number<float>(bytes.data() + begin + 4 * k, std::endian::little);
  }
  return map;
}

}  // namespace brinell::cli
