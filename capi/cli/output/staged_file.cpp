#include "output/staged_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "errors.h"

namespace brinell::cli {

namespace {

[[noreturn]] void fail_system(const std::filesystem::path& path, const std::string& what, int error) {
  throw FileError(path.string() + ": " + what + ": " + std::generic_category().message(error));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

StagedFile::StagedFile(std::filesystem::path final_path) : final_(std::move(final_path)), staged_(final_) {
  staged_ += ".part" + std::to_string(::getpid());
}

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!published_) std::filesystem::remove(staged_, ignored);
}

void StagedFile::publish() {
  {
    const Descriptor file(staged_, O_RDONLY);
    if (file.number() < 0 || ::fsync(file.number()) != 0) fail_system(final_, "cannot be written", errno);
  }
  if (::rename(staged_.c_str(), final_.c_str()) != 0) fail_system(final_, "cannot be written", errno);
  published_ = true;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  StagedFile staged(path);
  {
    const Descriptor file(staged.path(), O_WRONLY | O_CREAT | O_TRUNC);
    if (file.number() < 0) fail_system(path, "cannot be created", errno);
    while (!bytes.empty()) {
      const auto written = ::write(file.number(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_system(path, "cannot be written", errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  staged.publish();
}

void make_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    fail_system(folder, "cannot be created as a folder", error ? error.value() : ENOTDIR);
  }
  const StagedFile probe(folder / "probe");
  const Descriptor file(probe.path(), O_WRONLY | O_CREAT | O_TRUNC);
  if (file.number() < 0) fail_system(folder, "files cannot be created in this folder", errno);
}

}  // namespace brinell::cli
