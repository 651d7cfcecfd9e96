#include "work_precision/sweep.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "measure/clock.h"
#include "measure/statistics.h"
#include "scene_builder.h"
#include "solve/textbook.h"

namespace brinell::bench {

namespace {

constexpr double kReferenceTolerance = 1e-12;
constexpr double kGridTolerance = 1e-8;
constexpr std::int32_t kTextbookIterations = 3000;

struct Result {
  double seconds = 0;
  std::vector<double> pressure;  // [Pa]
  double approach = 0;           // [m]
  double certificate = 0;
  std::int32_t iterations = 0;
  std::int32_t convolutions = 0;
};

cli::SceneFile one_load(cli::SceneFile scene, std::size_t step) {
  if (step >= scene.steps.size()) step = scene.steps.size() - 1;
  scene.steps = {scene.steps[step]};
  scene.steps[0].increments = 1;
  return scene;
}

std::vector<double> field(brn_run* run, int id) {
  std::size_t count = 0;
  cli::check(brn_run_get_field(run, id, nullptr, 0, &count), run);
  std::vector<double> values(count);
  cli::check(brn_run_get_field(run, id, values.data(), values.size(), &count), run);
  return values;
}

double contact_modulus(const cli::SceneFile& scene) {
  const cli::BodyPart& upper = scene.upper.same_as_lower ? scene.lower : scene.upper;
  double compliance = 0;
  for (const cli::BodyPart* body : {&scene.lower, &upper}) {
    if (!body->rigid) compliance += (1 - body->poissons_ratio * body->poissons_ratio) / body->youngs_modulus;
  }
  return 1 / compliance;
}

/// One way to solve one scene to one or more tolerances.
class Candidate {
 public:
  virtual ~Candidate() = default;
  virtual std::vector<Result> turn() = 0;  // a result for each tolerance
};

class OfEngine final : public Candidate {
 public:
  OfEngine(brn_engine* engine, const cli::SceneFile& scene)
      : engine_(engine), scene_(cli::build_scene(scene).scene) {}

  std::vector<Result> turn() override {
    const cli::Run run = cli::make_run(engine_, scene_.get());
    field(run.get(), BRN_FIELD_UNDEFORMED_GAP);  // the surface is not what is timed
    const double start = seconds(Clock::cpu);
    const brn_status status = brn_run_execute(run.get(), nullptr, nullptr);
    const double end = seconds(Clock::cpu);
    if (status != BRN_NOT_CONVERGED) cli::check(status, run.get());
    const brn_increment last = cli::increment_of(run.get(), 0);
    return {{end - start, field(run.get(), BRN_FIELD_PRESSURE), last.approach,
             std::max({last.penetration, last.complementarity, last.tension, last.balance}), last.iterations,
             last.convolutions}};
  }

 private:
  brn_engine* engine_;
  cli::Scene scene_;
};

/// One solution passes all tolerances on its way.
class OfTextbook final : public Candidate {
 public:
  OfTextbook(brn_engine* engine, const cli::SceneFile& scene, std::vector<double> tolerances)
      : modulus_(contact_modulus(scene)), tolerances_(std::move(tolerances)) {
    const cli::BuiltScene built = cli::build_scene(scene);
    const brn_grid& grid = built.grid;
    const double nodes = static_cast<double>(grid.nx * grid.ny);
    const cli::StepPart& step = scene.steps[0];
    by_approach_ = step.approach.has_value();
    target_ = by_approach_         ? *step.approach
              : step.mean_pressure ? *step.mean_pressure * nodes / modulus_
                                   : *step.normal_force / (grid.dx * grid.dy * modulus_);
    const cli::Run run = cli::make_run(engine, built.scene.get());
    solver_ = std::make_unique<Textbook>(Grid{grid.nx, grid.ny, grid.dx, grid.dy}, Boundary{grid.boundary},
                                         field(run.get(), BRN_FIELD_UNDEFORMED_GAP).data());
  }

