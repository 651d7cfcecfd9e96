// Normal contact of two half-spaces: the pressure that carries a prescribed force, or that a prescribed approach
// makes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/buffer.h"
#include "contact/level.h"
#include "contact/nested_grids.h"
#include "contact/problem.h"
#include "contact/rest.h"

namespace brinell::contact {

struct Solution {
  bool converged = false;
  double approach = 0;              // [m] at the centre of the grid
  double slope_x = 0, slope_y = 0;  // of the plane that is added to the gap
  double total = 0;                 // Σ p [E*]
  Certificate certificate;
  std::int32_t iterations = 0;    // on the full grid
  std::int32_t convolutions = 0;  // on the full grid, the certificate's included

  /// This one, with the work of an earlier one that it set out from counted in.
  Solution after(const Solution& earlier) const {
    Solution both = *this;
    both.iterations += earlier.iterations;
    both.convolutions += earlier.convolutions;
    return both;
  }
};

struct SolverPart {
  const char* what;
  std::size_t bytes;
};

/// Keeps the state of one contact from increment to increment. Lengths in metres, pressures in units of E*.
class Solver {
 public:
  /// gap [m] is borrowed: it outlives the solver, and whoever changes its values tells gap_changed().
  Solver(const Resources& resources, const Grid& grid, Boundary boundary, const double* gap, bool mixed_precision);
  ~Solver();

  /// load.target: Σ p >= 0 [E*], or the approach [m] at the centre of the grid; lengths in metres. Starts from the
  /// present pressure. If the observer stops it, Status::cancelled is thrown and the state is undefined: restore()
  /// it. Throws Status::no_equilibrium where no contact can carry the load.
  Solution solve(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);

  /// Pressure [E*] of every node.
  const Buffer<double>& pressure() const { return p_; }

  /// Gap of the deformed surfaces before the approach is taken off, both measured from origin(), in units of dx:
  /// origin + dx·deformed_gap + slope_x·x + slope_y·y − approach is what is open between them.
  const Buffer<double>& deformed_gap() const { return g_; }

  double first_touch() const { return first_touch_; }  // of the present gap [m]
  double origin() const { return origin_; }            // first_touch of the gap it was made with [m]

  /// The values of the gap are others now, say by a residual displacement. The pressure stays, to start from;
  /// deformed_gap() follows with the next solve() or restore().
  void gap_changed();

  /// What the next solution starts from.
  struct State {
    Buffer<double> pressure;  // [E*]; empty if the bodies are apart
    double total = 0;         // Σ p
    double approach = 0;      // [m]
    double slope_x = 0, slope_y = 0;
  };
  State state() const;

  /// Goes back to an earlier state, to the bits that it had.
  void restore(const State& state);

  /// What a solver holds, before it is made.
  static std::vector<SolverPart> parts(const fft::Backend& backend, const Grid& grid, Boundary boundary,
                                       bool mixed_precision);

 private:
  template <class Real>
  Solution solve_nested(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);
  template <class Real>
  Solution solve_robustly(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);
  Solution solve_in_precision(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);
  Solution solve_tilting_approach(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer);
  double first_touch_of(const Load& load) const;
  void check_equilibrium(const Load& load) const;
  bool has_rest() const;
  Rest rest_of(const Load& load) const;
  Load unit(const Load& load) const;
  Solution in_metres(const LevelResult& result) const;
  const Compliance<double>& full_compliance();
  template <class Real>
  Level<Real>& full_level();
  bool start_is_close(const Load& load) const;
  void separate();
  UndeformedGap undeformed(const double* gap) const { return {gap, scale_, origin_}; }

  Resources resources_;
  Grid grid_;  // unit lengths: dx = 1
  PlacedGrid placed_;
  Boundary boundary_;
  const double* gap_;
  double scale_;  // metres to unit lengths
  bool mixed_precision_;
  double origin_ = 0;  // lengths inside are measured from it [m]
  double first_touch_ = 0;
  double mean_gap_ = 0;
  Buffer<double> p_, g_;
  std::unique_ptr<Compliance<double>> compliance_;  // of the full grid; this and the next made when first needed
  std::unique_ptr<Level<double>> in_double_;
  std::unique_ptr<Level<float>> in_single_;
  double total_ = 0;     // Σ p of the last solution [E*]
  double approach_ = 0;  // of the last solution [m]
  double slope_x_ = 0, slope_y_ = 0;
};

}  // namespace brinell::contact
