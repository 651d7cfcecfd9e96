// X3P files are put together here, with one thing wrong in each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <cstdint>
#include <cstring>
#include <map>

#include "errors.h"
#include "formats/zip_archive.h"
#include "scratch_folder.h"
#include "surface_file.h"

namespace brinell::cli {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

template <class Number>
std::string stored(std::initializer_list<Number> values) {
  std::string bytes;
  for (const Number value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  return bytes;
}

struct X3p {
  std::string feature = "SUR", z_axis = "<AxisType>A</AxisType><DataType>D</DataType>", size_x = "3";
  std::string x_axis = "<AxisType>I</AxisType><DataType>L</DataType><Increment>1.5e-006</Increment>";
  std::string data = stored<double>({1, 2, 3, 4, 5, 6});
  std::string valid, data_checksum, main_checksum, list;

  std::filesystem::path write(const ScratchFolder& folder) const {
    std::string link = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>" +
                       (data_checksum.empty() ? md5_hex(data) : data_checksum) + "</MD5ChecksumPointData>";
    if (!valid.empty()) {
      link += "<ValidPointsLink>bindata/valid.bin</ValidPointsLink><MD5ChecksumValidPoints>" + md5_hex(valid) +
              "</MD5ChecksumValidPoints>";
    }
    link += "</DataLink>";
    const std::string xml =
        "<?xml version=\"1.0\"?><p:ISO5436_2 "
        "xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><FeatureType>" +
        feature + "</FeatureType><Axes><CX>" + x_axis +
        "</CX><CY><AxisType>I</AxisType><DataType>L</DataType><Increment>2e-6</Increment></CY><CZ>" + z_axis +
        "</CZ></Axes></Record1><Record3><MatrixDimension><SizeX>" + size_x +
        "</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>" + (list.empty() ? link : list) +
        "</Record3><Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>";
    std::map<std::string, std::string> members{
        {"main.xml", xml},
        {"bindata/data.bin", data},
        {"md5checksum.hex", (main_checksum.empty() ? md5_hex(xml) : main_checksum) + " *main.xml\n"}};
    if (!valid.empty()) members["bindata/valid.bin"] = valid;
    return write_zip(folder, members);
  }

  static std::filesystem::path write_zip(const ScratchFolder& folder,
                                         const std::map<std::string, std::string>& members) {
    auto path = folder.path() / "map.x3p";
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    for (const auto& [name, bytes] : members) {
      zip_file_add(archive, name.c_str(), zip_source_buffer(archive, bytes.data(), bytes.size(), 0), 0);
    }
    EXPECT_EQ(zip_close(archive), 0);
    return path;
  }
};

std::string refusal(const X3p& x3p) {
  const ScratchFolder folder;
  const auto path = x3p.write(folder);
  return message_of<FileError>([&] { read_surface(path); });
}

TEST(X3p, reads_every_type_of_heights) {
  const ScratchFolder folder;
  X3p x3p;
  const auto expect = [&](const std::string& z_axis, const std::string& data, double scale, double offset) {
    x3p.z_axis = "<AxisType>A</AxisType>" + z_axis;
    x3p.data = data;
    const HeightMap map = read_surface(x3p.write(folder));
    EXPECT_EQ(map.nx, 3);
    EXPECT_EQ(map.ny, 2);
    EXPECT_DOUBLE_EQ(map.dx, 1.5e-6);
    EXPECT_DOUBLE_EQ(map.dy, 2e-6);
    ASSERT_EQ(map.heights.size(), 6U);
    for (int k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(map.heights[k], (k + 1) * scale + offset);
  };
  expect("<DataType>D</DataType>", stored<double>({1, 2, 3, 4, 5, 6}), 1, 0);
  expect("<DataType>F</DataType>", stored<float>({1, 2, 3, 4, 5, 6}), 1, 0);
  expect("<DataType>L</DataType><Increment>1e-9</Increment><Offset>0.5</Offset>",
         stored<std::int32_t>({1, 2, 3, 4, 5, 6}), 1e-9, 0.5);
  expect("<DataType>I</DataType><Increment>0.25</Increment>", stored<std::int16_t>({1, 2, 3, 4, 5, 6}), 0.25, 0);
}

TEST(X3p, takes_points_as_missing_where_their_bit_is_zero) {
  const ScratchFolder folder;
  X3p x3p;
  x3p.valid = std::string(1, static_cast<char>(0b110111));
  const auto path = x3p.write(folder);
  EXPECT_THAT(message_of<FileError>([&] { read_surface(path); }),
              AllOf(HasSubstr("1 of 6"), HasSubstr("column 0, row 1")));
  EXPECT_NEAR(read_surface(path, {"", "", true}).heights[3], (1.0 + 5.0) / 2, 1e-15 * 8);
}

TEST(X3p, reads_heights_listed_in_its_xml) {
  const ScratchFolder folder;
  X3p x3p;
  x3p.list =
      "<DataList><Datum>1</Datum><Datum>;;2</Datum><Datum>3</Datum><Datum>4</Datum><Datum>5</Datum><Datum>6</Datum></"
      "DataList>";
  EXPECT_THAT(read_surface(x3p.write(folder)).heights, ElementsAre(1, 2, 3, 4, 5, 6));
  x3p.list = "<DataList><Datum>1</Datum></DataList>";
  EXPECT_THAT(refusal(x3p), AllOf(HasSubstr("1 points"), HasSubstr("expected 6")));
}

TEST(X3p, verifies_both_checksums) {
  X3p x3p;
  x3p.data_checksum = std::string(32, '0');
  EXPECT_THAT(refusal(x3p), AllOf(HasSubstr("bindata/data.bin"), HasSubstr("MD5"), HasSubstr("damaged")));
  x3p = {};
  x3p.main_checksum = std::string(32, '0');
  EXPECT_THAT(refusal(x3p), AllOf(HasSubstr("main.xml"), HasSubstr("MD5"), HasSubstr("damaged")));
}

TEST(X3p, refuses_what_is_no_surface) {
  X3p x3p;
  x3p.feature = "PRF";
  EXPECT_THAT(refusal(x3p), HasSubstr("'PRF'"));
  x3p = {};
  x3p.size_x = "4";
  EXPECT_THAT(refusal(x3p), AllOf(HasSubstr("48 bytes"), HasSubstr("64")));
  x3p.size_x = "none";
  EXPECT_THAT(refusal(x3p), AllOf(HasSubstr("SizeX"), HasSubstr("'none'")));
  x3p.size_x = "3000000000";
  EXPECT_THAT(refusal(x3p), HasSubstr("at most"));
  x3p = {};
  x3p.x_axis = "<AxisType>A</AxisType><DataType>D</DataType>";
  EXPECT_THAT(refusal(x3p), HasSubstr("CX"));
  x3p.x_axis = "<AxisType>I</AxisType><DataType>D</DataType><Increment>-1</Increment>";
  EXPECT_THAT(refusal(x3p), HasSubstr("-1"));
}

TEST(X3p, refuses_damaged_and_foreign_archives) {
  const ScratchFolder folder;
  const auto refused = [&](const std::filesystem::path& path) {
    return message_of<FileError>([&] { read_surface(path); });
  };
  EXPECT_THAT(refused(X3p::write_zip(folder, {{"a", "b"}})), HasSubstr("no main.xml"));
  EXPECT_THAT(refused(X3p::write_zip(folder, {{"main.xml", "<a><b></a>"}})), HasSubstr("main.xml"));
  EXPECT_THAT(refused(X3p::write_zip(folder, {{"main.xml", "<a/>"}})), HasSubstr("<a>"));
  EXPECT_THAT(refused(folder.write("text.x3p", "1 2 3\n")), HasSubstr("zip"));
  const std::string bytes = ScratchFolder::read(X3p{}.write(folder));
  EXPECT_THAT(refused(folder.write("cut.x3p", bytes.substr(0, bytes.size() - 30))), HasSubstr("zip"));
}

}  // namespace
}  // namespace brinell::cli
