// Files inside a zip archive, by libzip, and their MD5 checksums.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

struct zip;

namespace brinell::cli {

class ZipArchive {
 public:
  /// Throws FileError if `path` is no readable zip archive.
  explicit ZipArchive(const std::filesystem::path& path);

  bool contains(const std::string& name) const;

  /// Whole content of a member of at most `most_bytes`. Throws FileError if it is absent, larger or damaged.
  std::string read(const std::string& name, std::size_t most_bytes) const;

 private:
  std::filesystem::path path_;
  std::unique_ptr<zip, void (*)(zip*)> zip_;
};

/// MD5 checksum as 32 lower-case hexadecimal digits.
std::string md5_hex(const std::string& bytes);

}  // namespace brinell::cli
