// A process of its own for each candidate of a comparison. It is set up once and then runs when it is told to, so
// that candidates can take turns, warm, and each has a peak memory of its own.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <type_traits>

namespace brinell::bench {

/// Memory shared with the workers that are started later, zero-filled; it lives until the program ends.
void* shared_memory(std::size_t bytes);

/// Runs body in a process of its own, which leaves no trace in this one but what it writes to shared memory.
/// Throws std::runtime_error if it fails.
void run_apart(const std::function<void()>& body);

class WorkerProcess {
 public:
  /// set_up runs in the new process and returns what each turn calls; that writes `size` bytes. Start no thread in
  /// this process before.
  WorkerProcess(std::size_t size, std::function<std::function<void(void* sample)>()> set_up);
  ~WorkerProcess();
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&&) = delete;

  /// One turn. Throws std::runtime_error if the process failed; it has said why on standard error.
  void run(void* sample);

  /// Largest resident memory of the process so far [bytes].
  std::size_t peak_bytes();

 private:
  [[noreturn]] void serve(std::function<std::function<void(void*)>()>& set_up);
  void ask(char command, void* answer, std::size_t size);

  std::size_t size_;
  pid_t process_ = 0;
  int connection_ = -1;
};

/// A worker whose turns return a plain struct.
template <class Sample>
class Worker {
  static_assert(std::is_trivially_copyable_v<Sample>);

 public:
  explicit Worker(std::function<std::function<Sample()>()> set_up)
      : process_(sizeof(Sample), [set_up = std::move(set_up)]() -> std::function<void(void*)> {
          return [run = set_up()](void* sample) { *static_cast<Sample*>(sample) = run(); };
        }) {}

  Sample run() {
    Sample sample;
    process_.run(&sample);
    return sample;
  }
  std::size_t peak_bytes() { return process_.peak_bytes(); }

 private:
  WorkerProcess process_;
};

}  // namespace brinell::bench
