#include "parallel/arena.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "parallel/fork_join.h"

namespace brinell::parallel {

class Arena::Tasks {
 public:
  explicit Tasks(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Arena::Arena(int threads) : threads_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()) {
  if (threads_ > 1) tasks_ = std::make_unique<Tasks>(threads_);
}

Arena::~Arena() = default;

void Arena::for_chunks(std::int64_t n, std::int64_t chunk,
                       FunctionRef<void(std::int64_t, std::int64_t, int)> body) const {
  if (tasks_ == nullptr || n <= chunk) {
    for (std::int64_t begin = 0; begin < n; begin += chunk) body(begin, std::min(begin + chunk, n), 0);
    return;
  }
  const std::int64_t chunks = (n + chunk - 1) / chunk;
  ForkJoin loop;
  tasks_->arena.execute([&] {
    tbb::parallel_for(std::int64_t{0}, chunks, [&](std::int64_t c) {
      const ForkJoin::Body running(loop);
      body(c * chunk, std::min((c + 1) * chunk, n), tbb::this_task_arena::current_thread_index());
    });
  });
}

}  // namespace brinell::parallel
