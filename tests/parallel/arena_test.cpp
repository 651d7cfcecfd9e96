#include "parallel/arena.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace brinell::parallel {
namespace {

// Lets arenas have more threads than this machine has processors, for the life of a test.
class Arena8 : public testing::Test {
 protected:
  const tbb::global_control allow_{tbb::global_control::max_allowed_parallelism, 8};
};

using ArenaChunks = Arena8;
using ArenaThreads = Arena8;
using ArenaErrors = Arena8;

TEST_F(ArenaChunks, cover_the_range_once_with_bounds_that_depend_on_the_length_alone) {
  for (const int threads : {1, 2, 3, 8}) {
    const Arena arena(threads);
    EXPECT_EQ(arena.threads(), threads);
    for (const auto& [n, chunk] :
         {std::pair{0, 5}, {1, 5}, {4, 5}, {5, 5}, {6, 5}, {10, 5}, {11, 5}, {1000, 1}, {1000, 7}, {1000, 999}}) {
      std::mutex guard;
      std::set<std::pair<std::int64_t, std::int64_t>> seen;
      arena.for_chunks(n, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        const std::lock_guard lock(guard);
        EXPECT_TRUE(seen.emplace(begin, end).second) << begin << " twice";
      });
      std::set<std::pair<std::int64_t, std::int64_t>> expected;
      for (int begin = 0; begin < n; begin += chunk) expected.emplace(begin, std::min(begin + chunk, n));
      EXPECT_EQ(seen, expected) << n << " in chunks of " << chunk;
    }
  }
}

TEST_F(ArenaChunks, take_lengths_beyond_32_bits) {
  const Arena arena(2);
  std::atomic<std::int64_t> total{0};
  const std::int64_t n = (std::int64_t{1} << 40) + 3;
  arena.for_chunks(n, std::int64_t{1} << 35,
                   [&](std::int64_t begin, std::int64_t end, int) { total += end - begin; });
  EXPECT_EQ(total, n);
}

TEST_F(ArenaThreads, slots_are_small_and_unique_among_concurrent_bodies) {
  for (const int threads : {1, 2, 3, 8}) {
    const Arena arena(threads);
    std::vector<std::atomic<int>> busy(static_cast<std::size_t>(threads));
    std::atomic<int> clashes{0};
    std::atomic<int> outside{0};
    arena.for_chunks(3000, 1, [&](std::int64_t begin, std::int64_t, int slot) {
      if (slot < 0 || slot >= threads) {
        ++outside;
        return;
      }
      if (busy[static_cast<std::size_t>(slot)].fetch_add(1) != 0) ++clashes;
      if (begin % 16 == 0) std::this_thread::yield();
      busy[static_cast<std::size_t>(slot)].fetch_sub(1);
    });
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(clashes, 0);
  }
}

TEST_F(ArenaThreads, really_work_at_the_same_time) {
  // Each of two bodies waits until the other has begun; one thread alone would wait in vain.
  const Arena arena(2);
  std::atomic<int> begun{0};
  std::atomic<int> met{0};
  arena.for_chunks(2, 1, [&](std::int64_t, std::int64_t, int) {
    ++begun;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (begun < 2 && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
    if (begun == 2) ++met;
  });
  EXPECT_EQ(met, 2);
}

TEST_F(ArenaThreads, one_thread_runs_on_the_caller_in_order) {
  const Arena arena(1);
  std::vector<std::int64_t> order;
  arena.for_chunks(10, 3, [&, caller = std::this_thread::get_id()](std::int64_t begin, std::int64_t, int slot) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(slot, 0);
    order.push_back(begin);
  });
  EXPECT_EQ(order, (std::vector<std::int64_t>{0, 3, 6, 9}));
}

TEST_F(ArenaThreads, zero_inherits_the_concurrency_of_the_caller) {
  EXPECT_EQ(Arena(0).threads(), tbb::this_task_arena::max_concurrency());
  for (const int threads : {1, 3, 5}) {
    tbb::task_arena callers(threads);
    callers.execute([&] { EXPECT_EQ(Arena(0).threads(), threads); });
  }
}

TEST_F(ArenaThreads, leave_the_settings_of_the_process_alone) {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const int concurrency = tbb::this_task_arena::max_concurrency();
  const Arena arena(3);
  arena.for_chunks(100, 1, [](std::int64_t, std::int64_t, int) {});
  EXPECT_EQ(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism), allowed);
  EXPECT_EQ(tbb::this_task_arena::max_concurrency(), concurrency);
}

TEST_F(ArenaThreads, several_callers_share_one_arena) {
  const Arena arena(3);
  constexpr int kCallers = 4;
  constexpr int kRounds = 50;
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < kCallers; ++caller) {
    callers.emplace_back([&, caller] {
      for (int round = 0; round < kRounds; ++round) {
        const std::int64_t n = 500 + 10 * caller + round;
        std::vector<std::int64_t> of_slot(static_cast<std::size_t>(arena.threads()));
        arena.for_chunks(n, 7, [&](std::int64_t begin, std::int64_t end, int slot) {
          for (std::int64_t i = begin; i < end; ++i) of_slot[static_cast<std::size_t>(slot)] += i;
        });
        std::int64_t total = 0;
        for (const std::int64_t part : of_slot) total += part;
        if (total != n * (n - 1) / 2) ++wrong;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(ArenaThreads, chunk_sums_in_index_order_have_the_same_bits) {
  const auto sum = [](int threads) {
    const Arena arena(threads);
    std::vector<double> partial(100);
    arena.for_chunks(10000, 100, [&](std::int64_t begin, std::int64_t end, int) {
      double part = 0;
      for (std::int64_t i = begin; i < end; ++i) part += std::sin(static_cast<double>(i));
      partial[static_cast<std::size_t>(begin / 100)] = part;
    });
    double total = 0;
    for (const double part : partial) total += part;
    return total;
  };
  const double one = sum(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(sum(threads), one);
}

TEST_F(ArenaErrors, of_a_body_reach_the_caller_and_leave_the_arena_usable) {
  for (const int threads : {1, 2, 8}) {
    const Arena arena(threads);
    std::atomic<int> inside{0};
    try {
      arena.for_chunks(200, 1, [&](std::int64_t begin, std::int64_t, int) {
        ++inside;
        std::this_thread::yield();
        --inside;
        if (begin == 137) throw std::runtime_error("chunk 137");
      });
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "chunk 137");
    }
    EXPECT_EQ(inside, 0);  // no body is still running
    std::atomic<int> count{0};
    arena.for_chunks(100, 1, [&](std::int64_t, std::int64_t, int) { ++count; });
    EXPECT_EQ(count, 100);
  }
}

}  // namespace
}  // namespace brinell::parallel
