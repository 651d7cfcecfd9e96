// The border between C++ and C: every call of brinell.h that can fail passes through guarded(), which turns every
// exception into a status and keeps its message for the handle and thread that made the call.
#pragma once

#include <brinell.h>

#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <unordered_map>

#include "base/error.h"

namespace brinell::capi {

/// The last message of each thread about one handle.
class Messages {
 public:
  void set(const std::string& message) {
    const std::lock_guard lock(mutex_);
    by_thread_[std::this_thread::get_id()] = message;
  }
  /// Valid until this thread's next set().
  const char* get() const {
    const std::lock_guard lock(mutex_);
    const auto found = by_thread_.find(std::this_thread::get_id());
    return found == by_thread_.end() ? "" : found->second.c_str();
  }

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::thread::id, std::string> by_thread_;
};

/// Of this thread's calls without a handle.
std::string& last_message();

/// Keeps a message without throwing; messages may be null.
void keep(Messages* messages, const char* message) noexcept;

template <class Body>
brn_status guarded(Messages* messages, const Body& body) noexcept {
  try {
    body();
    return BRN_OK;
  } catch (const Error& error) {
    keep(messages, error.what());
    return static_cast<brn_status>(error.status());
  } catch (const std::bad_alloc&) {
    keep(messages, "out of memory: an allocation failed");
    return BRN_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    keep(messages, error.what());
    return BRN_INTERNAL;
  } catch (...) {
    keep(messages, "an exception of unknown type");
    return BRN_INTERNAL;
  }
}

/// Throws Status::invalid_argument if the pointer is NULL.
void require(const void* pointer, const char* name);

}  // namespace brinell::capi
