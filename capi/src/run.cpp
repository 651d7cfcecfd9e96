#include <brinell.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>
#include <string>

#include "handles.h"
#include "structs.h"

using namespace brinell;
using namespace brinell::capi;

namespace {

template <class Size>
void check_index(Size index, Size count, const char* what) {
  if (index >= 0 && index < count) return;
  fail(Status::invalid_argument,
       "index = " + std::to_string(index) + ": the run has " + std::to_string(count) + " " + what);
}

/// One increment. Throws Status::not_converged behind a result that is kept and marked.
void advance(scene::Run& run, brn_progress_callback callback, void* user) {
  std::function<bool(const scene::Progress&)> proceed;
  if (callback != nullptr) {
    proceed = [&](const scene::Progress& p) {
      brn_progress progress{};
      progress.struct_size = sizeof progress;
      progress.step = p.position.step;
      progress.increment = p.position.increment;
      progress.solved = p.solved;
      progress.total = p.total;
      progress.iteration = p.iteration;
      progress.estimate = p.estimate;
      progress.seconds = p.seconds;
      return callback(&progress, user) == 0;
    };
  }
  const scene::Increment& increment = run.advance(proceed);
  if (!increment.converged) {
    fail(Status::not_converged, "step " + std::to_string(increment.position.step) + ", increment " +
                                    std::to_string(increment.position.increment) + " did not converge: after " +
                                    std::to_string(increment.iterations) + " iterations the certificate is " +
                                    text(increment.worst()) + "; the tolerance is " + text(run.tolerance()));
  }
}

/// The index-th stage that the run has.
std::optional<scene::Stage> stage_of(const brn_run* run, int32_t index) {
  if (run == nullptr || index < 0) return {};
  for (int32_t k = 0; k < scene::kStages; ++k) {
    const auto stage = static_cast<scene::Stage>(k);
    if (run->run->has_stage(stage) && index-- == 0) return stage;
  }
  return {};
}

scene::Field checked_field(int32_t field) {
  const auto known = scene::field_of(field);
  if (!known) {
    fail(Status::invalid_argument,
         "field = " + std::to_string(field) +
             ": allowed are 1 (pressure) to 4 (undeformed_gap), 10 (residual_displacement), 20 (stress) to 27 "
             "(principal_directions), 30 (plastic_strain) to 32 (residual_stress), and those from 10 on plus 100 for "
             "the upper "
             "body");
  }
  return *known;
}

/// Tells the number needed; false if that was all the caller wanted to know. A short buffer is refused.
bool has_room(std::size_t needed, const char* name, const double* values, size_t capacity, size_t* count) {
  require(count, "count");
  *count = needed;
  if (capacity == 0) return false;
  require(values, name);
  if (capacity < needed) {
    fail(Status::short_buffer,
         std::string(name) + " hold " + std::to_string(capacity) + " doubles; needed are " + std::to_string(needed));
  }
  return true;
}

}  // namespace

extern "C" {

brn_status brn_run_create(brn_engine* engine, const brn_scene* scene, brn_run** out) {
  if (out != nullptr) *out = nullptr;
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(out, "out");
    require(engine, "engine");
    require(scene, "scene");
    const Use use(scene->busy, "scene");
    auto run = std::make_unique<brn_run>();
    run->run = std::make_unique<scene::Run>(engine->engine, scene->scene);
    *out = run.release();
  });
}

void brn_run_destroy(brn_run* run) {
  delete run;
}

const char* brn_run_message(const brn_run* run) {
  return run != nullptr ? run->messages.get() : brn_last_message();
}

int32_t brn_run_plan_count(const brn_run* run) {
  return run != nullptr ? static_cast<int32_t>(run->run->plan().items.size()) : 0;
}

brn_status brn_run_get_plan_item(brn_run* run, int32_t index, brn_plan_item* out) {
  return guarded_use(run, "run", [&] {
    check_size(out, "out");
    check_index(index, brn_run_plan_count(run), "plan items");
    const scene::PlanItem& item = run->run->plan().items[static_cast<std::size_t>(index)];
    brn_plan_item result;
    brn_plan_item_init(&result);
    result.stage = item.stage;
    result.what = item.what.c_str();
    result.bytes = item.bytes;
    write(result, out, &brn_plan_item::stage, &brn_plan_item::what, &brn_plan_item::bytes);
  });
}

uint64_t brn_run_memory_bytes(const brn_run* run) {
  return run != nullptr ? run->run->plan().memory_bytes : 0;
}

