#include "surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "errors.h"
#include "hdf5_handle.h"
#include "scratch_folder.h"

namespace brinell::cli {
namespace {

using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

/// Bytes of a number in the wanted order.
template <class Number>
std::string stored(Number value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian != (std::endian::native == std::endian::big)) bytes = std::string(bytes.rbegin(), bytes.rend());
  return bytes;
}

std::string refusal(const std::filesystem::path& path, const SurfaceOptions& options = {}) {
  return message_of<FileError>([&] { read_surface(path, options); });
}

/// Where not the file is at fault but what the scene says about it.
std::string contradiction(const std::filesystem::path& path, const SurfaceOptions& options) {
  return message_of<SceneError>([&] { read_surface(path, options); });
}

TEST(GwyddionText, states_its_size_and_unit_in_utf8_and_latin1) {
  const ScratchFolder folder;
  for (const std::string micro : {"\xC2\xB5", "\xB5", "u"}) {
    const auto path = folder.write("map.txt", "# Channel: Z\r\n# Width: 12.00 " + micro +
                                                  "m\r\n# Height: 10.00 nm\r\n"
                                                  "# Value units: nm\r\n1e-008\t+2\t3\r\n4\t5\t-6.5e+001\r\n");
    const HeightMap map = read_surface(path);
    EXPECT_EQ(map.nx, 3);
    EXPECT_EQ(map.ny, 2);
    EXPECT_DOUBLE_EQ(map.dx, 4e-6);
    EXPECT_DOUBLE_EQ(map.dy, 5e-9);
    EXPECT_THAT(map.heights, Pointwise(DoubleEq(), {1e-8 / 1e9, 2e-9, 3e-9, 4e-9, 5e-9, -65 / 1e9}));
  }
}

TEST(GwyddionText, accepts_its_own_unit_repeated_and_refuses_another) {
  const ScratchFolder folder;
  const auto path = folder.write("map.txt", "# Value units: nm\n1 2\n3 4\n");
  EXPECT_DOUBLE_EQ(read_surface(path, {"nm", "", false}).heights[3], 4e-9);
  EXPECT_THAT(contradiction(path, {"um", "", false}),
              AllOf(HasSubstr("map.txt"), HasSubstr("'um'"), HasSubstr("'nm'")));
  EXPECT_THAT(refusal(folder.write("volts.txt", "# Value units: V\n1\n")), HasSubstr("'V'"));
  EXPECT_THAT(refusal(folder.write("size.txt", "# Width: wide\n1\n")), HasSubstr("line 1"));
}

TEST(TextMatrix, reads_blanks_commas_and_semicolons_in_the_units_of_the_scene) {
  const ScratchFolder folder;
  for (const std::string text : {"1 2\t 3\n4 5 6\n", "1,2,3\n4, 5, 6\n",
                                 "\xEF\xBB\xBF"
                                 "1;2;3;\n\n4;5;6\n",
                                 "# note\n1 2 3 \n4 5 6"}) {
    const HeightMap map = read_surface(folder.write("map.csv", text), {"um", "", false});
    EXPECT_EQ(map.nx, 3) << text;
    EXPECT_EQ(map.ny, 2) << text;
    EXPECT_TRUE(std::isnan(map.dx));
    EXPECT_THAT(map.heights, Pointwise(DoubleEq(), {1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6})) << text;
  }
  EXPECT_EQ(read_surface(folder.write("map", "7\n")).heights[0], 7.0);
}

TEST(TextMatrix, names_the_line_of_what_it_cannot_read) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal(folder.write("a.txt", "1 2\n3 x7\n")), AllOf(HasSubstr("line 2"), HasSubstr("'x7'")));
  EXPECT_THAT(refusal(folder.write("b.txt", "1 2\n3\n")), AllOf(HasSubstr("line 2"), HasSubstr("1 numbers")));
  EXPECT_THAT(refusal(folder.write("c.txt", "1,5\t2,5\n")), HasSubstr("decimal point"));
  EXPECT_THAT(refusal(folder.write("d.txt", "1;;2\n")), HasSubstr("line 1"));
  EXPECT_THAT(refusal(folder.write("e.txt", "# only\n")), HasSubstr("no numbers"));
  EXPECT_THAT(refusal(folder.write("f.txt", "")), HasSubstr("empty"));
  EXPECT_THAT(refusal(folder.write("g.txt", std::string("1\0", 2))), HasSubstr("not a text"));
  EXPECT_THAT(refusal(folder.path() / "none.txt"), AllOf(HasSubstr("none.txt"), HasSubstr("no such file")));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("folder"));
}

