// What the opaque handles of brinell.h are.
#pragma once

#include <atomic>
#include <memory>

#include "guard.h"
#include "scene/engine.h"
#include "scene/run.h"
#include "scene/scene.h"

struct brn_engine {
  explicit brn_engine(const brinell::scene::EngineOptions& options) : engine(options) {}
  brinell::scene::Engine engine;
  mutable brinell::capi::Messages messages;
};

struct brn_scene {
  brinell::scene::Scene scene;
  mutable std::atomic_flag busy;
  mutable brinell::capi::Messages messages;
};

struct brn_run {
  std::unique_ptr<brinell::scene::Run> run;
  mutable std::atomic_flag busy;
  mutable brinell::capi::Messages messages;
};

namespace brinell::capi {

/// Holds a handle for one call; a second thread (or a callback) that asks for it meanwhile is refused.
class Use {
 public:
  Use(std::atomic_flag& busy, const char* what) : busy_(busy) {
    if (busy_.test_and_set(std::memory_order_acquire)) {
      fail(Status::wrong_state, std::string("the ") + what + " is in use by another call");
    }
  }
  ~Use() { busy_.clear(std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  std::atomic_flag& busy_;
};

/// guarded() for a call on a handle that has one user at a time; a NULL handle is refused by its name.
template <class Handle, class Body>
brn_status guarded_use(Handle* handle, const char* name, const Body& body) noexcept {
  return guarded(handle != nullptr ? &handle->messages : nullptr, [&] {
    require(handle, name);
    const Use use(handle->busy, name);
    body();
  });
}

}  // namespace brinell::capi
