#include <brinell.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "handles.h"
#include "structs.h"
#include "subsurface/stress_field.h"

using namespace brinell;
using namespace brinell::capi;

namespace {

using subsurface::Invariant;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Arrays {
  subsurface::StressFields fields;
  std::size_t capacity = 0;
};

/// Zero or one, else refused by name.
int32_t checked_choice(int32_t value, const char* name) {
  if (value != 0 && value != 1) {
    fail(Status::invalid_argument, std::string(name) + " = " + std::to_string(value) + ": allowed are 0 and 1");
  }
  return value;
}

subsurface::StressRequest to_request(const brn_stress_request& r) {
  subsurface::StressRequest request;
  request.grid = {r.nx, r.ny, r.dx, r.dy};
  request.boundary = static_cast<Boundary>(checked_choice(r.boundary, "boundary"));
  request.body = static_cast<subsurface::Body>(checked_choice(r.body, "body"));
  request.poissons_ratio = r.poissons_ratio;
  if (r.depth_count > 0) {
    require(r.depths, "depths");
    request.depths.assign(r.depths, r.depths + r.depth_count);
  }
  request.sources = {};
  if (r.pressure != nullptr) request.sources.add(subsurface::Traction::pressure);
  if (r.shear_x != nullptr) request.sources.add(subsurface::Traction::shear_x);
  if (r.shear_y != nullptr) request.sources.add(subsurface::Traction::shear_y);
  return request;
}

/// Notes in the request what the caller has room for.
Arrays to_arrays(const brn_stress_fields* fields, subsurface::StressRequest& request) {
  Arrays arrays;
  if (fields == nullptr) return arrays;
  const auto f = read(fields, "fields", brn_stress_fields_init, &brn_stress_fields::capacity,
                      &brn_stress_fields::component, &brn_stress_fields::von_mises, &brn_stress_fields::tresca,
                      &brn_stress_fields::hydrostatic, &brn_stress_fields::principal, &brn_stress_fields::direction);
  arrays.capacity = f.capacity;
  for (std::size_t c = 0; c < subsurface::kComponents; ++c) {
    arrays.fields.component[c] = f.component[c];
    if (f.component[c] != nullptr) request.components.add(static_cast<subsurface::StressComponent>(c));
  }
  arrays.fields.invariant = {f.von_mises, f.tresca, f.hydrostatic, f.principal[0], f.principal[1], f.principal[2]};
  for (std::size_t k = 0; k < subsurface::kInvariants; ++k) {
    if (arrays.fields.invariant[k] != nullptr) request.invariants.add(static_cast<Invariant>(k));
  }
  std::copy(f.direction, f.direction + 9, arrays.fields.direction.begin());
  const auto directions = std::count_if(f.direction, f.direction + 9, [](const double* d) { return d != nullptr; });
  if (directions != 0 && directions != 9) {
    fail(Status::invalid_argument,
         "direction: " + std::to_string(directions) + " of 9 arrays are given; allowed are all or none");
  }
  request.directions = directions == 9;
  return arrays;
}

void check_room(const Arrays& arrays, const subsurface::StressRequest& request) {
  if (request.components.empty() && request.invariants.empty() && !request.directions) return;
  const std::size_t needed = request.depths.size() * request.grid.nodes();
  if (arrays.capacity >= needed) return;
  fail(Status::short_buffer, "capacity = " + std::to_string(arrays.capacity) +
                                 " doubles in each array of fields; needed are " + std::to_string(needed));
}

void check_finite(const double* values, const char* name, const Grid& grid) {
  if (values == nullptr) return;
  const double* end = values + grid.nodes();
  const double* found = std::find_if_not(values, end, [](double value) { return std::isfinite(value); });
  if (found == end) return;
  fail(Status::invalid_argument,
       std::string(name) + "[" + std::to_string(found - values) + "] = " + text(*found) + " Pa: must be finite");
}

}  // namespace

extern "C" {

brn_status brn_stress_compute(brn_engine* engine, const brn_stress_request* request, const brn_stress_fields* fields,
                              brn_stress_maxima* maxima) {
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(engine, "engine");
    const auto r = read(request, "request", brn_stress_request_init, &brn_stress_request::nx, &brn_stress_request::ny,
                        &brn_stress_request::dx, &brn_stress_request::dy, &brn_stress_request::boundary,
                        &brn_stress_request::body, &brn_stress_request::poissons_ratio, &brn_stress_request::depths,
                        &brn_stress_request::depth_count, &brn_stress_request::pressure, &brn_stress_request::shear_x,
                        &brn_stress_request::shear_y);
    subsurface::StressRequest wanted = to_request(r);
    const Arrays arrays = to_arrays(fields, wanted);
    if (maxima != nullptr) {
      const auto m = read(maxima, "maxima", brn_stress_maxima_init, &brn_stress_maxima::wants_von_mises,
                          &brn_stress_maxima::wants_tresca, &brn_stress_maxima::wants_principal_1);
      if (checked_choice(m.wants_von_mises, "wants_von_mises") != 0) wanted.maxima.add(Invariant::von_mises);
      if (checked_choice(m.wants_tresca, "wants_tresca") != 0) wanted.maxima.add(Invariant::tresca);
      if (checked_choice(m.wants_principal_1, "wants_principal_1") != 0) wanted.maxima.add(Invariant::principal_1);
    }
    subsurface::check(wanted);
    check_room(arrays, wanted);
    check_finite(r.pressure, "pressure", wanted.grid);
    check_finite(r.shear_x, "shear_x", wanted.grid);
    check_finite(r.shear_y, "shear_y", wanted.grid);

    const fft::Backend backend = engine->engine.resources().backend;
    const std::size_t bytes = subsurface::plan_stress(backend, wanted, 0).work_bytes;
    if (bytes > engine->engine.memory_limit()) {
      fail(Status::too_large, "the stress on " + std::to_string(r.nx) + " x " + std::to_string(r.ny) +
                                  " nodes needs " + std::to_string(bytes) + " bytes of work; allowed are " +
                                  std::to_string(engine->engine.memory_limit()));
    }
    subsurface::StressField stress(backend, wanted);
    const subsurface::Maxima found = stress.compute({r.pressure, r.shear_x, r.shear_y}, arrays.fields);
    if (maxima == nullptr) return;
    brn_stress_maxima result;
    brn_stress_maxima_init(&result);
    const auto put = [&](Invariant invariant, double& value, double(&at)[3]) {
      const subsurface::Maximum& maximum = found[static_cast<std::size_t>(invariant)];
      const bool is_wanted = wanted.maxima.has(invariant);
      value = is_wanted ? maximum.value : kNone;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis] = is_wanted && value != 0 ? maximum.position[axis] : kNone;  // no place where all is zero
      }
    };
    put(Invariant::von_mises, result.von_mises, result.von_mises_at);
    put(Invariant::tresca, result.tresca, result.tresca_at);
    put(Invariant::principal_1, result.principal_1, result.principal_1_at);
    write(result, maxima, &brn_stress_maxima::von_mises, &brn_stress_maxima::von_mises_at, &brn_stress_maxima::tresca,
          &brn_stress_maxima::tresca_at, &brn_stress_maxima::principal_1, &brn_stress_maxima::principal_1_at);
  });
}
}
