#include "influence/spectrum_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace brinell::influence {
namespace {

using Shared = std::shared_ptr<const fft::Spectrum<double>>;

constexpr std::size_t kValues = 1024;
constexpr std::size_t kBytes = kValues * sizeof(double);

SpectrumKey key(std::int64_t nx) {
  SpectrumKey made;
  made.nx = nx;
  made.ny = 1;
  return made;
}

class Source {
 public:
  Shared get(SpectrumCache& cache, std::int64_t nx) {
    return cache.get<double>(key(nx), [&] {
      ++builds;
      fft::Spectrum<double> spectrum;
      spectrum.values = Buffer<double>(kValues);
      spectrum.values[0] = static_cast<double>(nx);
      return spectrum;
    });
  }
  std::atomic<int> builds = 0;
};

TEST(SpectrumCache, builds_each_spectrum_once) {
  SpectrumCache cache(10 * kBytes);
  Source source;
  const Shared first = source.get(cache, 1);
  EXPECT_EQ(source.get(cache, 1), first);
  EXPECT_NE(source.get(cache, 2), first);
  EXPECT_EQ(source.builds, 2);
  EXPECT_EQ(cache.bytes(), 2 * kBytes);
}

TEST(SpectrumCache, tells_every_member_of_the_key_apart) {
  SpectrumCache cache(100 * kBytes);
  int builds = 0;
  const auto ask = [&](const SpectrumKey& asked) {
    cache.get<double>(asked, [&] {
      ++builds;
      return fft::Spectrum<double>{};
    });
  };
  std::vector<SpectrumKey> keys(8, key(4));
  keys[1].response = Response::conductance;
  keys[2].boundary = Boundary::periodic;
  keys[3].method = fft::Method::fftw;
  keys[4].nx = 5;
  keys[5].ny = 5;
  keys[6].dx = 1;
  keys[7].dy = 1;
  for (int round = 0; round < 2; ++round) {
    for (const SpectrumKey& asked : keys) ask(asked);
    EXPECT_EQ(builds, 8);
  }
  cache.get<float>(keys[0], [&] {
    ++builds;
    return fft::Spectrum<float>{};
  });
  EXPECT_EQ(builds, 9);
}

TEST(SpectrumCache, drops_the_least_recently_used_beyond_its_limit) {
  SpectrumCache cache(2 * kBytes);
  Source source;
  const Shared first = source.get(cache, 1);
  source.get(cache, 2);
  source.get(cache, 1);
  source.get(cache, 3);  // 2 goes
  EXPECT_EQ(cache.bytes(), 2 * kBytes);
  EXPECT_EQ(source.get(cache, 1), first);
  EXPECT_EQ(source.builds, 3);
  source.get(cache, 2);  // 3 goes
  EXPECT_EQ(source.builds, 4);
  source.get(cache, 3);  // 1 goes, but lives on here
  EXPECT_EQ(first->values[0], 1.0);
  EXPECT_NE(source.get(cache, 1), first);
}

TEST(SpectrumCache, of_no_bytes_keeps_nothing) {
  SpectrumCache cache(0);
  Source source;
  EXPECT_EQ(source.get(cache, 1)->values[0], 1.0);
  EXPECT_EQ(source.get(cache, 1)->values[0], 1.0);
  EXPECT_EQ(source.builds, 2);
  EXPECT_EQ(cache.bytes(), 0U);
}

TEST(SpectrumCache, builds_once_for_threads_that_ask_together) {
  SpectrumCache cache(10 * kBytes);
  std::atomic<int> builds = 0;
  std::vector<Shared> found(8);
  std::vector<std::thread> threads;
  for (Shared& mine : found) {
    threads.emplace_back([&] {
      mine = cache.get<double>(key(1), [&] {
        ++builds;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // so that the others come to wait
        return fft::Spectrum<double>{};
      });
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(builds, 1);
  for (const Shared& mine : found) EXPECT_EQ(mine, found[0]);
}

TEST(SpectrumCache, lets_another_thread_build_when_one_has_failed) {
  SpectrumCache cache(10 * kBytes);
  std::atomic<int> builds = 0, failures = 0, successes = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      try {
        cache.get<double>(key(1), [&]() -> fft::Spectrum<double> {
          const bool first = builds++ == 0;
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
          if (first) throw std::runtime_error("no memory");
          return {};
        });
        ++successes;
      } catch (const std::runtime_error&) {
        ++failures;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(builds, 2);
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(successes, 3);
}

}  // namespace
}  // namespace brinell::influence