  std::vector<Result> turn() override {
    std::vector<Result> results;
    double start = seconds(Clock::cpu);
    const auto observe = [&](const TextbookSolution& state) {
      const double now = seconds(Clock::cpu);
      while (results.size() < tolerances_.size() && state.certificate.worst() <= tolerances_[results.size()]) {
        results.push_back({now - start, solver_->pressure(), state.approach, state.certificate.worst(),
                           state.iterations, state.convolutions});
        for (double& p : results.back().pressure) p *= modulus_;
      }
      start += seconds(Clock::cpu) - now;
    };
    solver_->solve(by_approach_ ? contact::Drive::approach : contact::Drive::force, target_, tolerances_.back(),
                   kTextbookIterations, observe);
    return results;
  }

 private:
  double modulus_;
  std::vector<double> tolerances_;  // falling
  bool by_approach_ = false;
  double target_ = 0;
  std::unique_ptr<Textbook> solver_;
};

double relative_rms(const std::vector<double>& values, const std::vector<double>& reference) {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    difference += (values[n] - reference[n]) * (values[n] - reference[n]);
    size += reference[n] * reference[n];
  }
  return std::sqrt(difference / size);
}

Result solved_once(brn_engine* engine, const cli::SceneFile& scene) {
  return OfEngine(engine, scene).turn().front();
}

/// A difference of a hundredth is none.
void mark_front(std::vector<SweepPoint>& points) {
  const auto no_worse = [](double a, double b) { return a <= 1.01 * b; };
  const auto better = [](double a, double b) { return 1.01 * a < b; };
  for (SweepPoint& point : points) {
    point.on_front = std::none_of(points.begin(), points.end(), [&](const SweepPoint& other) {
      return no_worse(other.seconds, point.seconds) && no_worse(other.error, point.error) &&
             (better(other.seconds, point.seconds) || better(other.error, point.error));
    });
  }
}

/// A candidate and its points, one for each of its tolerances.
struct Entry {
  std::unique_ptr<Candidate> candidate;
  std::vector<SweepPoint> points;
};

/// Runs all candidates in turn, and fills in what a point says about its own.
std::vector<SweepPoint> measured(std::vector<Entry>& entries, int rounds,
                                 const std::function<double(const Result&)>& error) {
  constexpr double kLongTime = 5;  // of a candidate: then its turns end
  std::vector<SweepPoint> points;
  std::vector<std::vector<std::vector<double>>> times(entries.size());  // of entry and point, one for each turn
  for (int round = 0; round <= rounds; ++round) {                       // the first fills caches and gives the errors
    for (std::size_t e = 0; e < entries.size(); ++e) {
      Entry& entry = entries[e];
      if (round > 1 && !times[e].empty() && times[e].back().front() * round > kLongTime) continue;
      const std::vector<Result> results = entry.candidate->turn();
      times[e].resize(results.size());
      if (round == 0) entry.points.resize(results.size());
      for (std::size_t k = 0; k < results.size(); ++k) {
        SweepPoint& point = entry.points[k];
        if (round > 0) {
          times[e][k].push_back(results[k].seconds);
          continue;
        }
        point.error = error(results[k]);
        point.certificate = results[k].certificate;
        point.iterations = results[k].iterations;
        point.convolutions = results[k].convolutions;
      }
    }
  }
  for (std::size_t e = 0; e < entries.size(); ++e) {
    for (std::size_t k = 0; k < entries[e].points.size(); ++k) {
      entries[e].points[k].seconds = median(times[e][k]);
      points.push_back(entries[e].points[k]);
    }
  }
  mark_front(points);
  return points;
}

}  // namespace

