// NumPy's array file: "\x93NUMPY", version, length of the header, a Python dictionary as text with descr,
// fortran_order and shape, then the numbers. (NumPy enhancement proposal 1.)
#include <optional>

#include "formats/binary.h"
#include "formats/formats.h"

namespace brinell::cli {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

struct ElementType {
  std::string_view name;
  std::size_t bytes;
  LoadNumber load;
};

constexpr std::array<ElementType, 10> kTypes{{
    {"f4", 4, load_as_double<float>},
    {"f8", 8, load_as_double<double>},
    {"i1", 1, load_as_double<std::int8_t>},
    {"i2", 2, load_as_double<std::int16_t>},
    {"i4", 4, load_as_double<std::int32_t>},
    {"i8", 8, load_as_double<std::int64_t>},
    {"u1", 1, load_as_double<std::uint8_t>},
    {"u2", 2, load_as_double<std::uint16_t>},
    {"u4", 4, load_as_double<std::uint32_t>},
    {"u8", 8, load_as_double<std::uint64_t>},
}};

/// Text after "'key':" in the header's dictionary.
std::string_view value_of(const std::filesystem::path& path, std::string_view header, const std::string& key) {
  const auto at = header.find("'" + key + "'");
  const auto colon = at == std::string_view::npos ? at : header.find(':', at);
  if (colon == std::string_view::npos) fail_file(path, "its header has no '" + key + "'");
  return trimmed(header.substr(colon + 1));
}

/// "(3, 4), }" into its numbers.
std::vector<std::int64_t> parse_shape(const std::filesystem::path& path, std::string_view text) {
  const auto close = text.find(')');
  if (!text.starts_with('(') || close == std::string_view::npos) fail_file(path, "its header has no valid shape");
  std::vector<std::int64_t> shape;
  for (text = trimmed(text.substr(1, close - 1)); !text.empty();) {
    const auto comma = text.find(',');
    std::int64_t size = 0;
    if (!parse_integer(trimmed(text.substr(0, comma)), size) || size < 0) {
      fail_file(path, "its header has no valid shape");
    }
    shape.push_back(size);
    text = comma == std::string_view::npos ? std::string_view{} : trimmed(text.substr(comma + 1));
  }
  return shape;
}

}  // namespace

RawMap read_npy(const std::filesystem::path& path, const std::string& bytes) {
  if (!bytes.starts_with(kMagic)) fail_file(path, "is not an NPY file: it does not begin with \\x93NUMPY");
  const std::size_t length_bytes = bytes.size() > 6 && bytes[6] == 1 ? 2 : 4;
  if (bytes.size() < 8 + length_bytes) fail_file(path, "ends inside its header");
  const std::size_t length = length_bytes == 2 ? load_number<std::uint16_t>(bytes.data() + 8, std::endian::little)
                                               : load_number<std::uint32_t>(bytes.data() + 8, std::endian::little);
  const std::size_t begin = 8 + length_bytes + length;
  if (bytes.size() < begin) fail_file(path, "ends inside its header");
  const auto header = std::string_view(bytes).substr(8 + length_bytes, length);

  const auto descr = value_of(path, header, "descr");
  const auto type_name = descr.size() > 4 ? descr.substr(2, 2) : std::string_view{};
  const ElementType* type = nullptr;
  for (const auto& candidate : kTypes) {
    if (candidate.name == type_name && descr[0] == '\'' && descr[4] == '\'') type = &candidate;
  }
  if (type == nullptr || std::string_view("<>|=").find(descr[1]) == std::string_view::npos) {
    fail_file(path, "descr = " + std::string(descr.substr(0, descr.find(','))) +
                        ", expected real or whole numbers (f4, f8, i1 to i8, u1 to u8)");
  }
  const auto order = descr[1] == '>' ? std::endian::big : descr[1] == '<' ? std::endian::little : std::endian::native;
  const bool columns_first = value_of(path, header, "fortran_order").starts_with("True");
  const auto shape = parse_shape(path, value_of(path, header, "shape"));
  if (shape.size() != 2) {
    fail_file(path, "holds an array of " + std::to_string(shape.size()) + " dimensions, expected 2: (ny, nx)");
  }

  RawMap map;
  map.ny = shape[0];
  map.nx = shape[1];
  const std::size_t nodes = checked_nodes(path, map.nx, map.ny);
  const std::size_t expected = begin + nodes * type->bytes;
  if (bytes.size() != expected) {
    fail_file(path, "holds " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected) +
                        " for " + std::to_string(map.nx) + " x " + std::to_string(map.ny) + " points");
  }
  map.heights.resize(nodes);
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) {
      const auto stored = static_cast<std::size_t>(columns_first ? i * map.ny + j : j * map.nx + i);
      map.heights[static_cast<std::size_t>(j * map.nx + i)] =
          type->load(bytes.data() + begin + stored * type->bytes, order);
    }
  }
  return map;
}

}  // namespace brinell::cli
