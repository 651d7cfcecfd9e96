// What TBB guarantees but ThreadSanitizer cannot see, because TBB's library is built without it: all before a
// parallel loop happens before its bodies, and these before all that follows it, exceptions included. Without
// effect in other builds.
#pragma once

#ifdef BRINELL_ANNOTATE_FORK_JOIN
#include <sanitizer/tsan_interface.h>
#endif

namespace brinell::parallel {

/// Two points in time that threads meet at: what a thread has done before it releases one, others see who acquire it.
class ForkJoin {
 public:
  /// Lives from before a loop until it has ended.
  ForkJoin() { release(fork_); }
  ~ForkJoin() { acquire(join_); }
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;

  /// Lives while one body of the loop runs.
  class Body {
   public:
    explicit Body(ForkJoin& loop) : loop_(loop) { acquire(loop_.fork_); }
    ~Body() { release(loop_.join_); }
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;

   private:
    ForkJoin& loop_;
  };

 private:
#ifdef BRINELL_ANNOTATE_FORK_JOIN
  static void release(char& point) {
    __tsan_release(&point);
  }
  static void acquire(char& point) {
    __tsan_acquire(&point);
  }
#else
  static void release(char&) {}
  static void acquire(char&) {}
#endif

  char fork_ = 0;
  char join_ = 0;
};

}  // namespace brinell::parallel
