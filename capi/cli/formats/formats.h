// The height-map formats, one function each. They read what a file says and leave units and missing points to
// read_surface. All throw FileError with the file's path.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace brinell::cli {

/// Heights as the file stores them; the first row of the file comes first.
struct RawMap {
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  double dx;                    ///< [m]; NaN if the file does not say
  double dy;                    ///< [m]; NaN if the file does not say
  std::string unit;             ///< of the heights; "" if the file does not say
  std::vector<double> heights;  ///< in `unit`, ny × nx; NaN where the file has no value

  RawMap();
};

/// Text of rows of numbers, separated by blanks, tabs, commas or semicolons; lines of # are comments, of which
/// those of Gwyddion's text export (Width, Height, Value units) are understood.
RawMap read_text_matrix(const std::filesystem::path& path, const std::string& bytes);

/// Gwyddion Simple Field 1.0.
RawMap read_gsf(const std::filesystem::path& path, const std::string& bytes);

/// A two-dimensional array of numpy.save, shape (ny, nx).
RawMap read_npy(const std::filesystem::path& path, const std::string& bytes);

/// ISO 25178-72, with both checksums verified.
RawMap read_x3p(const std::filesystem::path& path);

/// A two-dimensional data set, shape (ny, nx); its unit and spacing from the attributes that brinell itself writes.
RawMap read_hdf5(const std::filesystem::path& path, const std::string& dataset);

/// Metres in a unit of length ("m", "mm", "um" and both spellings with a Greek mu, "nm", "pm", "cm", "km", "Å");
/// NaN if it is not one.
double metres_per(std::string_view unit);

/// A value in units of `scale` metres. Divides where the scale is below one, since 1e6 is a binary number and 1e-6 is
/// not: 10 um become 1e-5 m to the last bit.
double in_metres(double value, double scale);

/// nx · ny after a check against the sizes that a height map can have.
std::size_t checked_nodes(const std::filesystem::path& path, std::int64_t nx, std::int64_t ny);

/// "surface.gsf: " and the text.
[[noreturn]] void fail_file(const std::filesystem::path& path, const std::string& text);

/// Whole content of a file.
std::string read_bytes(const std::filesystem::path& path);

std::string_view trimmed(std::string_view text);

/// A number that fills the whole text, as C writes it, with an optional sign; false otherwise.
bool parse_number(std::string_view text, double& value);
bool parse_integer(std::string_view text, std::int64_t& value);

/// Shortest text that reads back as the same number.
std::string number_text(double value);

}  // namespace brinell::cli
