#include <algorithm>
#include <cmath>
#include <functional>

#include "handles.h"
#include "work_precision/measured.h"

namespace brinell::bench {

namespace {

constexpr double kReferenceTolerance = 1e-10;

/// The history up to and with the step, with no more results than errors need.
cli::SceneFile history(const cli::SceneFile& whole, const SweepOptions& options) {
  cli::SceneFile scene = options.nodes > 0 ? at_nodes(whole, options.nodes) : whole;
  if (options.step + 1 < scene.steps.size()) scene.steps.resize(options.step + 1);
  scene.output.fields = {"pressure"};
  return scene;
}

std::vector<Quantity> errors_against(const Result& expected) {
  const auto relative = [](double value, double reference) { return std::fabs(value / reference - 1); };
  return {
      {"approach", [=](const Result& r) { return relative(r.approach, expected.approach); }},
      {"largest pressure", [=](const Result& r) { return relative(r.largest_pressure, expected.largest_pressure); }},
      {"largest plastic strain",
       [=](const Result& r) { return relative(r.plastic_strain, expected.plastic_strain); }}};
}

/// The limit of what changes from one doubling of the increments to the next by a factor that lies between those of
/// first and of second order.
double extrapolated(double coarse, double fine, double finest) {
  const double ratio = std::clamp((fine - coarse) / (finest - fine), 2.0, 4.0);
  return std::isnan(ratio) ? finest : finest + (finest - fine) / (ratio - 1);
}

/// Scenes that differ in what is swept; one curve for each method.
class Entries {
 public:
  explicit Entries(brn_engine* engine) : engine_(engine) {}

  void add(const std::string& method, const std::string& label, const cli::SceneFile& scene) {
    SweepPoint point;
    point.method = method;
    point.label = label;
    point.nx = (*scene.grid.nodes)[0];
    point.ny = (*scene.grid.nodes)[1];
    point.tolerance = scene.solver.tolerance;
    entries_.push_back({of_engine(engine_, scene), {point}});
  }

  std::vector<SweepPoint> points(const SweepOptions& options, const Result& reference) {
    return measured(entries_, options.rounds, errors_against(reference));
  }

 private:
  brn_engine* engine_;
  std::vector<Entry> entries_;
};

}  // namespace

Sweep plastic_tolerances(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  cli::SceneFile scene = history(whole, options);
  scene.solver.tolerance = kReferenceTolerance;
  const Result reference = solved_once(engine.get(), scene);
  Entries entries(engine.get());
  for (int exponent = 2; exponent <= 8; ++exponent) {
    scene.solver.tolerance = std::pow(10.0, -exponent);
    entries.add("double", as_label(scene.solver.tolerance), scene);
  }
  return {SweepKind::tolerance, "the solution to 1e-10", entries.points(options, reference)};
}

Sweep plastic_grids(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  const cli::SceneFile scene = history(whole, options);
  const std::int64_t finest = options.reference_grid > 0 ? options.reference_grid : 2 * options.grids.back();
  const Result reference = solved_once(engine.get(), at_nodes(scene, finest));
  Entries entries(engine.get());
  for (const std::int64_t nx : options.grids) entries.add("double", std::to_string(nx), at_nodes(scene, nx));
  return {SweepKind::grid, std::to_string(finest) + " nodes in x", entries.points(options, reference)};
}

Sweep plastic_increments(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  const cli::SceneFile scene = history(whole, options);
  const auto in = [&](std::int32_t increments) {
    cli::SceneFile divided = scene;
    divided.steps.back().increments = increments;
    return divided;
  };
  const std::int32_t most = *std::max_element(options.increments.begin(), options.increments.end());
  const Result coarse = solved_once(engine.get(), in(most)), fine = solved_once(engine.get(), in(2 * most)),
               finest = solved_once(engine.get(), in(4 * most));
  const auto limit = [&](double Result::*value) { return extrapolated(coarse.*value, fine.*value, finest.*value); };
  Result reference;
  reference.approach = limit(&Result::approach);
  reference.largest_pressure = limit(&Result::largest_pressure);
  reference.plastic_strain = limit(&Result::plastic_strain);

  Entries entries(engine.get());
  for (const std::int32_t n : options.increments) entries.add("equal increments", std::to_string(n), in(n));
  for (const double tolerance : {3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
    cli::SceneFile steered = in(1);
    steered.solver.increment_tolerance = tolerance;
    entries.add("increment_tolerance", as_label(tolerance), steered);
  }
  return {SweepKind::increments,
          std::to_string(most) + " to " + std::to_string(4 * most) + " increments extrapolated",
          entries.points(options, reference)};
}

}  // namespace brinell::bench
