#include "surface_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "errors.h"
#include "fill_missing.h"
#include "formats/formats.h"

namespace brinell::cli {

namespace {

/// The scene says something about the file that does not fit it.
[[noreturn]] void fail_scene(const std::filesystem::path& path, const std::string& text) {
  throw SceneError(path.string() + ": " + text);
}

/// "map.h5:/group/heights" into the file and the data set.
std::pair<std::filesystem::path, std::string> split_dataset(const std::filesystem::path& path, std::string dataset) {
  const std::string text = path.string();
  const auto colon = text.find(":/");
  if (colon == std::string::npos || std::filesystem::exists(path)) return {path, std::move(dataset)};
  if (!dataset.empty() && dataset != text.substr(colon + 1)) {
    fail_scene(text.substr(0, colon), "the path names the data set '" + text.substr(colon + 1) +
                                          "', the key dataset another one, '" + dataset + "'");
  }
  return {text.substr(0, colon), text.substr(colon + 1)};
}

enum class Format { text, gsf, npy, x3p, hdf5 };

Format format_of(const std::filesystem::path& path, std::string_view bytes) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".gsf") return Format::gsf;
  if (extension == ".npy") return Format::npy;
  if (extension == ".x3p") return Format::x3p;
  if (extension == ".h5" || extension == ".hdf5") return Format::hdf5;
  if (bytes.starts_with("Gwyddion Simple Field")) return Format::gsf;
  if (bytes.starts_with("\x93NUMPY")) return Format::npy;
  if (bytes.starts_with("PK\x03\x04")) return Format::x3p;
  if (bytes.starts_with("\x89HDF")) return Format::hdf5;
  return Format::text;
}

RawMap read_raw(const std::filesystem::path& path, const std::string& dataset) {
  const std::string bytes = read_bytes(path);
  if (bytes.empty()) fail_file(path, "is empty");
  const Format format = format_of(path, bytes);
  if (!dataset.empty() && format != Format::hdf5) {
    fail_scene(path, "is not an HDF5 file, so that dataset = '" + dataset + "' has no meaning");
  }
  switch (format) {
    case Format::gsf: return read_gsf(path, bytes);
    case Format::npy: return read_npy(path, bytes);
    case Format::x3p: return read_x3p(path);
    case Format::hdf5: return read_hdf5(path, dataset);
    case Format::text: return read_text_matrix(path, bytes);
  }
  return {};
}

/// Metres in one number of the file. What the file says holds; the scene may repeat it, but not contradict it.
double scale_of(const std::filesystem::path& path, const std::string& stated, const std::string& wanted) {
  constexpr const char* kLengths = "a unit of length: m, mm, um, nm or pm";
  const double scene_scale = metres_per(wanted.empty() ? "m" : wanted);
  if (std::isnan(scene_scale)) fail_scene(path, "units = '" + wanted + "', expected " + kLengths);
  if (stated.empty()) return scene_scale;
  const double file_scale = metres_per(stated);
  if (std::isnan(file_scale)) fail_file(path, "its values are in '" + stated + "', expected " + kLengths);
  if (!wanted.empty() && file_scale != scene_scale) {
    fail_scene(
        path, "units = '" + wanted + "', but the file says that its values are in '" + stated + "'; leave units out");
  }
  return file_scale;
}

void refuse_missing(const std::filesystem::path& path, const RawMap& map) {
  const auto bad = [](double height) { return !std::isfinite(height); };
  const auto first = std::find_if(map.heights.begin(), map.heights.end(), bad);
  if (first == map.heights.end()) return;
  const auto index = first - map.heights.begin();
  fail_file(path, std::to_string(std::count_if(first, map.heights.end(), bad)) + " of " +
                      std::to_string(map.heights.size()) + " heights are missing or not finite, the first, " +
                      number_text(*first) + ", at column " + std::to_string(index % map.nx) + ", row " +
                      std::to_string(index / map.nx) +
                      " (from 0); fill_missing = true replaces missing ones by their surroundings");
}

}  // namespace

HeightMap read_surface(const std::filesystem::path& path, const SurfaceOptions& options) {
  const auto [file, dataset] = split_dataset(path, options.dataset);
  RawMap raw = read_raw(file, dataset);
  const double scale = scale_of(file, raw.unit, options.units);
  if (options.fill_missing && !fill_missing(raw.nx, raw.ny, raw.heights)) {
    fail_file(file, "none of its " + std::to_string(raw.heights.size()) + " heights is valid");
  }
  refuse_missing(file, raw);
  for (double& height : raw.heights) height = in_metres(height, scale);
  return {raw.nx, raw.ny, raw.dx, raw.dy, std::move(raw.heights)};
}

}  // namespace brinell::cli