TEST(SurfaceFile, refuses_missing_heights_with_count_and_place) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal(folder.write("a.txt", "1 2 3\n4 nan 6\ninf 7 8\n")),
              AllOf(HasSubstr("2 of 9"), HasSubstr("nan"), HasSubstr("column 1, row 1")));
}

TEST(SurfaceFile, fills_missing_heights_harmonically) {
  const ScratchFolder folder;
  // x + 2y is harmonic, also in the discrete sense, so that a hole in it is restored.
  const HeightMap map =
      read_surface(folder.write("a.txt", "0 1 2 3 4\n2 nan nan 5 6\n4 nan nan 7 8\n6 7 8 9 10\n"), {"", "", true});
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(map.heights[j * 5 + i], i + 2 * j, 1e-13);
  }
  EXPECT_THAT(refusal(folder.write("b.txt", "nan nan\n"), {"", "", true}), HasSubstr("none of its 2"));
  EXPECT_THAT(refusal(folder.write("c.txt", "1 inf\n"), {"", "", true}), HasSubstr("1 of 2"));
}

std::string gsf(const std::string& header, int points, std::size_t cut = 0) {
  std::string bytes = "Gwyddion Simple Field 1.0\n" + header;
  bytes.append(4 - bytes.size() % 4, '\0');
  for (int k = 0; k < points; ++k) bytes += stored(static_cast<float>(k) - 0.5F);
  return bytes.substr(0, bytes.size() - cut);
}

TEST(Gsf, reads_all_paddings_of_its_header) {
  const ScratchFolder folder;
  for (const std::string title : {"", "a", "ab", "abc", "abcd"}) {
    const auto path = folder.write(
        "map.gsf",
        gsf("XRes = 3\nYRes = 2\nXReal = 6e-6\nYReal=8e-6\nXYUnits = m\nZUnits = m\nTitle = " + title + "\n", 6));
    const HeightMap map = read_surface(path);
    EXPECT_EQ(map.nx, 3);
    EXPECT_EQ(map.ny, 2);
    EXPECT_DOUBLE_EQ(map.dx, 2e-6);
    EXPECT_DOUBLE_EQ(map.dy, 4e-6);
    EXPECT_THAT(map.heights, ElementsAre(-0.5, 0.5, 1.5, 2.5, 3.5, 4.5));
  }
}

TEST(Gsf, refuses_what_is_not_whole) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal(folder.write("a.gsf", gsf("XRes = 3\nYRes = 2\n", 6, 1))),
              AllOf(HasSubstr("bytes"), HasSubstr("3 x 2")));
  EXPECT_THAT(refusal(folder.write("b.gsf", gsf("XRes = 3\nYRes = 2\n", 7))), HasSubstr("expected"));
  EXPECT_THAT(refusal(folder.write("c.gsf", gsf("XRes = 3\n", 6))), HasSubstr("YRes"));
  EXPECT_THAT(refusal(folder.write("d.gsf", gsf("XRes = -3\nYRes = 2\n", 6))), HasSubstr("XRes = -3"));
  EXPECT_THAT(refusal(folder.write("e.gsf", gsf("XRes = 3000000000\nYRes = 3000000000\n", 6))), HasSubstr("at most"));
  EXPECT_THAT(refusal(folder.write("f.gsf", "1 2 3\n")), HasSubstr("not a Gwyddion Simple Field"));
  EXPECT_THAT(refusal(folder.write("g.gsf", "Gwyddion Simple Field 1.0\nXRes = 3\n")), HasSubstr("header"));
}

std::string npy(const std::string& descr, bool fortran, const std::string& shape, const std::string& data,
                int version = 1) {
  std::string header =
      "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }\n";
  const auto length = static_cast<std::uint32_t>(header.size());
  return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' +
         (version == 1 ? stored(static_cast<std::uint16_t>(length)) : stored(length)) + header + data;
}

template <class Number>
void expect_npy_round_trip(const std::string& type) {
  const ScratchFolder folder;
  for (const bool big : {false, true}) {
    for (const bool fortran : {false, true}) {
      std::string data;
      for (int k = 0; k < 6; ++k) {
        // Element (j, i) is 10 j + i; columns first in Fortran order.
        const int j = fortran ? k % 2 : k / 3;
        const int i = fortran ? k / 2 : k % 3;
        const int value = 10 * j + i;
        data += stored(static_cast<Number>(value), big);
      }
      const auto path = folder.write("map.npy", npy((big ? ">" : "<") + type, fortran, "(2, 3)", data, big ? 2 : 1));
      const HeightMap map = read_surface(path);
      EXPECT_EQ(map.nx, 3);
      EXPECT_EQ(map.ny, 2);
      EXPECT_THAT(map.heights, ElementsAre(0, 1, 2, 10, 11, 12)) << type << big << fortran;
    }
  }
}

