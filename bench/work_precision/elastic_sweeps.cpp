#include <algorithm>
#include <cmath>

#include "handles.h"
#include "scene_builder.h"
#include "work_precision/measured.h"

namespace brinell::bench {

namespace {

constexpr double kReferenceTolerance = 1e-12;
constexpr double kGridTolerance = 1e-8;

cli::SceneFile one_load(cli::SceneFile scene, const SweepOptions& options) {
  scene.steps = {scene.steps[std::min(options.step, scene.steps.size() - 1)]};
  scene.steps[0].increments = 1;
  return scene;
}

double relative_rms(const std::vector<double>& values, const std::vector<double>& reference) {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    difference += (values[n] - reference[n]) * (values[n] - reference[n]);
    size += reference[n] * reference[n];
  }
  return std::sqrt(difference / size);
}

}  // namespace

Sweep elastic_tolerances(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  cli::SceneFile scene = one_load(options.nodes > 0 ? at_nodes(whole, options.nodes) : whole, options);
  const brn_grid grid = cli::build_scene(scene).grid;
  scene.solver.tolerance = kReferenceTolerance;
  const Result reference = solved_once(engine.get(), scene);

  const auto point = [&](const std::string& method, double tolerance) {
    SweepPoint one;
    one.method = method;
    one.label = as_label(tolerance);
    one.nx = grid.nx;
    one.ny = grid.ny;
    one.tolerance = tolerance;
    return one;
  };
  std::vector<double> tolerances, of_textbook_tolerances;
  for (int exponent = 2; exponent <= 10; ++exponent) tolerances.push_back(std::pow(10.0, -exponent));
  // A force beside the centre costs the textbook a solution anew for each.
  const std::size_t every = scene.steps[0].eccentricity ? 2 : 1;
  std::vector<SweepPoint> textbook_points;
  for (std::size_t k = 0; k < tolerances.size(); k += every) {
    of_textbook_tolerances.push_back(tolerances[k]);
    textbook_points.push_back(point("textbook", tolerances[k]));
  }
  std::vector<Entry> entries;
  if (grid.nx * grid.ny <= options.textbook_nodes) {
    entries.push_back({of_textbook(engine.get(), scene, of_textbook_tolerances), textbook_points});
  }
  for (const char* method : {"double", "mixed"}) {
    for (const double tolerance : tolerances) {
      scene.solver.tolerance = tolerance;
      scene.solver.mixed = method == std::string("mixed");
      entries.push_back({of_engine(engine.get(), scene), {point(method, tolerance)}});
    }
  }
  const Quantity pressure{"pressure (rms)",
                          [&](const Result& result) { return relative_rms(result.pressure, reference.pressure); }};
  return {SweepKind::tolerance, "the solution to 1e-12", measured(entries, options.rounds, {pressure})};
}

std::optional<Sweep> elastic_grids(const cli::SceneFile& whole, const SweepOptions& options) {
  cli::SceneFile scene = one_load(whole, options);
  const bool from_file = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                     [](const cli::SurfacePart& part) { return part.shape == "file"; });
  if (from_file || !scene.grid.nodes || !scene.grid.spacing || options.grids.empty()) return std::nullopt;
  const cli::Engine engine = cli::make_engine(1);
  scene.solver.tolerance = kGridTolerance;

  Sweep sweep{SweepKind::grid, "", {}};
  Quantity quantity;
  const cli::SurfacePart& surface = scene.surfaces.front();
  if (scene.surfaces.size() == 1 && surface.shape == "sphere" && !surface.exact && scene.steps[0].normal_force) {
    // H. Hertz 1882: approach³ = 9 F² / (16 R E*²).
    const double force = *scene.steps[0].normal_force, modulus = contact_modulus(scene);
    const double expected = std::cbrt(9 * force * force / (16 * surface.numbers.at("radius") * modulus * modulus));
    quantity = {"approach", [=](const Result& result) { return std::fabs(result.approach / expected - 1); }};
    sweep.reference = "Hertz";
  } else {
    const std::int64_t nx = options.reference_grid > 0 ? options.reference_grid : 2 * options.grids.back();
    const Result expected = solved_once(engine.get(), at_nodes(scene, nx));
    quantity = {"approach", [=](const Result& result) { return std::fabs(result.approach / expected.approach - 1); }};
    if (scene.steps[0].eccentricity) {
      quantity = {"tilt", [=](const Result& result) { return std::fabs(result.slope / expected.slope - 1); }};
    }
    sweep.reference = std::to_string(nx) + " nodes in x";
  }

  std::vector<Entry> entries;
  for (const char* method : {"textbook", "double", "mixed"}) {
    for (const std::int64_t nx : options.grids) {
      cli::SceneFile sized = at_nodes(scene, nx);
      sized.solver.mixed = method == std::string("mixed");
      SweepPoint point;
      point.method = method;
      point.label = std::to_string(nx);
      point.nx = nx;
      point.ny = (*sized.grid.nodes)[1];
      point.tolerance = kGridTolerance;
      if (method != std::string("textbook")) {
        entries.push_back({of_engine(engine.get(), sized), {point}});
      } else if (point.nx * point.ny <= options.textbook_nodes) {
        entries.push_back({of_textbook(engine.get(), sized, {kGridTolerance}), {point}});
      }
    }
  }
  sweep.points = measured(entries, options.rounds, {quantity});
  return sweep;
}

}  // namespace brinell::bench