Sweep sweep_tolerances(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  cli::SceneFile scene = one_load(whole, options.step);
  const brn_grid grid = cli::build_scene(scene).grid;
  scene.solver.tolerance = kReferenceTolerance;
  const Result reference = solved_once(engine.get(), scene);

  std::vector<Entry> entries;
  std::vector<double> tolerances;
  std::vector<SweepPoint> of_textbook;
  for (int exponent = 2; exponent <= 10; ++exponent) {
    tolerances.push_back(std::pow(10.0, -exponent));
    of_textbook.push_back({"textbook", grid.nx, grid.ny, tolerances.back()});
  }
  if (grid.nx * grid.ny <= options.textbook_nodes) {
    entries.push_back({std::make_unique<OfTextbook>(engine.get(), scene, tolerances), of_textbook});
  }
  for (const char* method : {"double", "mixed"}) {
    for (const double tolerance : tolerances) {
      scene.solver.tolerance = tolerance;
      scene.solver.mixed = method == std::string("mixed");
      entries.push_back({std::make_unique<OfEngine>(engine.get(), scene), {{method, grid.nx, grid.ny, tolerance}}});
    }
  }
  return {SweepKind::tolerance, "pressure (rms), against the solution to 1e-12",
          measured(entries, options.rounds,
                   [&](const Result& result) { return relative_rms(result.pressure, reference.pressure); })};
}

std::optional<Sweep> sweep_grids(const cli::SceneFile& whole, const SweepOptions& options, std::int64_t coarsest,
                                 std::int64_t finest) {
  cli::SceneFile scene = one_load(whole, options.step);
  const bool from_file = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                     [](const cli::SurfacePart& part) { return part.shape == "file"; });
  if (from_file || !scene.grid.nodes || !scene.grid.spacing) return std::nullopt;
  const cli::Engine engine = cli::make_engine(1);
  const auto nodes = *scene.grid.nodes;
  const auto spacing = *scene.grid.spacing;
  const auto at = [&](std::int64_t nx) {
    cli::SceneFile sized = scene;
    const double factor = static_cast<double>(nodes[0]) / static_cast<double>(nx);
    sized.grid.nodes = {nx, static_cast<std::int64_t>(std::lround(static_cast<double>(nodes[1]) / factor))};
    sized.grid.spacing = {spacing[0] * factor, spacing[1] * factor};
    return sized;
  };
  scene.solver.tolerance = kGridTolerance;

  Sweep sweep{SweepKind::grid, "", {}};
  double reference = 0;
  const cli::SurfacePart& surface = scene.surfaces.front();
  if (scene.surfaces.size() == 1 && surface.shape == "sphere" && !surface.exact && scene.steps[0].normal_force) {
    // H. Hertz 1882: approach³ = 9 F² / (16 R E*²).
    const double force = *scene.steps[0].normal_force, modulus = contact_modulus(scene);
    reference = std::cbrt(9 * force * force / (16 * surface.numbers.at("radius") * modulus * modulus));
    sweep.error_of = "approach, against Hertz";
  } else {
    reference = solved_once(engine.get(), at(2 * finest)).approach;
    sweep.error_of = "approach, against twice the finest grid";
  }

  std::vector<Entry> entries;
  for (const char* method : {"textbook", "double", "mixed"}) {
    for (std::int64_t nx = coarsest; nx <= finest; nx *= 2) {
      cli::SceneFile sized = at(nx);
      sized.solver.mixed = method == std::string("mixed");
      const auto ny = (*sized.grid.nodes)[1];
      const SweepPoint point{method, nx, ny, kGridTolerance};
      if (method != std::string("textbook")) {
        entries.push_back({std::make_unique<OfEngine>(engine.get(), sized), {point}});
      } else if (nx * ny <= options.textbook_nodes) {
        entries.push_back(
            {std::make_unique<OfTextbook>(engine.get(), sized, std::vector<double>{kGridTolerance}), {point}});
      }
    }
  }
  sweep.points = measured(entries, options.rounds,
                          [&](const Result& result) { return std::fabs(result.approach / reference - 1); });
  return sweep;
}

}  // namespace brinell::bench
