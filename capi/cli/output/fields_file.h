// fields.h5 and the XDMF beside it: the fields of the stored increments.
//
// Group /step_S/increment_I per stored increment; data sets (ny, nx) on the surface, (layers, ny, nx) below it,
// (layers, ny, nx, 6) for tensors (xx yy zz yz xz xy), (layers, ny, nx, 9) for three unit vectors (of the largest
// principal stress first). Each data set has the attribute `unit`; the root has `spacing`
// [dx, dy] and `depths` of the layers [m]. The XDMF names the HDF5 file relative to itself, places node (i, j) at
// ((i − (nx−1)/2)·dx, (j − (ny−1)/2)·dy), and counts stored increments as time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hdf5_handle.h"
#include "output/staged_file.h"

namespace brinell::cli {

struct FieldsGrid {
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  double dx = 0;               ///< [m]
  double dy = 0;               ///< [m]
  std::vector<double> depths;  ///< of the layers [m], increasing; empty if nothing below the surface is stored
};

enum class FieldKind { surface, scalar, tensor, directions };

struct StoredField {
  std::string name;
  FieldKind kind = FieldKind::surface;
};

struct StoredIncrement {
  int step = 0;
  int increment = 0;
  std::vector<StoredField> fields;
};

class FieldsFile {
 public:
  /// Begins `folder`/fields.h5 anew, or, if `keep_existing`, after what is already there. Throws FileError, as all
  /// members.
  FieldsFile(const std::filesystem::path& folder, FieldsGrid grid, bool keep_existing = false);

  void begin_increment(int step, int increment);

  /// Adds a field to the increment begun last; `values` in the data set's own order.
  void add(const StoredField& field, const std::string& unit, std::span<const double> values);

  /// Completes fields.h5 and fields.xdmf; without this neither appears.
  void publish();

 private:
  void recover_increments();
  [[noreturn]] void fail_write() const;

  StagedFile staged_;
  FieldsGrid grid_;
  Hdf5Handle file_;
  Hdf5Handle group_;
  std::vector<StoredIncrement> increments_;
};

/// The XDMF text that describes `increments` in `hdf5_name`.
std::string xdmf_text(const std::string& hdf5_name, const FieldsGrid& grid,
                      std::span<const StoredIncrement> increments);

}  // namespace brinell::cli
