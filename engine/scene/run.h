// A planned scene, solved increment by increment.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "contact/solver.h"
#include "scene/engine.h"
#include "scene/load_history.h"
#include "scene/plan.h"
#include "scene/plastic_fields.h"
#include "scene/scene.h"
#include "scene/stress_stage.h"
#include "scene/undeformed_gap.h"

namespace brinell::scene {

/// The largest equivalent plastic strain of one body and the centre of its cuboid. NaN: the body does not harden; its
/// place also where nothing has flowed.
struct PlasticExtreme {
  double largest = std::numeric_limits<double>::quiet_NaN();
  double at[3] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                  std::numeric_limits<double>::quiet_NaN()};  // [m]
  std::int64_t cuboids = 0;                                   // that have flowed
};

/// Result of one solved increment. NaN: does not exist.
struct Increment {
  Position position;
  bool converged = false;
  std::int32_t iterations = 0;
  std::int32_t convolutions = 0;
  std::int64_t contact_nodes = 0;
  double normal_force = 0;             // [N]
  double approach = 0;                 // [m]
  double tilt[2] = {0, 0};             // slopes of the plane that is added to the gap
  double centre_of_force[2] = {0, 0};  // [m]
  double first_touch = 0;              // smallest gap without pressure, plastic strain included [m]
  double contact_area = 0;             // [m²]
  double max_pressure = 0;             // [Pa]
  double max_pressure_at[2] = {0, 0};  // [m]
  double mean_gap = 0;                 // [m]
  LargestVonMises max_von_mises[2];    // by Which
  bool stress_missing = false;         // computing it was cancelled or failed; advance() or a field makes up for it
  contact::Certificate certificate;
  double yield = std::numeric_limits<double>::quiet_NaN();  // worst violation of the yield condition / yield stress
  std::int32_t substeps = 1;                                // parts in which a body that hardens was loaded
  double increment_error = std::numeric_limits<double>::quiet_NaN();  // estimate: plastic::PlasticSolution
  PlasticExtreme plastic[2];                                          // by Which
  double wall_seconds = 0;

  /// The worst entry of the certificate, the yield condition included.
  double worst() const { return yield > certificate.worst() ? yield : certificate.worst(); }
};

struct TracePoint {
  Position position;
  std::int32_t iteration = 0;
  std::int32_t certified = 0;
  std::int64_t nx = 0, ny = 0;
  double seconds = 0;  // of solving, since the run began
  double certificate = 0;
};

struct Progress {
  Position position;
  std::int32_t solved = 0, total = 0;
  std::int32_t iteration = 0;
  double estimate = 0;
  double seconds = 0;
};

enum class Stage : std::int32_t { surface = 0, contact = 1, stress = 2, plastic = 3 };
inline constexpr std::int32_t kStages = 4;
const char* name(Stage stage);

class Run {
 public:
  using Proceed = std::function<bool(const Progress&)>;

  /// Plans; allocates no fields.
  Run(Engine& engine, const Scene& scene);

  const Plan& plan() const { return plan_; }
  double tolerance() const { return scene_.solver().tolerance; }
  std::int32_t total() const { return total_increments(scene_.steps()); }
  const std::vector<Increment>& increments() const { return increments_; }
  const std::vector<TracePoint>& trace() const { return trace_; }
  double stage_seconds(Stage stage) const { return stage_seconds_[static_cast<int>(stage)]; }
  bool has_stage(Stage stage) const {
    if (stage == Stage::plastic) return scene_.hardens();
    return stage != Stage::stress || stress_ != nullptr;
  }

  /// Solves the next increment and returns it, converged or not. Returns false from `proceed` to cancel: throws
  /// Status::cancelled and the state is that after the last solved increment. Once its contact is solved an increment
  /// stays solved, also if its stress is cancelled or fails: it is marked, and the next call makes up for it first.
  const Increment& advance(const Proceed& proceed);

  /// Nothing is left for advance() to do.
  bool is_finished() const;

  /// Where the upper body stands during a step.
  Place place_of_upper(std::int32_t step) const { return scene::place_of_upper(scene_, step); }

  const std::vector<double>& depths() const { return scene_.subsurface().depths; }

  /// Numbers in a field. Throws Status::wrong_state if the scene does not ask for it.
  std::size_t field_size(Field field) const;

  /// Copies a field of the last solved increment: field_size numbers, or one layer's share of them.
  void copy_field(Field field, std::span<double> values);
  void copy_layer(Field field, std::int64_t layer, std::span<double> values);

  /// The state as bytes: versioned, with a fingerprint of the scene and a checksum.
  std::vector<std::byte> save() const;

  /// A run that goes on where a saved one stopped. Throws Status::damaged_data.
  static std::unique_ptr<Run> load(Engine& engine, const Scene& scene, std::span<const std::byte> bytes);

 private:
  using Clock = std::chrono::steady_clock;

  void prepare();
  double move_upper_body(const Position& position);
  struct BeforeMove;
  void move_back(const BeforeMove& before);
  contact::Solution solve(const contact::Load& load, contact::Observer observer, Increment& increment);
  void compute_stress(const Proceed& proceed);
  void copy_surface_field(Field field, std::span<double> values);
  const Buffer<double>& values_below(Field field);
  void summarise(const contact::Solution& solution, Increment& increment);

  Engine& engine_;
  Scene scene_;
  Plan plan_;
  double contact_modulus_;
  Buffer<double> gap_;          // [m], empty until the first increment
  Buffer<double> present_gap_;  // with what plastic strain adds; empty: nothing hardens
  std::unique_ptr<contact::Solver> solver_;
  std::unique_ptr<StressStage> stress_;               // null: the scene asks for none
  std::unique_ptr<plastic::ElasticPlastic> plastic_;  // these two null: nothing hardens
  std::unique_ptr<PlasticFields> plastic_fields_;

  // What the next increment starts from:
  Origin step_origin_;  // of the step under way
  std::vector<Increment> increments_;
  std::vector<TracePoint> trace_;
  double solving_seconds_ = 0;
  double stage_seconds_[kStages] = {0, 0};
};

}  // namespace brinell::scene
