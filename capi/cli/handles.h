// Owners of the C handles, and the statuses of the C interface as exceptions.
#pragma once

#include <brinell.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace brinell::cli {

/// A call of brinell.h that did not return BRN_OK.
class EngineError : public std::runtime_error {
 public:
  EngineError(brn_status status, const std::string& message) : std::runtime_error(message), status_(status) {}
  brn_status status() const { return status_; }

 private:
  brn_status status_;
};

struct Destroy {
  void operator()(brn_engine* engine) const { brn_engine_destroy(engine); }
  void operator()(brn_scene* scene) const { brn_scene_destroy(scene); }
  void operator()(brn_run* run) const { brn_run_destroy(run); }
};

using Engine = std::unique_ptr<brn_engine, Destroy>;
using Scene = std::unique_ptr<brn_scene, Destroy>;
using Run = std::unique_ptr<brn_run, Destroy>;

/// Throws EngineError with the message of the thread or the run unless `status` is BRN_OK.
inline void check(brn_status status) {
  if (status != BRN_OK) throw EngineError(status, brn_last_message());
}
inline void check(brn_status status, const brn_run* run) {
  if (status != BRN_OK) throw EngineError(status, brn_run_message(run));
}

/// At most `threads` threads; 0: all that the process may use. Throws EngineError, as the next ones.
Engine make_engine(int threads);

Run make_run(brn_engine* engine, const brn_scene* scene);

/// Goes on from what `save_run` returned.
Run load_run(brn_engine* engine, const brn_scene* scene, const std::string& state);

std::string save_run(brn_run* run);

brn_increment increment_of(brn_run* run, int index);

/// Of the layers [m]; empty if the scene asks for nothing below the surface.
std::vector<double> depths_of(brn_run* run);

}  // namespace brinell::cli
