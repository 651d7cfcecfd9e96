// A two-dimensional data set of an HDF5 file. brinell's own fields.h5 carries a text attribute `unit` on each data
// set and `spacing` = [dx, dy] in metres on the root; both are understood wherever they are found.
#include <array>

#include "formats/formats.h"
#include "hdf5_handle.h"

namespace brinell::cli {

namespace {

/// Text of a string attribute, of fixed or variable length; "" if there is none.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return {};
  if (H5Tis_variable_str(type.get()) > 0) {
    char* value = nullptr;
    if (H5Aread(attribute.get(), type.get(), &value) < 0 || value == nullptr) return {};
    std::string text = value;
    H5free_memory(value);
    return text;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

/// spacing = [dx, dy] of an object, left alone if there is none.
void read_spacing(hid_t object, RawMap& map) {
  if (H5Aexists(object, "spacing") <= 0) return;
  const Hdf5Handle attribute(H5Aopen(object, "spacing", H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute.get()), H5Sclose);
  std::array<double, 2> spacing{};
  if (H5Sget_simple_extent_npoints(space.get()) != 2) return;
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, spacing.data()) < 0) return;
  map.dx = spacing[0];
  map.dy = spacing[1];
}

/// Paths of all two-dimensional data sets, for a message.
std::string list_maps(hid_t file) {
  std::string names;
  H5Ovisit2(
      file, H5_INDEX_NAME, H5_ITER_NATIVE,
      [](hid_t root, const char* name, const auto* info, void* user) -> herr_t {
        if (info->type != H5O_TYPE_DATASET) return 0;
        const Hdf5Handle data(H5Dopen(root, name, H5P_DEFAULT), H5Dclose);
        const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose);
        auto& list = *static_cast<std::string*>(user);
        if (H5Sget_simple_extent_ndims(space.get()) == 2) list += (list.empty() ? "/" : ", /") + std::string(name);
        return 0;
      },
      &names, H5O_INFO_BASIC);
  return names.empty() ? "it holds no two-dimensional data set" : "it holds " + names;
}

}  // namespace

RawMap read_hdf5(const std::filesystem::path& path, const std::string& dataset) {
  start_hdf5();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) fail_file(path, "cannot be read as an HDF5 file: it is damaged or of another format");
  if (dataset.empty())
    fail_file(path, "needs the key dataset, or path = \"file.h5:/data/set\"; " + list_maps(file.get()));
  const Hdf5Handle data(H5Dopen(file.get(), dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data) fail_file(path, "has no data set '" + dataset + "'; " + list_maps(file.get()));
  const Hdf5Handle type(H5Dget_type(data.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) fail_file(path, dataset + " does not hold numbers");
  const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank != 2) {
    fail_file(path, dataset + " has " + std::to_string(rank) + " dimensions, expected 2: (ny, nx)");
  }
  std::array<hsize_t, 2> shape{};
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);

  RawMap map;
  map.ny = static_cast<std::int64_t>(shape[0]);
  map.nx = static_cast<std::int64_t>(shape[1]);
  map.heights.resize(checked_nodes(path, map.nx, map.ny));
  if (H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, map.heights.data()) < 0) {
    fail_file(path, dataset + " cannot be read: the file is damaged or needs a filter that is not installed");
  }
  map.unit = text_attribute(data.get(), "unit");
  read_spacing(file.get(), map);
  read_spacing(data.get(), map);
  return map;
}

}  // namespace brinell::cli
