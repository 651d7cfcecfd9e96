// The one exception of the engine: a status that the C ABI passes on, and a message for a person that names
// the argument, its value and what is allowed.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace brinell {

/// Values are those of brn_status in brinell.h; capi/src checks at compile time that they agree.
enum class Status : std::int32_t {
  ok = 0,
  invalid_argument = 10,
  invalid_scene = 20,
  wrong_state = 30,
  short_buffer = 40,
  unsupported = 50,
  out_of_memory = 60,
  too_large = 70,
  not_converged = 80,
  no_equilibrium = 85,
  cancelled = 90,
  damaged_data = 100,
  internal = 1000,
};

class Error : public std::runtime_error {
 public:
  Error(Status status, const std::string& message) : std::runtime_error(message), status_(status) {}
  Status status() const { return status_; }

 private:
  Status status_;
};

[[noreturn]] void fail(Status status, const std::string& message);

/// Shortest text that reads back as the same number: "0.3", "2.1e+11", "nan".
std::string text(double value);

}  // namespace brinell
