#include "plastic/elastic_plastic.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/elapsed.h"
#include "base/error.h"
#include "plastic/moved_state.h"

namespace brinell::plastic {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kDepth = 6;  // of the acceleration
constexpr std::int32_t kIterations = 80;
constexpr int kHalvings = 6;
// The contact of an iteration is solved to this fraction of the error in the yield condition: with 0.02 its error
// costs a quarter more iterations, with 0.1 it keeps them from converging. Not beyond this fraction of the tolerance,
// nor of what doubles hold.
constexpr double kContactToYield = 1e-3;
constexpr double kContactToTolerance = 0.01;
constexpr double kLeastContact = 1e-13;
constexpr double kFirstContact = 1e-5;
// The increment of plastic strain is extrapolated with a load increment up to so many times larger.
constexpr double kMostExtrapolation = 2;

// An increment is divided for its error into no smaller parts than this, by no more than this at once. The next part
// is made for a little less than what is allowed, and no more than so many times as large as the last.
constexpr double kLeastPart = 1.0 / 256;
constexpr double kMostDivision = 1.0 / 8;
constexpr double kMargin = 0.9;
constexpr double kMostGrowth = 2;

/// Of the size of an increment whose error goes with its square.
double factor_within(double tolerance, double error) {
  return kMargin * std::sqrt(tolerance / error);
}

}  // namespace

ElasticPlastic::ElasticPlastic(const contact::Resources& resources, const Grid& grid, const double* gap,
                               double* present_gap, contact::Solver& solver, const Pair& pair,
                               const PairSettings& settings)
    : resources_(resources),
      grid_(grid),
      gap_(gap),
      present_gap_(present_gap),
      solver_(solver),
      settings_(settings),
      identical_(pair.identical),
      anderson_(resources.backend.arena, kDepth) {
  for (std::size_t which = 0; which < bodies_.size(); ++which) {
    if (!pair.material[which]) continue;
    bodies_[which] = std::make_unique<PlasticBody>(resources.backend, grid, settings.layers, *pair.material[which],
                                                   settings.spectra_limit);
  }
  approach_ = solver.first_touch();
}

std::size_t ElasticPlastic::acceleration_bytes(std::size_t unknowns) {
  return Anderson::bytes(kDepth, unknowns);
}

template <class Body>
void ElasticPlastic::for_bodies(const Body& body) {
  for (const std::unique_ptr<PlasticBody>& one : bodies_) {
    if (one != nullptr) body(*one);
  }
}

contact::Box ElasticPlastic::contact_box() const {
  return contact::contact_box(contact::Box::whole(grid_), solver_.pressure().data());
}

/// The gap follows the plastic strain.
void ElasticPlastic::displace() {
  std::copy_n(gap_, grid_.nodes(), present_gap_);
  for_bodies([&](PlasticBody& body) { body.add_displacement(identical_ ? 2 : 1, present_gap_); });
  solver_.gap_changed();
}

void ElasticPlastic::move_upper_body(std::int64_t nodes_x, std::int64_t nodes_y) {
  if (bodies_[1] != nullptr && (nodes_x != 0 || nodes_y != 0)) {
    bodies_[1]->restore(moved(bodies_[1]->state(), nodes_x, nodes_y, grid_));
  }
  for_bodies([](PlasticBody& body) { body.guess(0); });
  displace();
  solver_.restore({{}, 0, solver_.first_touch()});
  for_bodies([&](PlasticBody& body) {  // nothing but the residual stress is left
    if (body.region().empty()) return;
    body.evaluate(solver_.pressure().data(), settings_.contact_modulus, {});
    body.accept();
  });
  total_ = last_change_ = last_error_ = 0;
  approach_ = solver_.first_touch();
}

void ElasticPlastic::residual_displacement(double* result) const {
  for (std::size_t n = 0; n < grid_.nodes(); ++n) result[n] = present_gap_[n] - gap_[n];
}

