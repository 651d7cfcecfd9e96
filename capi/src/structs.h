// Structs that begin with struct_size: only the members that the caller's size covers whole are read or written.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

#include "base/error.h"
#include "guard.h"

namespace brinell::capi {

template <class Struct>
void check_size(const Struct* user, const char* name) {
  require(user, name);
  if (user->struct_size >= sizeof user->struct_size) return;
  fail(Status::invalid_argument, std::string(name) + ": struct_size = " + std::to_string(user->struct_size) +
                                     ": initialise the struct with its _init function");
}

template <class Struct, class Member>
bool covers(std::size_t struct_size, Member Struct::*member) {
  const Struct probe{};
  const auto offset = reinterpret_cast<const char*>(&(probe.*member)) - reinterpret_cast<const char*>(&probe);
  return struct_size >= static_cast<std::size_t>(offset) + sizeof(Member);
}

/// The caller's members over the defaults that `init` gives.
template <class Struct, class... Member>
Struct read(const Struct* user, const char* name, void (*init)(Struct*), Member Struct::*... members) {
  check_size(user, name);
  Struct value;
  init(&value);
  ((covers(user->struct_size, members) ? std::memcpy(&(value.*members), &(user->*members), sizeof(Member)) : nullptr),
   ...);
  return value;
}

template <class Struct, class... Member>
void write(const Struct& value, Struct* user, Member Struct::*... members) {
  ((covers(user->struct_size, members) ? std::memcpy(&(user->*members), &(value.*members), sizeof(Member)) : nullptr),
   ...);
}

}  // namespace brinell::capi
