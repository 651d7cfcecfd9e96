// A file that appears complete or not at all: written beside its final place and renamed when it is whole.
#pragma once

#include <filesystem>
#include <string_view>

namespace brinell::cli {

class StagedFile {
 public:
  /// Nothing is created yet.
  explicit StagedFile(std::filesystem::path final_path);
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Removes what was written unless it was published.
  ~StagedFile();

  /// Where to write: in the same folder, so that the rename cannot cross file systems.
  const std::filesystem::path& path() const { return staged_; }
  const std::filesystem::path& final_path() const { return final_; }

  /// Forces the bytes to disk and gives the file its name. Throws FileError.
  void publish();

 private:
  std::filesystem::path final_;
  std::filesystem::path staged_;
  bool published_ = false;
};

/// Writes a whole file, complete or not at all. Throws FileError that names the path and the system's reason.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates a folder with its parents where it does not exist, and makes sure that files can be created in it.
/// Throws FileError.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace brinell::cli
