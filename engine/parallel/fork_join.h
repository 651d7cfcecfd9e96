// What TBB guarantees but ThreadSanitizer cannot see, because TBB's library is built without it: all before a
// parallel loop happens before its bodies, and these before all that follows it. Empty in other builds.
#pragma once

#ifdef BRINELL_ANNOTATE_FORK_JOIN
#include <sanitizer/tsan_interface.h>
#endif

namespace brinell::parallel {

#ifdef BRINELL_ANNOTATE_FORK_JOIN
class ForkJoin {
 public:
  ForkJoin() { __tsan_release(&fork_); }
  void begin_body() { __tsan_acquire(&fork_); }
  void end_body() { __tsan_release(&join_); }
  void joined() { __tsan_acquire(&join_); }

 private:
  char fork_ = 0;
  char join_ = 0;
};
#else
class ForkJoin {
 public:
  void begin_body() {}
  void end_body() {}
  void joined() {}
};
#endif

}  // namespace brinell::parallel
