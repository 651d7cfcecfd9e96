#include "measure/worker.h"

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace brinell::bench {

namespace {

bool read_all(int file, void* data, std::size_t size) {
  auto* next = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = recv(file, next, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    next += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_all(int file, const void* data, std::size_t size) {
  const auto* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t put = send(file, next, size, MSG_NOSIGNAL);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    next += put;
    size -= static_cast<std::size_t>(put);
  }
  return true;
}

/// Line VmHWM of /proc/self/status: unlike getrusage's, it does not begin with the parent's peak.
std::size_t peak_of_this_process() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes * 1024;
  }
  return 0;
}

pid_t split() {
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process could be started");
  return process;
}

}  // namespace

void* shared_memory(std::size_t bytes) {
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory of " + std::to_string(bytes) + " bytes");
  return memory;
}

void run_apart(const std::function<void()>& body) {
  const pid_t process = split();
  if (process == 0) {
    int status = 0;
    try {
      body();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    std::fflush(nullptr);
    _exit(status);
  }
  int status = 0;
  waitpid(process, &status, 0);
  if (status != 0) throw std::runtime_error("a part of the benchmark failed");
}

WorkerProcess::WorkerProcess(std::size_t size, std::function<std::function<void(void*)>()> set_up) : size_(size) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error("no connection between processes could be made");
  }
  process_ = split();
  connection_ = ends[process_ == 0 ? 1 : 0];
  close(ends[process_ == 0 ? 0 : 1]);
  if (process_ == 0) serve(set_up);
  char ready = 0;
  if (!read_all(connection_, &ready, 1)) throw std::runtime_error("a candidate could not be set up");
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : size_(other.size_),
      process_(std::exchange(other.process_, 0)),
      connection_(std::exchange(other.connection_, -1)) {}

WorkerProcess::~WorkerProcess() {
  if (process_ == 0) return;
  write_all(connection_, "q", 1);  // closing is not enough: later workers have inherited this end
  close(connection_);
  waitpid(process_, nullptr, 0);
}

void WorkerProcess::serve(std::function<std::function<void(void*)>()>& set_up) {
  int status = 0;
  try {
    const auto turn = set_up();
    std::vector<char> sample(size_);
    write_all(connection_, "r", 1);
    for (char command = 0; read_all(connection_, &command, 1) && command != 'q';) {
      if (command == 'r') {
        turn(sample.data());
        write_all(connection_, sample.data(), sample.size());
      } else {
        const std::size_t peak = peak_of_this_process();
        write_all(connection_, &peak, sizeof peak);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = 1;
  }
  std::fflush(nullptr);
  _exit(status);
}

void WorkerProcess::ask(char command, void* answer, std::size_t size) {
  if (!write_all(connection_, &command, 1) || !read_all(connection_, answer, size))
    throw std::runtime_error("a candidate failed");
}

void WorkerProcess::run(void* sample) {
  ask('r', sample, size_);
}

std::size_t WorkerProcess::peak_bytes() {
  std::size_t peak = 0;
  ask('m', &peak, sizeof peak);
  return peak;
}

}  // namespace brinell::bench
