#include "scene/run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/elapsed.h"
#include "base/error.h"
#include "surface/shapes.h"

namespace brinell::scene {

namespace {

struct PressureSums {
  double nodes = 0;
  double force = 0, moment_x = 0, moment_y = 0;  // Σ p, Σ p x, Σ p y
  double gap = 0;
  double largest = 0;
  std::int64_t largest_at = -1;
};

/// Sizes that are fine each for itself may overflow together, as x²/(2·radius) does for a tiny radius.
void check_finite(const Buffer<double>& gap, const Grid& grid) {
  for (std::size_t n = 0; n < gap.size(); ++n) {
    if (std::isfinite(gap[n])) continue;
    const auto i = static_cast<std::int64_t>(n) % grid.nx;
    const auto j = static_cast<std::int64_t>(n) / grid.nx;
    fail(Status::invalid_scene, "the gap of the undeformed surfaces at node (" + std::to_string(i) + ", " +
                                    std::to_string(j) + ") is " + text(gap[n]) +
                                    " m: must be finite; compare the sizes of the surfaces with the grid's, " +
                                    text(grid.dx) + " x " + text(grid.dy) + " m a cell");
  }
}

}  // namespace

const char* name(Stage stage) {
  switch (stage) {
    case Stage::surface: return "surface";
    case Stage::contact: return "contact";
    case Stage::stress: return "stress";
    case Stage::plastic: break;
  }
  return "plastic";
}

Run::Run(Engine& engine, const Scene& scene)
    : engine_(engine),
      scene_((scene.check_complete(), scene)),
      plan_(engine, scene),
      contact_modulus_(scene.contact_modulus()) {
  if (!scene_.subsurface().wants(Which::lower) && !scene_.subsurface().wants(Which::upper)) return;
  stress_ = std::make_unique<StressStage>(engine_, scene_, plan_.stress_spectra_limit);
}

bool Run::is_finished() const {
  return increments_.size() == static_cast<std::size_t>(total()) && !increments_.back().stress_missing;
}

/// Sums the surfaces up and sets up the solver.
void Run::prepare() {
  if (solver_ != nullptr) return;
  auto start = Clock::now();
  const Grid& grid = scene_.grid();
  Buffer<double> gap(grid.nodes());
  for (const SurfaceEntry& entry : scene_.surfaces()) {
    if (const auto* shape = std::get_if<surface::Shape>(&entry)) {
      surface::add_to_gap(*shape, {}, grid, gap, engine_.arena());
    } else if (const auto* roughness = std::get_if<surface::Roughness>(&entry)) {
      surface::add_to_gap(*roughness, {}, grid, gap, engine_.arena());
    } else {
      const Heights& heights = std::get<Heights>(entry);
      surface::add_to_gap(surface::HeightMap::contiguous(heights.values->data(), grid.nx, grid.ny), heights.detrend,
                          grid, gap, engine_.arena());
    }
  }
  check_finite(gap, grid);
  gap_ = std::move(gap);
  stage_seconds_[static_cast<int>(Stage::surface)] += seconds_since(start);
  start = Clock::now();
  const double* present = gap_.data();
  if (scene_.hardens()) {
    present_gap_ = Buffer<double>::uninitialised(grid.nodes());
    std::copy(gap_.begin(), gap_.end(), present_gap_.begin());
    present = present_gap_.data();
  }
  solver_ = std::make_unique<contact::Solver>(engine_.resources(), grid, scene_.boundary(), present,
                                              scene_.solver().mixed_precision);
  stage_seconds_[static_cast<int>(Stage::contact)] += seconds_since(start);
  if (scene_.hardens()) {
    plastic::Pair pair;
    pair.identical = scene_.identical();
    for (const Which which : {Which::lower, Which::upper}) {
      if (!scene_.hardens(which) || (which == Which::upper && pair.identical)) continue;
      const Body& body = scene_.body(which);
      pair.material[static_cast<std::size_t>(which)] =
          plastic::PlasticMaterial{body.youngs_modulus, body.poissons_ratio, *scene_.hardening(which)};
    }
    const SolverSettings& settings = scene_.solver();
    plastic_ = std::make_unique<plastic::ElasticPlastic>(
        engine_.resources(), grid, gap_.data(), present_gap_.data(), *solver_, pair,
        plastic::PairSettings{contact_modulus_, scene_.layers(), settings.tolerance, settings.max_iterations,
                              plan_.plastic_spectra_limit});
    plastic_fields_ = std::make_unique<PlasticFields>(engine_, scene_, *plastic_);
  }
  if (increments_.empty()) {
    step_origin_ = {0, std::min(0.0, solver_->first_touch())};
  }
}

/// What concerns plastic strain goes into the increment.
contact::Solution Run::solve(const contact::Load& load, contact::Observer observer, Increment& increment) {
  if (plastic_ == nullptr) {
    contact::Solution solution =
        solver_->solve(load, scene_.solver().tolerance, scene_.solver().max_iterations, observer);
    increment.converged = solution.converged;
    return solution;
  }
  const plastic::PlasticSolution solution = plastic_->advance(load, observer);
  plastic_fields_->forget();
  increment.converged = solution.converged;
  increment.yield = solution.yield;
  increment.substeps = solution.substeps;
  for (const Which which : {Which::lower, Which::upper}) {
    if (!scene_.hardens(which)) continue;
    const auto largest = plastic_->body(scene_.identical() ? 0 : static_cast<int>(which))->largest();
    PlasticExtreme& extreme = increment.plastic[static_cast<int>(which)];
    extreme.largest = largest.value;
    extreme.cuboids = largest.cuboids;
    if (largest.cuboids > 0) std::copy(largest.at.begin(), largest.at.end(), extreme.at);
  }
  stage_seconds_[static_cast<int>(Stage::plastic)] += solution.plastic_seconds;
  stage_seconds_[static_cast<int>(Stage::contact)] -= solution.plastic_seconds;
  return solution.contact;
}

const Increment& Run::advance(const Proceed& proceed) {
  if (!increments_.empty() && increments_.back().stress_missing) {
    compute_stress(proceed);
    return increments_.back();
  }
  const auto solved = static_cast<std::int32_t>(increments_.size());
  if (solved == total()) {
    fail(Status::wrong_state, "all " + std::to_string(total()) + " increments of the run are solved");
  }
  prepare();
  const auto start = Clock::now();
  const Position position = position_of(scene_.steps(), solved);
  if (position.increment == 0 && solved > 0) {
    step_origin_ = {increments_.back().normal_force, increments_.back().approach};
  }
  contact::Load load = load_of(scene_.steps()[static_cast<std::size_t>(position.step)], position.increment,
                               step_origin_, scene_.grid());
  if (load.drive == contact::Drive::force) load.target /= contact_modulus_ * scene_.grid().cell_area();

  const contact::Solver::State before = plastic_ == nullptr ? solver_->state() : contact::Solver::State{};
  const std::size_t traced = trace_.size();
  const bool certifies = plastic_ == nullptr;  // else the contact alone is one of many within the increment
  const auto observe = [&](const contact::Report& report) {
    const double seconds = seconds_since(start);
    trace_.push_back({position, report.iteration, certifies && report.certified ? 1 : 0, report.grid.nx,
                      report.grid.ny, solving_seconds_ + seconds, report.certificate});
    return !proceed || proceed({position, solved, total(), report.iteration, report.certificate, seconds});
  };
  Increment increment;
  increment.position = position;
  contact::Solution solution;
  try {
    solution = solve(load, observe, increment);
  } catch (...) {
    trace_.resize(traced);
    if (plastic_ == nullptr) solver_->restore(before);
    throw;
  }
  summarise(solution, increment);
  if (plastic_ != nullptr) {
    trace_.push_back({position, increment.iterations, 1, scene_.grid().nx, scene_.grid().ny,
                      solving_seconds_ + seconds_since(start), increment.worst()});
  }
  increments_.push_back(increment);

  const double seconds = seconds_since(start);
  increments_.back().wall_seconds = seconds;
  solving_seconds_ += seconds;
  stage_seconds_[static_cast<int>(Stage::contact)] += seconds;
  if (stress_ != nullptr) {
    increments_.back().stress_missing = true;
    compute_stress(proceed);
  }
  return increments_.back();
}

/// Of the last solved increment.
void Run::compute_stress(const Proceed& proceed) {
  prepare();
  const auto start = Clock::now();
  Increment& increment = increments_.back();
  const auto go_on = [&] {
    return !proceed ||
           proceed({increment.position, static_cast<std::int32_t>(increments_.size()) - 1, total(),
                    increment.iterations, increment.worst(), increment.wall_seconds + seconds_since(start)});
  };
  const auto largest = stress_->compute(solver_->pressure().data(), contact_modulus_,
                                        scene_.steps()[static_cast<std::size_t>(increment.position.step)], go_on,
                                        plastic_fields_.get());
  std::copy(largest.begin(), largest.end(), increment.max_von_mises);
  const double seconds = seconds_since(start);
  stage_seconds_[static_cast<int>(Stage::stress)] += seconds;
  if (!increment.stress_missing) return;  // fields made anew after loading are no part of the increment's time
  increment.stress_missing = false;
  increment.wall_seconds += seconds;
  solving_seconds_ += seconds;
}

void Run::summarise(const contact::Solution& solution, Increment& increment) {
  const Grid& grid = scene_.grid();
  const double* p = solver_->pressure().data();
  const double* g = solver_->deformed_gap().data();
  const auto sums = contact::ordered_sum<PressureSums>(
      engine_.arena(), grid.ny, 32,
      [](PressureSums& total, const PressureSums& part) {
        total.nodes += part.nodes;
        total.force += part.force;
        total.moment_x += part.moment_x;
        total.moment_y += part.moment_y;
        total.gap += part.gap;
        if (part.largest > total.largest) {
          total.largest = part.largest;
          total.largest_at = part.largest_at;
        }
      },
      [&](std::int64_t begin, std::int64_t end) {
        PressureSums part;
        for (std::int64_t j = begin; j < end; ++j) {
          for (std::int64_t i = 0; i < grid.nx; ++i) {
            const std::int64_t n = j * grid.nx + i;
            part.gap += g[n];
            if (!(p[n] > 0)) continue;
            part.nodes += 1;
            part.force += p[n];
            part.moment_x += p[n] * grid.x(i);
            part.moment_y += p[n] * grid.y(j);
            if (p[n] > part.largest) {
              part.largest = p[n];
              part.largest_at = n;
            }
          }
        }
        return part;
      });

  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  increment.iterations = solution.iterations;
  increment.convolutions = solution.convolutions;
  increment.contact_nodes = static_cast<std::int64_t>(sums.nodes);
  increment.normal_force = sums.force * contact_modulus_ * grid.cell_area();
  increment.approach = solution.approach;
  increment.tilt[0] = solution.slope_x;
  increment.tilt[1] = solution.slope_y;
  increment.centre_of_force[0] = sums.force > 0 ? sums.moment_x / sums.force : none;
  increment.centre_of_force[1] = sums.force > 0 ? sums.moment_y / sums.force : none;
  increment.first_touch = solver_->origin();
  increment.contact_area = sums.nodes * grid.cell_area();
  increment.max_pressure = sums.largest * contact_modulus_;
  increment.max_pressure_at[0] = sums.largest_at >= 0 ? grid.x(sums.largest_at % grid.nx) : none;
  increment.max_pressure_at[1] = sums.largest_at >= 0 ? grid.y(sums.largest_at / grid.nx) : none;
  increment.mean_gap =
      sums.gap / static_cast<double>(grid.nodes()) * grid.dx - (solution.approach - solver_->origin());
  increment.certificate = solution.certificate;
}

std::size_t Run::field_size(Field field) const {
  const Grid& grid = scene_.grid();
  if (field < Field::residual_displacement) return grid.nodes();
  if (!is_below_surface(field)) {
    if (!scene_.hardens(body_of(field))) {
      fail(Status::wrong_state, "there is no field " + name(field) + ": that body does not harden");
    }
    return grid.nodes();
  }
  const std::vector<Field>& asked = scene_.subsurface().fields;
  if (std::find(asked.begin(), asked.end(), field) == asked.end()) {
    fail(Status::wrong_state,
         "the scene does not ask for the field " + name(field) + ": name it in the request for the subsurface");
  }
  return grid.nodes() * depths().size() * values_per_node(field);
}

void Run::copy_field(Field field, std::span<double> values) {
  if (field >= Field::residual_displacement) {
    const Buffer<double>& all = values_below(field);
    std::copy(all.begin(), all.end(), values.begin());
  } else {
    copy_surface_field(field, values);
  }
}

void Run::copy_layer(Field field, std::int64_t layer, std::span<double> values) {
  const double* begin = values_below(field).data() + static_cast<std::size_t>(layer) * values.size();
  std::copy(begin, begin + values.size(), values.begin());
}

/// A field of one body, computed now if it is not there: after loading, or where that was cancelled or failed.
const Buffer<double>& Run::values_below(Field field) {
  field_size(field);  // refuses what the scene does not ask for
  if (increments_.empty()) fail(Status::wrong_state, "no increment is solved yet: there is no field");
  if (is_plastic(field)) {
    prepare();
    return plastic_fields_->field(field);
  }
  if (!stress_->has_fields()) compute_stress({});
  return stress_->field(field);
}

void Run::copy_surface_field(Field field, std::span<double> values) {
  if (field == Field::undeformed_gap) {
    prepare();
    std::copy(gap_.begin(), gap_.end(), values.begin());
    return;
  }
  if (increments_.empty()) fail(Status::wrong_state, "no increment is solved yet: there is no field");
  prepare();
  const Buffer<double>& p = solver_->pressure();
  const Buffer<double>& g = solver_->deformed_gap();
  const Grid& grid = scene_.grid();
  const double unit = grid.dx;
  const double first_touch = solver_->origin();
  const Increment& last = increments_.back();
  const auto plane = [&](std::size_t n) {
    return last.tilt[0] * grid.x(static_cast<std::int64_t>(n) % grid.nx) +
           last.tilt[1] * grid.y(static_cast<std::int64_t>(n) / grid.nx);
  };
  for (std::size_t n = 0; n < gap_.size(); ++n) {
    switch (field) {
      case Field::pressure: values[n] = p[n] * contact_modulus_; break;
      case Field::gap: values[n] = g[n] * unit - (last.approach - first_touch) + plane(n); break;
      case Field::displacement: values[n] = g[n] * unit - (gap_[n] - first_touch); break;
      default: break;
    }
  }
}

}  // namespace brinell::scene