TEST(Npy, reads_every_type_order_and_byte_order) {
  expect_npy_round_trip<float>("f4");
  expect_npy_round_trip<double>("f8");
  expect_npy_round_trip<std::int16_t>("i2");
  expect_npy_round_trip<std::int32_t>("i4");
  expect_npy_round_trip<std::int64_t>("i8");
  expect_npy_round_trip<std::uint16_t>("u2");
}

TEST(Npy, refuses_what_is_no_plain_map) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal(folder.write("a.npy", npy("<f8", false, "(2, 3)", std::string(47, '\0')))), HasSubstr("3 x 2"));
  EXPECT_THAT(refusal(folder.write("b.npy", npy("<c16", false, "(1, 1)", std::string(16, '\0')))), HasSubstr("c16"));
  EXPECT_THAT(refusal(folder.write("c.npy", npy("<f8", false, "(6,)", std::string(48, '\0')))),
              HasSubstr("1 dimensions"));
  EXPECT_THAT(refusal(folder.write("d.npy", npy("<f8", false, "(0, 3)", ""))), HasSubstr("at least 1 x 1"));
  EXPECT_THAT(refusal(folder.write("e.npy", "\x93NUMPY\x01")), HasSubstr("header"));
  EXPECT_THAT(refusal(folder.write("f.npy", npy("<f8", false, "(1, 1)", "").substr(0, 30))), HasSubstr("header"));
  EXPECT_THAT(refusal(folder.write("g.npy", "PK")), HasSubstr("not an NPY file"));
}

std::filesystem::path hdf5_map(const ScratchFolder& folder, const char* unit) {
  start_hdf5();
  auto path = folder.path() / "map.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t shape[] = {2, 3};
  const hsize_t two = 2;
  const hid_t space = H5Screate_simple(2, shape, nullptr);
  const hid_t group = H5Gcreate(file, "scan", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t data = H5Dcreate(group, "height", H5T_IEEE_F32BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const double values[] = {1, 2, 3, 4, 5, 6};
  const double spacing[] = {2e-6, 3e-6};
  H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  const hid_t pair = H5Screate_simple(1, &two, nullptr);
  const hid_t attribute = H5Acreate(file, "spacing", H5T_NATIVE_DOUBLE, pair, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, spacing);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, H5T_VARIABLE);
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t unit_attribute = H5Acreate(data, "unit", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(unit_attribute, text, &unit);
  for (const hid_t id : {attribute, unit_attribute}) H5Aclose(id);
  for (const hid_t id : {space, pair, scalar}) H5Sclose(id);
  H5Tclose(text);
  H5Dclose(data);
  H5Gclose(group);
  H5Fclose(file);
  return path;
}

TEST(Hdf5, reads_a_data_set_with_unit_and_spacing) {
  const ScratchFolder folder;
  const auto path = hdf5_map(folder, "um");
  for (const HeightMap& map :
       {read_surface(path.string() + ":/scan/height"), read_surface(path, {"", "scan/height", false})}) {
    EXPECT_EQ(map.nx, 3);
    EXPECT_EQ(map.ny, 2);
    EXPECT_EQ(map.dx, 2e-6);
    EXPECT_EQ(map.dy, 3e-6);
    EXPECT_THAT(map.heights, Pointwise(DoubleEq(), {1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6}));
  }
}

TEST(Hdf5, names_the_data_sets_that_a_file_has) {
  const ScratchFolder folder;
  const auto path = hdf5_map(folder, "m");
  EXPECT_THAT(refusal(path), AllOf(HasSubstr("dataset"), HasSubstr("/scan/height")));
  EXPECT_THAT(refusal(path, {"", "scan/depth", false}), AllOf(HasSubstr("scan/depth"), HasSubstr("/scan/height")));
  EXPECT_THAT(refusal(path, {"", "scan", false}), HasSubstr("/scan/height"));
  const std::string bytes = ScratchFolder::read(path);
  EXPECT_THAT(refusal(folder.write("cut.h5", bytes.substr(0, bytes.size() / 2)), {"", "scan/height", false}),
              HasSubstr("damaged"));
  EXPECT_THAT(refusal(folder.write("text.h5", "1 2 3\n"), {"", "a", false}), HasSubstr("another format"));
  EXPECT_THAT(contradiction(folder.write("a.txt", "1\n"), {"", "a", false}), HasSubstr("not an HDF5"));
}

}  // namespace
}  // namespace brinell::cli
