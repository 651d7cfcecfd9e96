#include "work_precision/candidates.h"

#include <algorithm>
#include <cmath>

#include "measure/clock.h"
#include "scene_builder.h"
#include "solve/nested_newton.h"
#include "solve/textbook.h"

namespace brinell::bench {

namespace {

constexpr std::int32_t kTextbookIterations = 3000;

std::vector<double> field(brn_run* run, int id) {
  std::size_t count = 0;
  cli::check(brn_run_get_field(run, id, nullptr, 0, &count), run);
  std::vector<double> values(count);
  cli::check(brn_run_get_field(run, id, values.data(), values.size(), &count), run);
  return values;
}

class OfEngine final : public Candidate {
 public:
  OfEngine(brn_engine* engine, const cli::SceneFile& scene)
      : engine_(engine), scene_(cli::build_scene(scene).scene) {}

  std::vector<Result> turn() override {
    const cli::Run run = cli::make_run(engine_, scene_.get());
    field(run.get(), BRN_FIELD_UNDEFORMED_GAP);  // the surface is not what is timed
    const double start = seconds(Clock::cpu);
    const brn_status status = brn_run_execute(run.get(), nullptr, nullptr);
    Result result;
    result.seconds = seconds(Clock::cpu) - start;
    if (status != BRN_NOT_CONVERGED) cli::check(status, run.get());
    result.converged = status == BRN_OK;
    result.increments = brn_run_solved_increments(run.get());
    for (int n = 0; n < result.increments; ++n) {
      const brn_increment increment = cli::increment_of(run.get(), n);
      result.iterations += increment.iterations;
      result.convolutions += increment.convolutions;
    }
    const brn_increment last = cli::increment_of(run.get(), result.increments - 1);
    result.pressure = field(run.get(), BRN_FIELD_PRESSURE);
    result.approach = last.approach;
    result.slope = last.tilt[0];
    result.largest_pressure = last.max_pressure;
    result.plastic_strain = last.max_equivalent_plastic_strain;
    result.certificate = std::max({last.penetration, last.complementarity, last.tension, last.balance});
    if (last.yield > result.certificate) result.certificate = last.yield;
    return {result};
  }

 private:
  brn_engine* engine_;
  cli::Scene scene_;
};

/// What both textbooks need of a scene's one load.
struct TextbookLoad {
  TextbookLoad(brn_engine* engine, const cli::SceneFile& scene) : modulus(contact_modulus(scene)) {
    const cli::BuiltScene built = cli::build_scene(scene);
    const brn_grid& brn = built.grid;
    grid = {brn.nx, brn.ny, brn.dx, brn.dy};
    boundary = Boundary{brn.boundary};
    const cli::StepPart& step = scene.steps[0];
    by_approach = step.approach.has_value();
    target = by_approach          ? *step.approach
             : step.mean_pressure ? *step.mean_pressure * static_cast<double>(grid.nodes()) / modulus
                                  : *step.normal_force / (grid.cell_area() * modulus);
    const cli::Run run = cli::make_run(engine, built.scene.get());
    gap = field(run.get(), BRN_FIELD_UNDEFORMED_GAP);
  }

  double modulus;  // [Pa]
  Grid grid;
  Boundary boundary = Boundary::free;
  bool by_approach = false;
  double target = 0;        // approach [m], or sum of pressures [E*]
  std::vector<double> gap;  // [m]
};

std::vector<double> in_pascal(std::vector<double> pressure, double modulus) {
  for (double& p : pressure) p *= modulus;
  return pressure;
}

class OfTextbook final : public Candidate {
 public:
  OfTextbook(const TextbookLoad& load, std::vector<double> tolerances)
      : modulus_(load.modulus),
        drive_(load.by_approach ? contact::Drive::approach : contact::Drive::force),
        target_(load.target),
        tolerances_(std::move(tolerances)),
        solver_(load.grid, load.boundary, load.gap.data()) {}

  std::vector<Result> turn() override {
    std::vector<Result> results;
    double start = seconds(Clock::cpu);
    const auto observe = [&](const TextbookSolution& state) {
      const double now = seconds(Clock::cpu);
      while (results.size() < tolerances_.size() && state.certificate.worst() <= tolerances_[results.size()]) {
        Result& result = results.emplace_back();
        result.seconds = now - start;
        result.pressure = in_pascal(solver_.pressure(), modulus_);
        result.approach = state.approach;
        result.certificate = state.certificate.worst();
        result.iterations = state.iterations;
        result.convolutions = state.convolutions;
      }
      start += seconds(Clock::cpu) - now;
    };
    solver_.solve(drive_, target_, tolerances_.back(), kTextbookIterations, observe);
    return results;
  }

 private:
  double modulus_;
  contact::Drive drive_;
  double target_;
  std::vector<double> tolerances_;  // falling
  Textbook solver_;
};

class OfNestedNewton final : public Candidate {
 public:
  OfNestedNewton(const TextbookLoad& load, double force_x, std::vector<double> tolerances)
      : modulus_(load.modulus),
        target_(load.target),
        force_x_(force_x),
        tolerances_(std::move(tolerances)),
        solver_(load.grid, load.gap.data()) {}

  std::vector<Result> turn() override {
    std::vector<Result> results;
    for (const double tolerance : tolerances_) {
      const double start = seconds(Clock::cpu);
      const NestedSolution solution = solver_.solve(target_, force_x_, tolerance, kTextbookIterations);
      Result& result = results.emplace_back();
      result.seconds = seconds(Clock::cpu) - start;
      result.pressure = in_pascal(solver_.pressure(), modulus_);
      result.converged = solution.converged;
      result.slope = solution.slope;
      result.certificate = solution.certificate.worst();
      result.iterations = solution.iterations;
      result.convolutions = solution.convolutions;
    }
    return results;
  }

 private:
  double modulus_;
  double target_;
  double force_x_;
  std::vector<double> tolerances_;
  NestedNewton solver_;
};

}  // namespace

std::unique_ptr<Candidate> of_engine(brn_engine* engine, const cli::SceneFile& scene) {
  return std::make_unique<OfEngine>(engine, scene);
}

std::unique_ptr<Candidate> of_textbook(brn_engine* engine, const cli::SceneFile& scene,
                                       std::vector<double> tolerances) {
  const TextbookLoad load(engine, scene);
  if (scene.steps[0].eccentricity) {
    return std::make_unique<OfNestedNewton>(load, (*scene.steps[0].eccentricity)[0], std::move(tolerances));
  }
  return std::make_unique<OfTextbook>(load, std::move(tolerances));
}

double contact_modulus(const cli::SceneFile& scene) {
  const cli::BodyPart& upper = scene.upper.same_as_lower ? scene.lower : scene.upper;
  double compliance = 0;
  for (const cli::BodyPart* body : {&scene.lower, &upper}) {
    if (!body->rigid) compliance += (1 - body->poissons_ratio * body->poissons_ratio) / body->youngs_modulus;
  }
  return 1 / compliance;
}

Result solved_once(brn_engine* engine, const cli::SceneFile& scene) {
  return of_engine(engine, scene)->turn().front();
}

}  // namespace brinell::bench
