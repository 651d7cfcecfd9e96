#include "output/gnuplot.h"

#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "errors.h"
#include "output/staged_file.h"

namespace brinell::cli {

namespace {

/// Sends a script to gnuplot's standard input.
void run_gnuplot(const std::string& script) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);  // a program that is not there closes the pipe
  std::FILE* pipe = ::popen("exec gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) throw FileError(std::string("gnuplot cannot be started: ") + std::strerror(errno));
  std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = ::pclose(pipe);
  std::signal(SIGPIPE, before);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw FileError("gnuplot is not installed; on Debian: apt-get install gnuplot-nox");
  }
  if (status != 0) throw FileError("gnuplot cannot draw the picture; is the folder writable and the disk not full?");
}

}  // namespace

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

void draw_picture(const std::filesystem::path& stem, const std::string& script) {
  const auto draw = [&](const std::string& extension, const std::string& terminal) {
    StagedFile staged(stem.string() + extension);
    run_gnuplot("set terminal " + terminal + "\nset output " + gnuplot_quoted(staged.path().string()) + "\n" +
                script + "\nset output\n");
    staged.publish();
  };
  draw(".svg", "svg size 800,560 dynamic background rgb 'white' font 'sans,14'");
  draw(".png", "pngcairo size 1200,840 background rgb 'white' font 'sans,18'");
}

}  // namespace brinell::cli
