// One line on the terminal that tells how far a run is.
#pragma once

#include <brinell.h>

#include <chrono>
#include <string>

namespace brinell::cli {

class ProgressLine {
 public:
  /// Silent if `quiet` or if the error stream is not a terminal.
  explicit ProgressLine(bool quiet);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  /// Redraws the line, at most ten times a second.
  void show(const brn_progress& progress);

  /// Removes the line, for other output.
  void clear();

 private:
  bool enabled_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_{};
};

/// A brn_progress_callback whose `user` is a ProgressLine: shows progress, and cancels once interrupted.
std::int32_t follow_progress(const brn_progress* progress, void* user);

}  // namespace brinell::cli
