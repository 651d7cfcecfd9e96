#include "contact/level.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "influence/displacement.h"

namespace brinell::contact {

namespace {

// A node without pressure enters the contact when it penetrates by more than this fraction of the mean error in
// contact, weighted by the pressure; less may be that error alone, and go with it.
constexpr double kEnterBeyond = 0.5;
// A node leaves the contact when its pressure is below this fraction of what its gap would take to close by itself:
// with none of it, and with seven times as much, the set of nodes is found later.
constexpr double kLeaveBelow = 0.07;
// The preconditioner follows the contact when this fraction of its nodes has changed.
constexpr double kAdaptAfter = 0.02;
// Conjugacy is given up when one iteration changes this fraction of the nodes in contact.
constexpr double kRestartAfter = 0.3;
// The length of the next direction is what the last step would have wanted, within these bounds; where the
// preconditioner were the compliance's inverse it would be one.
constexpr double kShortest = 0.3, kLongest = 1;
// Steps longer than so many directions are taken only if the tension that they cause could displace by no more than
// this fraction of the present error.
constexpr double kLongestStep = 2;
constexpr double kTensionToError = 0.2;
// Iterations without a smaller error until tension is clipped and the displacement made anew: of a few nodes what is
// taken from some may be the others' all.
constexpr int kStalled = 10;
// Iterations without a better certificate until the level is given up: round-off has been reached.
constexpr int kPatience = 150;
// Attempts to find where the factor that makes a pressure meet its moments is positive.
constexpr int kFactorRounds = 40;
// Part of the load by which force and moments may be missed: round-off of a sum over the grid.
constexpr double kBalanced = 1e-13;
// The error is believed down to this fraction of that of the last fresh convolution: what the updates of the
// displacement, in Real, can keep.
template <class Real>
constexpr double kBelieved = 64 * std::numeric_limits<Real>::epsilon();

template <class Real>
std::unique_ptr<Compliance<float>> make_fast(const Resources& resources, const Grid& grid, Boundary boundary) {
  if constexpr (std::is_same_v<Real, double>) {
    return nullptr;
  } else {
    return std::make_unique<Compliance<float>>(resources, grid, boundary);
  }
}

/// The scratch that the iteration's own convolution shares with the preconditioner.
fft::Workspace<double>& workspace_of(const Compliance<double>& exact, const Compliance<float>*, double) {
  return exact.workspace();
}
fft::Workspace<float>& workspace_of(const Compliance<double>&, const Compliance<float>* fast, float) {
  return fast->workspace();
}

}  // namespace

template <class Real>
Level<Real>::Level(const Resources& resources, const Compliance<double>& exact, const PlacedGrid& placed,
                   Boundary boundary, const UndeformedGap& gap, Fields fields)
    : arena_(resources.backend.arena),
      placed_(placed),
      gap_(gap),
      fields_(fields),
      self_compliance_(influence::Displacement(placed.grid.dx, placed.grid.dy)(0, 0)),
      exact_(exact),
      fast_(make_fast<Real>(resources, placed.grid, boundary)),
      preconditioner_(resources, placed.grid, boundary, workspace_of(exact, fast_.get(), Real{})),
      passes_(arena_, resources.backend.kernels, placed),
      v_(placed.grid.nodes()),
      q_(placed.grid.nodes()),
      z_(Buffer<Real>::uninitialised(placed.grid.nodes())) {}

template <class Real>
void Level<Real>::prescribe(const Load& load) {
  load_ = load;
  freedom_ = freedom_of(load);
  approach_ = prescribed_approach(load);
  passes_.tilting(load.tilts());
}

/// On the largest rectangle around the force's point.
template <class Real>
void Level<Real>::add_uniform_pressure() {
  const Grid& grid = placed_.grid;
  const double pressure = load_.target / static_cast<double>(grid.nodes());
  const auto range = [&](double first, double spacing, std::int64_t nodes, double at) {
    const double last = first + static_cast<double>(nodes - 1) * spacing;
    const double reach = load_.moments ? std::max(std::min(at - first, last - at), spacing) : HUGE_VAL;
    return std::pair{std::max(first, at - reach), std::min(last, at + reach)};
  };
  const auto [left, right] = range(placed_.x, grid.dx, grid.nx, load_.force_x);
  const auto [near, far] = range(placed_.y, grid.dy, grid.ny, load_.force_y);
  for (std::int64_t j = 0; j < grid.ny; ++j) {
    const double y = placed_.y + static_cast<double>(j) * grid.dy;
    if (y < near || y > far) continue;
    for (std::int64_t i = 0; i < grid.nx; ++i) {
      const double x = placed_.x + static_cast<double>(i) * grid.dx;
      if (x >= left && x <= right) fields_.p[j * grid.nx + i] += pressure;
    }
  }
}

/// Multiplies the pressure by the factor, linear in the place and zero where that is negative, that meets force and
/// moments: among the multiples of p with these it is the one closest to p, weighted by p. Where all of p is taken
/// the factor is one fit; where not, Newton's method for the part that is. False if p cannot meet them.
template <class Real>
bool Level<Real>::meet_load() {
  const double total = load_.target;
  const PlaneSums wanted{total, total * load_.force_x, total * load_.force_y};
  const Grid& grid = placed_.grid;
  const double right = placed_.x + static_cast<double>(grid.nx - 1) * grid.dx;
  const double far = placed_.y + static_cast<double>(grid.ny - 1) * grid.dy;
  LinearTrend factor{1, 0, 0};
  for (int round = 0; round < kFactorRounds; ++round) {
    const PlaneWeights carried = passes_.carried(factor, fields_.p);
    if (!(carried.one > 0)) return false;
    const PlaneSums met = carried.times(factor);
    const bool balanced =
        std::fabs(met.one - wanted.one) <= kBalanced * total &&
        (!load_.moments || (std::fabs(met.x - wanted.x) <= kBalanced * total * (right - placed_.x + grid.dx) &&
                            std::fabs(met.y - wanted.y) <= kBalanced * total * (far - placed_.y + grid.dy)));
    if (balanced) {
      passes_.clip(factor, fields_.p);
      return true;
    }
    factor = fit(freedom_, carried, wanted, factor, kOnePoint);
  }
  return false;
}

/// Pressure without tension that meets the load, its displacement by a fresh convolution, and all that follows.
template <class Real>
void Level<Real>::refresh(LevelResult& result) {
  if (load_.drive == Drive::approach) {
    passes_.clip({1, 0, 0}, fields_.p);
  } else if (!meet_load()) {
    passes_.open_contact();
    add_uniform_pressure();
    meet_load();
  }
  exact_.apply(fields_.p, fields_.g);
  ++result.convolutions;
  const RefreshTotals fresh = passes_.refresh(gap_, fields_.p, fields_.g);
  sums_ = {fresh.load, fresh.gap, 0};
  const double mean_pressure = fresh.load.one / static_cast<double>(placed_.grid.nodes());
  displacement_ = std::max(fresh.displacement, self_compliance_ * mean_pressure);
}

template <class Real>
PlaneSums Level<Real>::pressure() const {
  return {sums_.load.one, sums_.load.x, sums_.load.y};
}

template <class Real>
Certificate Level<Real>::estimate(const simd::ResidualSums& residual) const {
  return certificate_of({pressure(), displacement_, residual.depth, residual.complementarity,
                         self_compliance_ * std::max(0.0, sums_.tension)},
                        load_, placed_.grid);
}

/// z, preconditioned, becomes part of the next direction.
template <class Real>
simd::SlopeSums Level<Real>::redirect(double beta, const LinearTrend& trend_v, double scale,
                                      const LinearTrend& trend_z) {
  const DirectionTotals next = passes_.redirect(beta, trend_v, scale, trend_z, fields_.p, z_.data(), v_.data());
  LinearTrend shift;
  if (freedom_ != Freedom::none && next.free.one > 0) {
    const PlaneSums missing{load_.target - next.load.one, load_.target * load_.force_x - next.load.x,
                            load_.target * load_.force_y - next.load.y};
    shift = fit(freedom_, next.free, missing, {}, kOnePoint);
  }
  return passes_.balance(shift, approach_, fields_.p, fields_.g, v_.data());
}

template <class Real>
void Level<Real>::correct_start(const Load& load) {
  prescribe(load);
  passes_.open_contact();
  const RefreshTotals start = passes_.refresh(gap_, fields_.p, fields_.g);
  if (!(start.load.one > 0)) return;
  approach_ = fit(freedom_, start.load, start.gap, approach_, kOnePoint);
  passes_.residual(approach_, 0, 0, fields_.p, fields_.g, z_.data());
  preconditioner_.apply_local(z_.data());
  const CorrelationTotals sums = passes_.correlate(z_.data(), v_.data(), q_.data());
  redirect(0, {}, 1, fit(freedom_, sums.active, sums.z, {}, kOnePoint));
  passes_.advance(1, fields_.p, v_.data(), fields_.g, v_.data());  // the displacement is made anew from this pressure
}

template <class Real>
LevelResult Level<Real>::solve(const Load& load, double tolerance, std::int32_t max_iterations, Observer observer) {
  LevelResult result;
  prescribe(load);
  passes_.open_contact();
  refresh(result);
  preconditioner_.treat_large_scales(true);

  const double stiffness = kLeaveBelow / self_compliance_;
  bool fresh = true;
  bool adapted = false;
  bool conjugate = false;
  bool preconditioned = true;
  int idle = 0;     // iterations without a better certificate,
  int stalled = 0;  // or without a smaller error since the last fresh convolution
  double least_error = 0;
  double since_adapted = 0;  // nodes that entered or left since the preconditioner was adapted
  double length = kLongest;
  double best = std::numeric_limits<double>::infinity();
  double fresh_error = best;  // as of the last fresh convolution
  double noise = 0;           // penetration that does not count

  while (true) {
    if (sums_.load.one > 0) approach_ = fit(freedom_, sums_.load, sums_.gap, approach_, kOnePoint);
    simd::ResidualSums residual = passes_.residual(approach_, noise, stiffness, fields_.p, fields_.g, z_.data());
    noise = sums_.load.one > 0 ? kEnterBeyond * residual.complementarity / sums_.load.one : 0;
    const Certificate certificate = estimate(residual);
    if (!observer({placed_.grid, result.iterations, fresh, certificate.worst()})) {
      fail(Status::cancelled, "the progress callback asked to stop");
    }
    if (fresh) {
      result.approach = approach_;
      result.total = sums_.load.one;
      result.certificate = certificate;
      result.converged = certificate.worst() <= tolerance;
      fresh_error = least_error = certificate.worst();
      stalled = 0;
      ++idle;
      if (certificate.worst() < best) {
        best = certificate.worst();
        idle = 0;
      }
      if (result.converged || idle > kPatience || result.iterations >= max_iterations || residual.occupied == 0)
        return result;
    } else {
      const double error = std::max({certificate.penetration, certificate.complementarity, certificate.tension});
      const bool outgrown = certificate.penetration >= 1;  // the displacement that it is relative to, by far
      stalled = error < least_error ? 0 : stalled + 1;
      least_error = std::min(least_error, error);
      if (outgrown || stalled > kStalled || idle > kPatience ||
          error <= std::max(tolerance, kBelieved<Real> * fresh_error) || result.iterations >= max_iterations) {
        refresh(result);
        fresh = true;
        continue;
      }
    }

    since_adapted += residual.changed;
    if (preconditioned && (!adapted || since_adapted > kAdaptAfter * residual.active)) {
      preconditioner_.adapt(passes_, z_.data());
      passes_.residual(approach_, noise, stiffness, fields_.p, fields_.g, z_.data());
      adapted = true;
      since_adapted = 0;
    }
    if (preconditioned) preconditioner_.apply(z_.data());

    const CorrelationTotals sums = passes_.correlate(z_.data(), v_.data(), q_.data());
    const LinearTrend trend_z = fit(freedom_, sums.active, sums.z, {}, kOnePoint);
    const LinearTrend trend_v = fit(freedom_, sums.active, sums.v, {}, kOnePoint);
    const double curvature_before = sums.vq - dot(trend_v, sums.q);
    const double scale = preconditioned ? length : 1 / self_compliance_;
    double beta = 0;
    if (conjugate && residual.changed <= kRestartAfter * residual.active && curvature_before > 0) {
      beta = scale * std::max(0.0, (sums.zq - dot(trend_z, sums.q)) / curvature_before);
    }
    simd::SlopeSums slope = redirect(beta, trend_v, scale, trend_z);
    if (!(slope.free < 0) && beta > 0) slope = redirect(0, {}, scale, trend_z);
    const bool mostly_taken = std::fabs(slope.free) < slope.taken;

    double step = 0;
    if (slope.free < 0 || mostly_taken) {
      if constexpr (std::is_same_v<Real, float>) {
        fast_->apply(v_.data(), q_.data());
      } else {
        exact_.apply(v_.data(), q_.data());
      }
      ++result.convolutions;
      const double curvature = passes_.curvature(fields_.p, v_.data(), q_.data());
      if (curvature > 0) step = -slope.free / curvature;
      if (mostly_taken) step = 1;
    }
    ++result.iterations;
    ++idle;
    conjugate = step > 0;
    length = std::clamp(length * step, kShortest, kLongest);
    sums_ = passes_.advance(step, fields_.p, v_.data(), fields_.g, q_.data());
    if (step > kLongestStep &&
        self_compliance_ * sums_.tension > kTensionToError * certificate.worst() * displacement_) {
      sums_ = passes_.advance(kLongestStep - step, fields_.p, v_.data(), fields_.g, q_.data());
    }
    fresh = false;
    if (step == 0) {  // a lone node, a residual at round-off, or no way down
      preconditioned = preconditioned && preconditioner_.treats_large_scales();
      preconditioner_.treat_large_scales(false);
      refresh(result);
      fresh = true;
    }
  }
}

template <class Real>
std::size_t Level<Real>::bytes(const fft::Backend& backend, const Grid& grid, Boundary boundary) {
  std::size_t bytes = Preconditioner<Real>::bytes(backend, grid) + Passes<Real>::bytes(grid) +
                      3 * Buffer<Real>::padded_bytes(grid.nodes());
  if constexpr (std::is_same_v<Real, float>) bytes += Compliance<float>::bytes(backend, grid, boundary);
  return bytes;
}

template class Level<double>;
template class Level<float>;

}  // namespace brinell::contact
