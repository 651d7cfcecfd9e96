#include "output/fields_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "errors.h"
#include "formats/formats.h"

namespace brinell::cli {

namespace {

constexpr unsigned kDeflateLevel = 4;
constexpr hsize_t kChunkElements = hsize_t{1} << 17;  // 1 MiB: HDF5's default chunk cache

std::vector<hsize_t> shape_of(const FieldsGrid& grid, FieldKind kind) {
  std::vector<hsize_t> shape{static_cast<hsize_t>(grid.ny), static_cast<hsize_t>(grid.nx)};
  if (kind != FieldKind::surface) shape.insert(shape.begin(), grid.depths.size());
  if (kind == FieldKind::tensor) shape.push_back(6);
  if (kind == FieldKind::directions) shape.push_back(9);
  return shape;
}

/// Whole trailing dimensions as far as they fit into one chunk, then a part of the next, then single ones.
std::vector<hsize_t> chunk_of(const std::vector<hsize_t>& shape) {
  std::vector<hsize_t> chunk(shape.size());
  hsize_t room = kChunkElements;
  for (std::size_t k = shape.size(); k-- > 0;) {
    chunk[k] = std::clamp<hsize_t>(room, 1, shape[k]);
    room /= chunk[k];
  }
  return chunk;
}

bool write_text_attribute(hid_t object, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.get(), std::max<std::size_t>(text.size(), 1));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  const Hdf5Handle attribute(H5Acreate(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute.get(), type.get(), text.empty() ? "\0" : text.data()) >= 0;
}

bool write_number_attribute(hid_t object, const char* name, std::span<const double> values) {
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle attribute(H5Acreate(object, name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  return attribute && (values.empty() || H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, values.data()) >= 0);
}

Hdf5Handle open_file(const StagedFile& staged, bool keep_existing) {
  start_hdf5();
  errno = 0;
  if (!keep_existing || !std::filesystem::exists(staged.final_path())) {
    return {H5Fcreate(staged.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
  }
  std::error_code error;
  std::filesystem::copy_file(staged.final_path(), staged.path(), std::filesystem::copy_options::overwrite_existing,
                             error);
  if (error) throw FileError(staged.path().string() + ": cannot be written: " + error.message());
  return {H5Fopen(staged.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
}

/// Names of a group's members, in the order of their creation or of the names.
std::vector<std::string> members(hid_t group, H5_index_t order) {
  std::vector<std::string> names;
  H5Literate(
      group, order, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* user) -> herr_t {
        static_cast<std::vector<std::string>*>(user)->emplace_back(name);
        return 0;
      },
      &names);
  return names;
}

/// 7 from "step_7" and "step_".
int number_after(const std::string& name, const std::string& prefix) {
  std::int64_t number = 0;
  const bool valid = name.starts_with(prefix) && parse_integer(std::string_view(name).substr(prefix.size()), number);
  return valid ? static_cast<int>(number) : -1;
}

}  // namespace

FieldsFile::FieldsFile(const std::filesystem::path& folder, FieldsGrid grid, bool keep_existing)
    : staged_(folder / "fields.h5"),
      grid_(std::move(grid)),
      file_(open_file(staged_, keep_existing)),
      group_(-1, H5Gclose) {
  if (!file_) fail_write();
  if (H5Aexists(file_.get(), "spacing") > 0) {
    recover_increments();
    return;
  }
  const std::array<double, 2> spacing{grid_.dx, grid_.dy};
  if (!write_number_attribute(file_.get(), "spacing", spacing) ||
      !write_number_attribute(file_.get(), "depths", grid_.depths)) {
    fail_write();
  }
}

void FieldsFile::recover_increments() {
  for (const auto& step_name : members(file_.get(), H5_INDEX_NAME)) {
    const Hdf5Handle step(H5Gopen(file_.get(), step_name.c_str(), H5P_DEFAULT), H5Gclose);
    for (const auto& name : members(step.get(), H5_INDEX_NAME)) {
      StoredIncrement increment{number_after(step_name, "step_"), number_after(name, "increment_"), {}};
      const Hdf5Handle group(H5Gopen(step.get(), name.c_str(), H5P_DEFAULT), H5Gclose);
      for (const auto& field : members(group.get(), H5_INDEX_CRT_ORDER)) {
        const Hdf5Handle data(H5Dopen(group.get(), field.c_str(), H5P_DEFAULT), H5Dclose);
        const Hdf5Handle space(H5Dget_space(data.get()), H5Sclose);
        std::array<hsize_t, 4> shape{};
        const int rank = H5Sget_simple_extent_ndims(space.get());
        if (rank == 4) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
        increment.fields.push_back({field, shape[3] == 9 ? FieldKind::directions
                                           : rank == 4   ? FieldKind::tensor
                                           : rank == 3   ? FieldKind::scalar
                                                         : FieldKind::surface});
      }
      increments_.push_back(std::move(increment));
    }
  }
  std::sort(increments_.begin(), increments_.end(), [](const auto& a, const auto& b) {
    return std::pair(a.step, a.increment) < std::pair(b.step, b.increment);
  });
}

void FieldsFile::begin_increment(int step, int increment) {
  const std::string name = "step_" + std::to_string(step) + "/increment_" + std::to_string(increment);
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.get(), 1);
  const Hdf5Handle order(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(order.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  group_ = Hdf5Handle(H5Gcreate(file_.get(), name.c_str(), links.get(), order.get(), H5P_DEFAULT), H5Gclose);
  if (!group_) fail_write();
  increments_.push_back({step, increment, {}});
}

void FieldsFile::add(const StoredField& field, const std::string& unit, std::span<const double> values) {
  const auto shape = shape_of(grid_, field.kind);
  const auto chunk = chunk_of(shape);
  hsize_t size = 1;
  for (const hsize_t extent : shape) size *= extent;
  if (size != values.size()) {
    throw std::logic_error("field " + field.name + " holds " + std::to_string(values.size()) + " numbers, expected " +
                           std::to_string(size));
  }
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  errno = 0;
  H5Pset_chunk(layout.get(), static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(layout.get());
  H5Pset_deflate(layout.get(), kDeflateLevel);
  H5Pset_obj_track_times(layout.get(), 0);  // the same results give the same bytes
  Hdf5Handle data(H5Dcreate(group_.get(), field.name.c_str(), H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, layout.get(),
                            H5P_DEFAULT),
                  H5Dclose);
  if (!data || !write_text_attribute(data.get(), "unit", unit) ||
      H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0 || !data.close()) {
    fail_write();
  }
  increments_.back().fields.push_back(field);
}

void FieldsFile::publish() {
  group_ = Hdf5Handle(-1, H5Gclose);
  errno = 0;
  if (H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) < 0 || !file_.close()) fail_write();
  staged_.publish();
  std::filesystem::path xdmf = staged_.final_path();
  write_file(xdmf.replace_extension(".xdmf"),
             xdmf_text(staged_.final_path().filename().string(), grid_, increments_));
}

void FieldsFile::fail_write() const {
  const int error = errno;
  throw FileError(staged_.final_path().string() + ": cannot be written" +
                  (error != 0 ? std::string(": ") + std::strerror(error) : ""));
}

}  // namespace brinell::cli
