// The task arena of an engine: the only place that knows TBB. Loops run over chunks whose bounds depend on the
// length alone, never on the number of threads; reductions combine the chunks in index order. So every result
// is the same, bit for bit, for any number of threads.
#pragma once

#include <cstdint>
#include <memory>

#include "base/function_ref.h"

namespace brinell::parallel {

class Arena {
 public:
  /// threads = 0: the concurrency that the caller itself has (its task arena, or the processors that the process
  /// may use). threads = 1 runs everything on the calling thread. No global state of TBB is changed.
  explicit Arena(int threads);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  int threads() const { return threads_; }

  /// Calls body(begin, end, slot) for [0, chunk), [chunk, 2·chunk), … up to n, in any order and concurrently.
  /// slot < threads() is unique among the bodies that run at one time within this call: it indexes scratch
  /// memory. Do not nest calls. An exception of a body is thrown on after the others have ended.
  void for_chunks(std::int64_t n, std::int64_t chunk,
                  FunctionRef<void(std::int64_t begin, std::int64_t end, int slot)> body) const;

 private:
  class Tasks;
  int threads_;
  std::unique_ptr<Tasks> tasks_;  // null: one thread
};

}  // namespace brinell::parallel