ElasticPlastic::State ElasticPlastic::state() const {
  State state{{}, solver_.state(), last_was_force_, last_change_, last_error_, total_, approach_};
  for (std::size_t which = 0; which < bodies_.size(); ++which) {
    if (bodies_[which] != nullptr) state.bodies[which] = bodies_[which]->state();
  }
  return state;
}

void ElasticPlastic::restore(const State& state) {
  for (std::size_t which = 0; which < bodies_.size(); ++which) {
    if (bodies_[which] == nullptr) continue;
    bodies_[which]->restore(*state.bodies[which]);
    bodies_[which]->guess(0);
  }
  displace();
  for (std::size_t which = 0; which < bodies_.size(); ++which) {
    if (bodies_[which] != nullptr) bodies_[which]->restore(*state.bodies[which]);
  }
  solver_.restore(state.contact);
  last_was_force_ = state.last_was_force;
  last_change_ = state.last_change;
  last_error_ = state.last_error;
  total_ = state.total;
  approach_ = state.approach;
}

/// One implicit step to the load, from the state before it; d holds a first guess. Not converged: d is the last
/// iterate, and the rest belongs to it.
PlasticSolution ElasticPlastic::reach(const contact::Load& load, contact::Observer observer,
                                      const TractionRatio& shear) {
  const double least =
      std::min(settings_.tolerance, std::max(kLeastContact, kContactToTolerance * settings_.tolerance));
  const auto shear_on = [&](const PlasticBody& body) {
    return &body == bodies_[1].get() ? TractionRatio{-shear[0], -shear[1]} : shear;
  };
  bool guessed = false;
  for_bodies([&](PlasticBody& body) { guessed = guessed || body.has_increment(); });
  double contact_tolerance = guessed ? std::max(least, kFirstContact) : least;
  PlasticSolution solution;
  std::size_t size = 0;
  auto last = Clock::now();
  while (true) {
    ++solution.iterations;
    displace();
    solution.plastic_seconds += seconds_since(last);
    const contact::Solution contact = solver_.solve(load, contact_tolerance, settings_.max_iterations, observer);
    last = Clock::now();
    solution.contact = contact.after(solution.contact);

    for_bodies([&](PlasticBody& body) {
      if (body.cover(contact_box())) size = 0;
    });
    YieldError error;
    for_bodies([&](PlasticBody& body) {
      const YieldError one = body.evaluate(solver_.pressure().data(), settings_.contact_modulus, shear_on(body));
      error.yield = std::max(error.yield, one.yield);
      error.flow = std::max(error.flow, one.flow);
    });
    bool grown = false;
    for_bodies([&](PlasticBody& body) { grown = body.make_room_for_flow() || grown; });
    solution.yield = error.yield;
    const bool known = !grown && std::isfinite(error.worst());
    solution.converged =
        known && error.worst() <= settings_.tolerance && contact.certificate.worst() <= settings_.tolerance;
    if (solution.converged) {
      for_bodies([&](PlasticBody& body) {
        grown = body.make_room_below(contact_box(), solver_.pressure().data(), settings_.contact_modulus,
                                     shear_on(body)) ||
                grown;
      });
      solution.converged = !grown;
    }
    if (solution.converged || solution.iterations >= kIterations) {
      solution.plastic_seconds += seconds_since(last);
      return solution;
    }
    contact_tolerance = std::clamp(kContactToYield * error.worst(), least, std::max(least, kFirstContact));
    if (grown) {
      size = 0;
      continue;
    }

    std::vector<AndersonPart> parts;
    std::size_t unknowns = 0;
    for_bodies([&](PlasticBody& body) {
      if (body.region().empty()) return;
      parts.push_back(body.unknowns());
      unknowns += parts.back().size;
    });
    if (size != unknowns) {
      anderson_.start(unknowns);
      size = unknowns;
    }
    anderson_.advance(parts);
    for_bodies([](PlasticBody& body) { body.confine(); });
  }
}