brn_status brn_run_advance(brn_run* run, brn_progress_callback callback, void* user) {
  return guarded_use(run, "run", [&] { advance(*run->run, callback, user); });
}

brn_status brn_run_execute(brn_run* run, brn_progress_callback callback, void* user) {
  return guarded_use(run, "run", [&] {
    while (!run->run->is_finished()) advance(*run->run, callback, user);
  });
}

int32_t brn_run_total_increments(const brn_run* run) {
  return run != nullptr ? run->run->total() : 0;
}

int32_t brn_run_solved_increments(const brn_run* run) {
  return run != nullptr ? static_cast<int32_t>(run->run->increments().size()) : 0;
}

brn_status brn_run_get_increment(brn_run* run, int32_t index, brn_increment* out) {
  return guarded_use(run, "run", [&] {
    check_size(out, "out");
    check_index(index, brn_run_solved_increments(run), "solved increments");
    const scene::Increment& i = run->run->increments()[static_cast<std::size_t>(index)];
    brn_increment result;
    brn_increment_init(&result);
    result.step = i.position.step;
    result.increment = i.position.increment;
    result.converged = i.converged ? 1 : 0;
    result.iterations = i.iterations;
    result.convolutions = i.convolutions;
    result.contact_nodes = i.contact_nodes;
    result.normal_force = i.normal_force;
    result.approach = i.approach;
    result.tilt[0] = i.tilt[0];
    result.tilt[1] = i.tilt[1];
    result.centre_of_force[0] = i.centre_of_force[0];
    result.centre_of_force[1] = i.centre_of_force[1];
    result.first_touch = i.first_touch;
    result.contact_area = i.contact_area;
    result.max_pressure = i.max_pressure;
    result.max_pressure_at[0] = i.max_pressure_at[0];
    result.max_pressure_at[1] = i.max_pressure_at[1];
    result.mean_gap = i.mean_gap;
    result.penetration = i.certificate.penetration;
    result.complementarity = i.certificate.complementarity;
    result.tension = i.certificate.tension;
    result.balance = i.certificate.balance;
    result.wall_seconds = i.wall_seconds;
    result.max_von_mises = i.max_von_mises[BRN_LOWER].value;
    std::copy_n(i.max_von_mises[BRN_LOWER].at, 3, result.max_von_mises_at);
    result.upper_max_von_mises = i.max_von_mises[BRN_UPPER].value;
    std::copy_n(i.max_von_mises[BRN_UPPER].at, 3, result.upper_max_von_mises_at);
    result.stress_missing = i.stress_missing ? 1 : 0;
    result.yield = i.yield;
    result.substeps = i.substeps;
    result.increment_error = i.increment_error;
    result.max_equivalent_plastic_strain = i.plastic[BRN_LOWER].largest;
    std::copy_n(i.plastic[BRN_LOWER].at, 3, result.max_equivalent_plastic_strain_at);
    result.plastic_nodes = i.plastic[BRN_LOWER].cuboids;
    result.upper_max_equivalent_plastic_strain = i.plastic[BRN_UPPER].largest;
    std::copy_n(i.plastic[BRN_UPPER].at, 3, result.upper_max_equivalent_plastic_strain_at);
    result.upper_plastic_nodes = i.plastic[BRN_UPPER].cuboids;
    const scene::Place place = run->run->place_of_upper(i.position.step);
    result.offset[0] = place.x;
    result.offset[1] = place.y;
    write(result, out, &brn_increment::step, &brn_increment::increment, &brn_increment::converged,
          &brn_increment::iterations, &brn_increment::convolutions, &brn_increment::contact_nodes,
          &brn_increment::normal_force, &brn_increment::approach, &brn_increment::tilt,
          &brn_increment::centre_of_force, &brn_increment::first_touch, &brn_increment::contact_area,
          &brn_increment::max_pressure, &brn_increment::max_pressure_at, &brn_increment::mean_gap,
          &brn_increment::penetration, &brn_increment::complementarity, &brn_increment::tension,
          &brn_increment::balance, &brn_increment::wall_seconds, &brn_increment::max_von_mises,
          &brn_increment::max_von_mises_at, &brn_increment::upper_max_von_mises,
          &brn_increment::upper_max_von_mises_at, &brn_increment::stress_missing, &brn_increment::reserved2,
          &brn_increment::yield, &brn_increment::substeps, &brn_increment::reserved3,
          &brn_increment::max_equivalent_plastic_strain, &brn_increment::max_equivalent_plastic_strain_at,
          &brn_increment::plastic_nodes, &brn_increment::upper_max_equivalent_plastic_strain,
          &brn_increment::upper_max_equivalent_plastic_strain_at, &brn_increment::upper_plastic_nodes,
          &brn_increment::offset, &brn_increment::increment_error);
  });
}

