#include "formats/zip_archive.h"

#include <openssl/evp.h>
#include <zip.h>

#include <array>

#include "formats/formats.h"

namespace brinell::cli {

ZipArchive::ZipArchive(const std::filesystem::path& path)
    : path_(path), zip_(nullptr, [](zip* z) { zip_discard(z); }) {
  int code = 0;
  zip_.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (zip_) return;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  fail_file(path, "cannot be read as a zip archive: " + text);
}

bool ZipArchive::contains(const std::string& name) const {
  return zip_name_locate(zip_.get(), name.c_str(), 0) >= 0;
}

std::string ZipArchive::read(const std::string& name, std::size_t most_bytes) const {
  zip_stat_t entry;
  if (zip_stat(zip_.get(), name.c_str(), 0, &entry) != 0) fail_file(path_, "holds no " + name);
  if (entry.size > most_bytes) {
    fail_file(path_,
              name + " has " + std::to_string(entry.size) + " bytes, expected at most " + std::to_string(most_bytes));
  }
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen(zip_.get(), name.c_str(), 0), zip_fclose);
  if (!file) fail_file(path_, name + ": " + zip_strerror(zip_.get()));
  std::string bytes(entry.size, '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto count = zip_fread(file.get(), bytes.data() + done, bytes.size() - done);
    if (count <= 0) fail_file(path_, name + " is damaged: " + zip_file_strerror(file.get()));
    done += static_cast<std::size_t>(count);
  }
  char past_end = 0;  // libzip compares the member's own checksum when its end is reached
  if (zip_fread(file.get(), &past_end, 1) != 0)
    fail_file(path_, name + " is damaged: " + zip_file_strerror(file.get()));
  return bytes;
}

std::string md5_hex(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_md5(), nullptr) != 1) {
    throw std::runtime_error("the cryptography library of this machine refuses MD5 checksums");
  }
  std::string text;
  for (unsigned int k = 0; k < size; ++k) {
    text += "0123456789abcdef"[digest[k] / 16];
    text += "0123456789abcdef"[digest[k] % 16];
  }
  return text;
}

}  // namespace brinell::cli
