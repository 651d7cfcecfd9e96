#include "bench/instructions.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include "errors.h"

extern char** environ;

namespace brinell::cli {

namespace {

/// A folder of its own in the system's place for temporary files.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "brinell_bench_XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) throw FileError("no temporary folder can be made at " + path);
    path_ = path;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

constexpr int kNotFound = 127;

int run(std::vector<std::string> words, const std::filesystem::path& output, const std::filesystem::path& errors) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kMode = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), kMode, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), kMode, 0600);
  pid_t process = 0;
  const int failed = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return kNotFound;
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::optional<InstructionCount> count_instructions(const std::filesystem::path& scene) {
  const ScratchFolder scratch;
  const auto counts = scratch / "callgrind", output = scratch / "output", errors = scratch / "errors";
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const int status = run({"valgrind", "--tool=callgrind", "--callgrind-out-file=" + counts.string(), self, "bench",
                          "--once", std::filesystem::absolute(scene).string()},
                         output, errors);
  if (status == kNotFound) return std::nullopt;
  std::ifstream file(counts);
  for (std::string line; std::getline(file, line);) {
    if (status != 0 || !line.starts_with("totals: ")) continue;
    std::string isa = text_of(output);
    isa.erase(isa.find_last_not_of('\n') + 1);
    return InstructionCount{std::stoll(line.substr(8)), isa};
  }
  throw FileError("valgrind cannot count the instructions of " + scene.string() + ":\n" + text_of(errors));
}

}  // namespace brinell::cli
