// Contact of bodies of which at least one hardens, increment by increment. In each the plastic strain follows the
// load implicitly, to second order in the size of the increment (flow_path.h), by what is known at its two ends
// alone: so it is the same whether force or approach is prescribed. With the increment d of the plastic strain of all
// bodies as the unknown, one iteration is
//
//   residual displacement of (before + d)  ->  gap of the undeformed bodies
//   contact on that gap, from the last pressure  ->  pressure
//   total stress, return to the yield surface (plastic_body.h)  ->  mapped
//   d  <-  Anderson acceleration of d = mapped
//
// with no loop within: the contact is solved as exactly as the plastic strain deserves. (C. Jacq, D. Nelias, G.
// Lormand & D. Girodin, 2002, and V. Boucly, D. Nelias, S. Liu, Q. J. Wang & L. M. Keer, 2005, nest loops and leave
// the residual stress behind by one increment; the yield condition then holds to first order only.)
//
// An increment that does not converge is divided in two, again and again, and what is solved stays solved. One whose
// estimated error is larger than asked for is divided too: the estimate goes with the square of the increment, as the
// error of all increments together does.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "contact/solver.h"
#include "plastic/plastic_body.h"

namespace brinell::plastic {

struct PairSettings {
  double contact_modulus = 0;  // E* [Pa], of both bodies
  Layers layers;
  double tolerance = 1e-8;             // on the contact's certificate and on the yield condition
  std::int32_t max_iterations = 2000;  // of one contact
  std::size_t spectra_limit = 0;       // [bytes] of coefficients of the stress that each body may keep
  double increment_tolerance = 0;      // on PlasticSolution::increment_error; 0: increments are not divided for it
};

/// What hardens: by body, 0 lower, 1 upper; nothing: it is elastic or rigid.
struct Pair {
  std::array<std::optional<PlasticMaterial>, 2> material;
  bool identical = false;  // the upper body is the mirror image of the lower one, which stands for both
};

struct PlasticSolution {
  contact::Solution contact;  // iterations and convolutions: of all of the increment
  bool converged = false;
  double yield = 0;             // worst violation of the yield condition, relative to the yield stress
  std::int32_t iterations = 0;  // of plastic strain
  std::int32_t substeps = 1;
  double increment_error = 0;  // root mean square, over what has flowed, of flow_error(); of the worst substep
  double dissipation = 0;      // plastic work of the increment [J]
  double plastic_seconds = 0;  // spent on all but the contact
};

class ElasticPlastic {
 public:
  /// The solver stands on present_gap, which this changes: gap, of the undeformed bodies, plus what the plastic
  /// strain adds. All are borrowed. Free boundary.
  ElasticPlastic(const contact::Resources& resources, const Grid& grid, const double* gap, double* present_gap,
                 contact::Solver& solver, const Pair& pair, const PairSettings& settings);

  /// Solves one increment up to the load. If the observer stops it, or anything fails, the error is passed on and the
  /// state is that before. Throws Status::invalid_scene where plastic strain reaches the last layer or the grid's
  /// side. shear: full sliding, the shear that pushes the lower body, by the pressure; the upper one gets the
  /// opposite. It adds to the stress that yields; what it displaces is left out of the contact, as of an elastic one.
  PlasticSolution advance(const contact::Load& load, contact::Observer observer, const TractionRatio& shear = {});

  /// The gap's values are others now, because the upper body stands elsewhere: its plastic strain has moved by so
  /// many nodes. The contact is opened. Throws Status::invalid_scene where plastic strain would leave the grid, and
  /// is then undefined: restore() it.
  void move_upper_body(std::int64_t nodes_x, std::int64_t nodes_y);

  /// Bytes of the acceleration for so many strain components of cuboids.
  static std::size_t acceleration_bytes(std::size_t unknowns);

  /// 0 lower, 1 upper; null: it does not harden, or the lower one stands for it.
  PlasticBody* body(int which) { return bodies_[static_cast<std::size_t>(which)].get(); }
  const PlasticBody* body(int which) const { return bodies_[static_cast<std::size_t>(which)].get(); }
  bool identical() const { return identical_; }

  /// What plastic strain adds to the gap [m].
  void residual_displacement(double* result) const;

  struct State {
    std::array<std::optional<PlasticBody::State>, 2> bodies;
    contact::Solver::State contact;
    bool last_was_force = true;
    double last_change = 0;
    double last_error = 0;
    double total = 0, approach = 0;
  };
  State state() const;
  void restore(const State& state);

 private:
  struct Progress;
  PlasticSolution reach(const contact::Load& load, contact::Observer observer, const TractionRatio& shear);
  void displace();
  contact::Box contact_box() const;
  double increment_error() const;
  double part_within_tolerance(double change, bool force) const;
  template <class Body>
  void for_bodies(const Body& body);

  contact::Resources resources_;
  Grid grid_;
  const double* gap_;
  double* present_gap_;
  contact::Solver& solver_;
  PairSettings settings_;
  std::array<std::unique_ptr<PlasticBody>, 2> bodies_;
  bool identical_;
  Anderson anderson_;

  // Of the last solution:
  bool last_was_force_ = true;
  double last_change_ = 0;
  double last_error_ = 0;
  double total_ = 0, approach_ = 0;
};

}  // namespace brinell::plastic
