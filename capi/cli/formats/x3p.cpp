// X3P, ISO 25178-72: a zip archive with main.xml (axes, sizes), a binary file of heights, and the MD5 checksum of
// each. Lengths are metres. The heights run x first, then y; an axis is increment · index + offset. Missing points
// are NaN, or, where heights are whole numbers, zero bits of a second binary file (least significant bit first).
#include <cmath>
#include <limits>
#include <optional>
#include <pugixml.hpp>

#include "formats/binary.h"
#include "formats/formats.h"
#include "formats/zip_archive.h"

namespace brinell::cli {

namespace {

constexpr std::size_t kMostXml = std::size_t{1} << 24;
constexpr std::size_t kMostChecksum = 4096;

struct Axis {
  char kind = 'A';       ///< I: equal increments, A: a stored value for each point
  char data_type = 'D';  ///< I, L, F, D: 16- and 32-bit whole, single and double precision
  double increment = 1;
  double offset = 0;
};

class X3pFile {
 public:
  explicit X3pFile(const std::filesystem::path& path) : path_(path), archive_(path) {
    if (!archive_.contains("main.xml")) fail_file(path_, "is not an X3P file: it holds no main.xml");
    const std::string xml = archive_.read("main.xml", kMostXml);
    const auto parsed = document_.load_buffer(xml.data(), xml.size());
    if (!parsed) {
      fail_file(path_, "main.xml, byte " + std::to_string(parsed.offset) + ": " + parsed.description());
    }
    root_ = document_.document_element();
    const std::string_view name = root_.name();
    if (name.substr(name.find(':') + 1) != "ISO5436_2") {
      fail_file(path_, "main.xml begins with <" + std::string(name) + ">, expected <ISO5436_2>");
    }
    verify("main.xml", xml, main_checksum());
  }

  RawMap read() const {
    const std::string feature = text("Record1/FeatureType");
    if (feature != "SUR") fail_file(path_, "FeatureType is '" + feature + "', expected SUR: a surface");
    RawMap map;
    map.unit = "m";
    map.dx = lateral_spacing("CX");
    map.dy = lateral_spacing("CY");
    const auto matrix = root_.child("Record3").child("MatrixDimension");
    if (!matrix) fail_file(path_, "main.xml has no MatrixDimension: a list of points is not a height map");
    map.nx = size("SizeX");
    map.ny = size("SizeY");
    if (size("SizeZ") != 1) fail_file(path_, "SizeZ is " + text("Record3/MatrixDimension/SizeZ") + ", expected 1");
    const std::size_t nodes = checked_nodes(path_, map.nx, map.ny);
    const Axis z = axis("CZ");
    if (z.kind != 'A') fail_file(path_, "the z axis is incremental, expected absolute heights");
    map.heights = root_.child("Record3").child("DataLink") ? read_binary(z, nodes) : read_list(nodes);
    for (double& height : map.heights) height = height * z.increment + z.offset;
    return map;
  }

 private:
  std::string text(const char* place) const {
    return std::string(trimmed(root_.first_element_by_path(place).child_value()));
  }

  std::int64_t size(const std::string& name) const {
    const std::string value = text(("Record3/MatrixDimension/" + name).c_str());
    std::int64_t parsed = 0;
    if (!parse_integer(value, parsed) || parsed < 1) {
      fail_file(path_, "main.xml: " + name + " is '" + value + "', expected a whole number of at least 1");
    }
    return parsed;
  }

  Axis axis(const std::string& name) const {
    const std::string place = "Record1/Axes/" + name + "/";
    const auto letter = [&](const std::string& key, const std::string& allowed) {
      const std::string value = text((place + key).c_str());
      if (value.size() != 1 || allowed.find(value[0]) == std::string::npos) {
        fail_file(path_, "main.xml: " + key + " of " + name + " is '" + value + "', expected one of " + allowed);
      }
      return value[0];
    };
    const auto number = [&](const std::string& key, double otherwise) {
      const std::string value = text((place + key).c_str());
      if (value.empty()) return otherwise;
      double parsed = 0;
      if (!parse_number(value, parsed) || !std::isfinite(parsed)) {
        fail_file(path_, "main.xml: " + key + " of " + name + " is '" + value + "', expected a number");
      }
      return parsed;
    };
    return {letter("AxisType", "IA"), letter("DataType", "ILFD"), number("Increment", 1), number("Offset", 0)};
  }

