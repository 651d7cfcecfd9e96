// What can go wrong outside the engine. The command line turns each kind into its exit status; every message names
// the thing, its value and what is allowed.
#pragma once

#include <stdexcept>
#include <string>

namespace brinell::cli {

/// A file cannot be read, is not what it claims to be, or cannot be written: exit status 3.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A scene says something that it may not: exit status 2.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace brinell::cli
