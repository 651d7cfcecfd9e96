// The stage "stress" of a run: the stress below the surface under the pressure of an increment and the shear that
// sliding adds, as much of it as the scene asks for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/buffer.h"
#include "base/function_ref.h"
#include "scene/engine.h"
#include "scene/field.h"
#include "scene/plastic_fields.h"
#include "scene/scene.h"
#include "subsurface/stress_field.h"

namespace brinell::scene {

/// The largest von Mises stress of one body and its place. NaN: not asked for; its place also where nothing presses.
struct LargestVonMises {
  double value = std::numeric_limits<double>::quiet_NaN();  // [Pa]
  double at[3] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                  std::numeric_limits<double>::quiet_NaN()};  // [m]
};

struct StressStagePart {
  std::string what;
  std::uint64_t bytes;
};

class StressStage {
 public:
  /// Allocates no fields. The scene outlives this. Influence coefficients of each body stay for the next increment as
  /// far as spectra_limit bytes allow.
  StressStage(Engine& engine, const Scene& scene, std::size_t spectra_limit);

  /// What the stage holds, before it is made: nothing for a scene that asks for nothing.
  static std::vector<StressStagePart> parts(Engine& engine, const Scene& scene, std::size_t spectra_limit);

  /// Pressure in units of `unit` [Pa]. Calls proceed() after each layer; throws Status::cancelled if it returns
  /// false. What was there before is lost then. plastic: of a scene with a body that hardens, whose stress is then
  /// the total one; else null.
  std::array<LargestVonMises, 2> compute(const double* pressure, double unit, const Step& step,
                                         FunctionRef<bool()> proceed, PlasticFields* plastic);

  /// Whether there are fields of the last compute() that went to its end.
  bool has_fields() const { return has_fields_; }

  /// layers·ny·nx·values_per_node of a field that the scene names.
  const Buffer<double>& field(Field field) const { return fields_.at(field); }

 private:
  struct BodyStress {
    subsurface::Sources sources;
    std::unique_ptr<subsurface::StressField> field;  // null until needed
  };

  subsurface::StressField& stress_field(Which body, subsurface::Sources sources);
  subsurface::Maxima compute_total(Which body, subsurface::StressField& contact,
                                   const subsurface::Tractions& tractions, PlasticFields& plastic,
                                   FunctionRef<void(const subsurface::StressLayer&)> take);
  void keep(Which body, const subsurface::StressLayer& layer);

  Engine& engine_;
  const Scene& scene_;
  std::size_t spectra_limit_;
  std::array<BodyStress, 2> bodies_;
  std::map<Field, Buffer<double>> fields_;  // empty until first computed
  bool has_fields_ = false;
};

}  // namespace brinell::scene
