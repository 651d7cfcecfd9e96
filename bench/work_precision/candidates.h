// Ways to solve one scene, each prepared once and then timed in turns.
#pragma once

#include <brinell.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "scene_file.h"

namespace brinell::bench {

struct Result {
  bool converged = true;
  double seconds = 0;
  std::vector<double> pressure;  // [Pa], after the last increment, as the next ones
  double approach = 0;           // [m]
  double slope = 0;              // along x, of the plane that is added to the gap
  double largest_pressure = 0;   // [Pa]
  double plastic_strain = 0;     // largest equivalent one
  double certificate = 0;
  std::int32_t increments = 1;
  std::int32_t iterations = 0;    // in all increments
  std::int32_t convolutions = 0;  // likewise
};

class Candidate {
 public:
  virtual ~Candidate() = default;
  virtual std::vector<Result> turn() = 0;  // a result for each tolerance
};

/// All increments of the scene, to its own tolerance.
std::unique_ptr<Candidate> of_engine(brn_engine* engine, const cli::SceneFile& scene);

/// The textbook for the scene's one load. A parallel one passes all tolerances (falling) on its way; one whose force
/// acts beside the centre along x, for Newton's method around the former, is solved anew for each.
std::unique_ptr<Candidate> of_textbook(brn_engine* engine, const cli::SceneFile& scene,
                                       std::vector<double> tolerances);

/// E* of both bodies [Pa].
double contact_modulus(const cli::SceneFile& scene);

Result solved_once(brn_engine* engine, const cli::SceneFile& scene);

}  // namespace brinell::bench