  double lateral_spacing(const std::string& name) const {
    const Axis lateral = axis(name);
    if (lateral.kind != 'I')
      fail_file(path_, "the axis " + name + " is not of equal increments, expected a regular grid");
    if (!(lateral.increment > 0)) {
      fail_file(path_, "Increment of " + name + " is " + number_text(lateral.increment) + " m, expected above 0");
    }
    return lateral.increment;
  }

  std::string main_checksum() const {
    std::string name = text("Record4/ChecksumFile");
    if (name.empty()) name = "md5checksum.hex";
    return archive_.read(name, kMostChecksum);
  }

  /// `stored` begins with 32 hexadecimal digits of either case.
  void verify(const std::string& name, const std::string& bytes, std::string_view stored) const {
    std::string expected(trimmed(stored).substr(0, 32));
    for (char& digit : expected) digit = static_cast<char>(std::tolower(static_cast<unsigned char>(digit)));
    const std::string found = md5_hex(bytes);
    if (found != expected) {
      fail_file(path_, name + " has the MD5 checksum " + found + ", the file says '" + expected + "': it is damaged");
    }
  }

  std::vector<double> read_binary(const Axis& z, std::size_t nodes) const {
    const bool is_short = z.data_type == 'I';
    const bool is_double = z.data_type == 'D';
    const std::size_t width = is_short ? 2 : is_double ? 8 : 4;
    const LoadNumber load = is_short             ? load_as_double<std::int16_t>
                            : is_double          ? load_as_double<double>
                            : z.data_type == 'F' ? load_as_double<float>
                                                 : load_as_double<std::int32_t>;
    const std::string bytes = linked("PointDataLink", "MD5ChecksumPointData", nodes * width);
    std::vector<double> heights(nodes);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      heights[k] = load(bytes.data() + k * width, std::endian::little);
    }
    if (text("Record3/DataLink/ValidPointsLink").empty()) return heights;
    const std::string valid = linked("ValidPointsLink", "MD5ChecksumValidPoints", (heights.size() + 7) / 8);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      if ((valid[k / 8] >> (k % 8) & 1) == 0) heights[k] = std::numeric_limits<double>::quiet_NaN();
    }
    return heights;
  }

  /// A verified member of exactly the expected size.
  std::string linked(const std::string& link, const std::string& checksum, std::size_t expected) const {
    const std::string name = text(("Record3/DataLink/" + link).c_str());
    if (name.empty()) fail_file(path_, "main.xml has no " + link);
    std::string bytes = archive_.read(name, expected);
    if (bytes.size() != expected) {
      fail_file(path_,
                name + " has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected));
    }
    verify(name, bytes, text(("Record3/DataLink/" + checksum).c_str()));
    return bytes;
  }

  /// Heights inside main.xml: one <Datum> a point, the height after its last semicolon; empty if missing.
  std::vector<double> read_list(std::size_t nodes) const {
    std::vector<double> heights;
    for (const auto datum : root_.child("Record3").child("DataList").children("Datum")) {
      std::string_view value = trimmed(datum.child_value());
      value = trimmed(value.substr(value.rfind(';') + 1));
      double height = std::numeric_limits<double>::quiet_NaN();
      if (!value.empty() && !parse_number(value, height)) {
        fail_file(path_, "main.xml: Datum " + std::to_string(heights.size()) + " is '" + std::string(value) +
                             "', expected a number");
      }
      heights.push_back(height);
    }
    if (heights.size() != nodes) {
      fail_file(path_,
                "main.xml holds " + std::to_string(heights.size()) + " points, expected " + std::to_string(nodes));
    }
    return heights;
  }

  const std::filesystem::path& path_;
  ZipArchive archive_;
  pugi::xml_document document_;
  pugi::xml_node root_;
};

}  // namespace

RawMap read_x3p(const std::filesystem::path& path) {
  return X3pFile(path).read();
}

}  // namespace brinell::cli
