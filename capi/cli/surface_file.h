// Reads a height map from any of the supported formats.
//
// Every format is brought to the same form: metres, row-major, x inner, and the first row of the file is j = 0, the
// smallest y. Image formats (Gwyddion text, GSF) store the top row first with their y axis pointing down the image;
// with z into the body that is a right-handed system, so their y is taken as it stands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace brinell::cli {

struct HeightMap {
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  double dx = 0;                ///< [m]; NaN if the file does not say
  double dy = 0;                ///< [m]; NaN if the file does not say
  std::vector<double> heights;  ///< [m], ny × nx, all finite
};

struct SurfaceOptions {
  std::string units;          ///< of a number in a file that does not say: m, mm, um, nm, ...; "" means m
  std::string dataset;        ///< path inside an HDF5 file
  bool fill_missing = false;  ///< replace missing points instead of refusing them
};

/// The format follows from the extension (.gsf, .npy, .x3p, .h5, .hdf5), else from the first bytes, else it is text:
/// Gwyddion's export if it carries that header, a plain matrix if not. "map.h5:/group/heights" names a data set.
/// Throws FileError, or SceneError if the options do not fit the file.
HeightMap read_surface(const std::filesystem::path& path, const SurfaceOptions& options = {});

}  // namespace brinell::cli
