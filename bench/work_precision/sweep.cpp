#include "work_precision/sweep.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
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

/// One way to solve one scene; a turn returns its seconds.
class Candidate {
 public:
  virtual ~Candidate() = default;
  virtual double turn() = 0;
  virtual Result result() = 0;
};

class OfEngine final : public Candidate {
 public:
  OfEngine(brn_engine* engine, const cli::SceneFile& scene)
      : engine_(engine), scene_(cli::build_scene(scene).scene) {}

  double turn() override {
    run_ = cli::make_run(engine_, scene_.get());
    field(run_.get(), BRN_FIELD_UNDEFORMED_GAP);  // the surface is not what is timed
    const double start = seconds(Clock::cpu);
    const brn_status status = brn_run_execute(run_.get(), nullptr, nullptr);
    const double end = seconds(Clock::cpu);
    if (status != BRN_NOT_CONVERGED) cli::check(status, run_.get());
    return end - start;
  }

  Result result() override {
    const brn_increment last = cli::increment_of(run_.get(), 0);
    return {field(run_.get(), BRN_FIELD_PRESSURE), last.approach,
            std::max({last.penetration, last.complementarity, last.tension, last.balance}), last.iterations,
            last.convolutions};
  }

 private:
  brn_engine* engine_;
  cli::Scene scene_;
  cli::Run run_;
};

class OfTextbook final : public Candidate {
 public:
  OfTextbook(brn_engine* engine, const cli::SceneFile& scene, std::shared_ptr<Textbook>& shared)
      : modulus_(contact_modulus(scene)), tolerance_(scene.solver.tolerance) {
    const cli::BuiltScene built = cli::build_scene(scene);
    const brn_grid& grid = built.grid;
    const double nodes = static_cast<double>(grid.nx * grid.ny);
    const cli::StepPart& step = scene.steps[0];
    by_approach_ = step.approach.has_value();
    target_ = by_approach_         ? *step.approach
              : step.mean_pressure ? *step.mean_pressure * nodes / modulus_
                                   : *step.normal_force / (grid.dx * grid.dy * modulus_);
    if (shared == nullptr) {
      const cli::Run run = cli::make_run(engine, built.scene.get());
      shared = std::make_shared<Textbook>(Grid{grid.nx, grid.ny, grid.dx, grid.dy}, Boundary{grid.boundary},
                                          field(run.get(), BRN_FIELD_UNDEFORMED_GAP).data());
    }
    solver_ = shared;
  }

  double turn() override {
    const double start = seconds(Clock::cpu);
    solution_ = solver_->solve(by_approach_ ? contact::Drive::approach : contact::Drive::force, target_, tolerance_,
                               kTextbookIterations);
    const double end = seconds(Clock::cpu);
    pressure_ = solver_->pressure();
    for (double& p : pressure_) p *= modulus_;
    return end - start;
  }

  Result result() override {
    return {pressure_, solution_.approach, solution_.certificate.worst(), solution_.iterations,
            solution_.convolutions};
  }

 private:
  double modulus_, tolerance_;
  bool by_approach_ = false;
  double target_ = 0;
  std::shared_ptr<Textbook> solver_;
  TextbookSolution solution_;
  std::vector<double> pressure_;
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
  OfEngine candidate(engine, scene);
  candidate.turn();
  return candidate.result();
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

/// Runs all candidates in turn, and fills in what a point says about its own.
void measure(std::vector<SweepPoint>& points, const std::vector<std::unique_ptr<Candidate>>& candidates, int rounds,
             const std::function<double(const SweepPoint&, const Result&)>& error) {
  constexpr double kLongTime = 5;  // of a point: then its turns end
  std::vector<std::vector<double>> times(points.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (round > 0 && times[k].front() * round > kLongTime) continue;
      if (round == 0 && points[k].method != "textbook") candidates[k]->turn();  // fills the engine's caches
      times[k].push_back(candidates[k]->turn());
      if (round > 0) continue;
      const Result result = candidates[k]->result();
      points[k].error = error(points[k], result);
      points[k].certificate = result.certificate;
      points[k].iterations = result.iterations;
      points[k].convolutions = result.convolutions;
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k) points[k].seconds = median(times[k]);
  mark_front(points);
}

const std::vector<std::string>& methods() {
  static const std::vector<std::string> names{"textbook", "double", "mixed"};
  return names;
}

}  // namespace

Sweep sweep_tolerances(const cli::SceneFile& whole, const SweepOptions& options) {
  const cli::Engine engine = cli::make_engine(1);
  cli::SceneFile scene = one_load(whole, options.step);
  const brn_grid grid = cli::build_scene(scene).grid;
  scene.solver.tolerance = kReferenceTolerance;
  const Result reference = solved_once(engine.get(), scene);

  Sweep sweep{SweepKind::tolerance, "pressure (rms), against the solution to 1e-12", {}};
  std::vector<std::unique_ptr<Candidate>> candidates;
  std::shared_ptr<Textbook> textbook;
  for (const std::string& method : methods()) {
    if (method == "textbook" && grid.nx * grid.ny > options.textbook_nodes) continue;
    for (int exponent = 2; exponent <= 10; ++exponent) {
      scene.solver.tolerance = std::pow(10.0, -exponent);
      scene.solver.mixed = method == "mixed";
      sweep.points.push_back({method, grid.nx, grid.ny, scene.solver.tolerance});
      if (method == "textbook") {
        candidates.push_back(std::make_unique<OfTextbook>(engine.get(), scene, textbook));
      } else {
        candidates.push_back(std::make_unique<OfEngine>(engine.get(), scene));
      }
    }
  }
  measure(sweep.points, candidates, options.rounds,
          [&](const SweepPoint&, const Result& result) { return relative_rms(result.pressure, reference.pressure); });
  return sweep;
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

  std::vector<std::unique_ptr<Candidate>> candidates;
  for (const std::string& method : methods()) {
    for (std::int64_t nx = coarsest; nx <= finest; nx *= 2) {
      cli::SceneFile sized = at(nx);
      sized.solver.mixed = method == "mixed";
      const auto ny = (*sized.grid.nodes)[1];
      if (method == "textbook" && nx * ny > options.textbook_nodes) continue;
      sweep.points.push_back({method, nx, ny, scene.solver.tolerance});
      if (method == "textbook") {
        std::shared_ptr<Textbook> textbook;
        candidates.push_back(std::make_unique<OfTextbook>(engine.get(), sized, textbook));
      } else {
        candidates.push_back(std::make_unique<OfEngine>(engine.get(), sized));
      }
    }
  }
  measure(sweep.points, candidates, options.rounds,
          [&](const SweepPoint&, const Result& result) { return std::fabs(result.approach / reference - 1); });
  return sweep;
}

}  // namespace brinell::bench
