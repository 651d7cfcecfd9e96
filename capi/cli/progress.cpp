#include "progress.h"

#include <unistd.h>

#include <cstdio>

#include "interrupt.h"

namespace brinell::cli {

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(const brn_progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (!enabled_ || now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\rincrement %d of %d (step %d), iteration %d, certificate %.1e, %.1f s\033[K",
               progress.solved + 1, progress.total, progress.step, progress.iteration, progress.estimate,
               progress.seconds);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressLine::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

std::int32_t follow_progress(const brn_progress* progress, void* user) {
  static_cast<ProgressLine*>(user)->show(*progress);
  return interrupted() ? 1 : 0;
}

}  // namespace brinell::cli