int64_t brn_run_trace_count(const brn_run* run) {
  return run != nullptr ? static_cast<int64_t>(run->run->trace().size()) : 0;
}

brn_status brn_run_get_trace_point(brn_run* run, int64_t index, brn_trace_point* out) {
  return guarded_use(run, "run", [&] {
    check_size(out, "out");
    check_index(index, brn_run_trace_count(run), "points in its trace");
    const scene::TracePoint& p = run->run->trace()[static_cast<std::size_t>(index)];
    brn_trace_point result;
    brn_trace_point_init(&result);
    result.step = p.position.step;
    result.increment = p.position.increment;
    result.iteration = p.iteration;
    result.certified = p.certified;
    result.nx = p.nx;
    result.ny = p.ny;
    result.seconds = p.seconds;
    result.certificate = p.certificate;
    write(result, out, &brn_trace_point::step, &brn_trace_point::increment, &brn_trace_point::iteration,
          &brn_trace_point::certified, &brn_trace_point::nx, &brn_trace_point::ny, &brn_trace_point::seconds,
          &brn_trace_point::certificate);
  });
}

const char* brn_run_stage_name(const brn_run* run, int32_t index) {
  const auto stage = stage_of(run, index);
  return stage ? scene::name(*stage) : nullptr;
}

double brn_run_stage_seconds(const brn_run* run, int32_t index) {
  const auto stage = stage_of(run, index);
  return stage ? run->run->stage_seconds(*stage) : 0;
}

brn_status brn_run_get_field(brn_run* run, int32_t field, double* values, size_t capacity, size_t* count) {
  return guarded_use(run, "run", [&] {
    const scene::Field checked = checked_field(field);
    if (!has_room(run->run->field_size(checked), "values", values, capacity, count)) return;
    run->run->copy_field(checked, {values, *count});
  });
}

brn_status brn_run_get_layer(brn_run* run, int32_t field, int64_t layer, double* values, size_t capacity,
                             size_t* count) {
  return guarded_use(run, "run", [&] {
    const scene::Field checked = checked_field(field);
    if (!scene::is_below_surface(checked)) {
      fail(Status::invalid_argument, "field = " + std::to_string(field) + " (" + scene::name(checked) +
                                         "): lies on the surface and has no layers; allowed are fields below it");
    }
    const std::size_t size = run->run->field_size(checked);
    const auto layers = static_cast<int64_t>(run->run->depths().size());
    if (layer < 0 || layer >= layers) {
      fail(Status::invalid_argument,
           "layer = " + std::to_string(layer) + ": allowed are 0 to " + std::to_string(layers - 1));
    }
    if (!has_room(size / static_cast<std::size_t>(layers), "values", values, capacity, count)) return;
    run->run->copy_layer(checked, layer, {values, *count});
  });
}

brn_status brn_run_get_depths(brn_run* run, double* depths, size_t capacity, size_t* count) {
  return guarded_use(run, "run", [&] {
    const std::vector<double>& all = run->run->depths();
    if (has_room(all.size(), "depths", depths, capacity, count)) std::copy(all.begin(), all.end(), depths);
  });
}

brn_status brn_run_save(brn_run* run, void* buffer, size_t capacity, size_t* size) {
  return guarded_use(run, "run", [&] {
    require(size, "size");
    const std::vector<std::byte> bytes = run->run->save();
    *size = bytes.size();
    if (capacity == 0) return;
    require(buffer, "buffer");
    if (capacity < *size) {
      fail(Status::short_buffer,
           "buffer holds " + std::to_string(capacity) + " bytes; needed are " + std::to_string(*size));
    }
    std::memcpy(buffer, bytes.data(), *size);
  });
}

brn_status brn_run_load(brn_engine* engine, const brn_scene* scene, const void* data, size_t size, brn_run** out) {
  if (out != nullptr) *out = nullptr;
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(out, "out");
    require(engine, "engine");
    require(scene, "scene");
    require(data, "data");
    const Use use(scene->busy, "scene");
    auto run = std::make_unique<brn_run>();
    run->run = scene::Run::load(engine->engine, scene->scene, {static_cast<const std::byte*>(data), size});
    *out = run.release();
  });
}
}