double ElasticPlastic::increment_error() const {
  IncrementError error;
  for (const std::unique_ptr<PlasticBody>& body : bodies_) {
    if (body == nullptr || body->region().empty()) continue;
    const IncrementError one = body->increment_error();
    error.squares += one.squares;
    error.cuboids += one.cuboids;
  }
  return error.squares > 0 ? std::sqrt(error.squares / static_cast<double>(error.cuboids)) : 0;
}

/// The part of a change of the load that the error of the last increment lets expect to be within the tolerance, so
/// that a whole number of such parts makes the change.
double ElasticPlastic::part_within_tolerance(double change, bool force) const {
  const bool goes_on = force == last_was_force_ && change * last_change_ > 0 && last_error_ > 0;
  if (!(settings_.increment_tolerance > 0) || !goes_on) return 1;
  const double size =
      std::fabs(last_change_) * std::min(kMostGrowth, factor_within(settings_.increment_tolerance, last_error_));
  return std::max(kLeastPart, 1 / std::ceil(std::fabs(change) / size));
}

PlasticSolution ElasticPlastic::advance(const contact::Load& load, contact::Observer observer,
                                        const TractionRatio& shear) {
  const State before = state();
  const bool force = load.drive == contact::Drive::force;
  const double origin = force ? total_ : approach_;
  PlasticSolution solution;
  solution.substeps = 0;
  solution.converged = true;
  double done = 0, part = part_within_tolerance(load.target - origin, force);  // of the increment
  int halvings = 0;
  try {
    while (done < 1) {
      contact::Load step = load;
      const bool last = done + part >= 1 - 0.5 * kLeastPart;
      if (!last) step.target = origin + (load.target - origin) * (done + part);
      const State start = done > 0 ? state() : State{};
      const double change = step.target - (force ? total_ : approach_);
      const double ratio = last_was_force_ == force && last_change_ != 0 ? change / last_change_ : 0;
      for_bodies([&](PlasticBody& body) { body.guess(std::clamp(ratio, 0.0, kMostExtrapolation)); });
      const PlasticSolution one = reach(step, observer, shear);
      solution.contact = one.contact.after(solution.contact);
      solution.iterations += one.iterations;
      solution.yield = one.yield;
      solution.plastic_seconds += one.plastic_seconds;
      const double error = one.converged ? increment_error() : 0;
      const bool too_large = settings_.increment_tolerance > 0 && error > settings_.increment_tolerance;
      if ((!one.converged && halvings < kHalvings) || (too_large && part > kLeastPart)) {
        restore(done > 0 ? start : before);
        if (one.converged) {
          part *= std::clamp(factor_within(settings_.increment_tolerance, error), kMostDivision, 0.5);
          part = std::max(part, kLeastPart);
        } else {
          part /= 2;
          ++halvings;
        }
        continue;
      }
      solution.converged = solution.converged && one.converged;
      solution.increment_error = std::max(solution.increment_error, error);
      ++solution.substeps;
      done = last ? 1 : done + part;
      for_bodies([&](PlasticBody& body) {
        if (!body.region().empty()) solution.dissipation += (identical_ ? 2 : 1) * body.accept();
      });
      last_was_force_ = force;
      last_change_ = change;
      last_error_ = error;
      total_ = one.contact.total;
      approach_ = one.contact.approach;
      if (settings_.increment_tolerance > 0) {
        const double next = (1 - done) * part_within_tolerance(load.target - step.target, force);
        part = std::clamp(next, kLeastPart, std::ldexp(1.0, -halvings));
      }
    }
    for_bodies([&](PlasticBody& body) {
      if (!body.flow_is_cut_off()) return;
      fail(Status::invalid_scene,
           "plastic strain reaches the last layer of cuboids or the side of the grid: what lies beyond is not known; "
           "give the grid more layers or nodes");
    });
  } catch (...) {
    restore(before);
    throw;
  }
  return solution;
}

}  // namespace brinell::plastic
