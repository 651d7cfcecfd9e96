#include "contact/level.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "influence/displacement.h"

namespace brinell::contact {

namespace {

// A node that enters the contact gets this fraction of the mean pressure: in contact, but without effect.
constexpr double kSeed = 1e-30;
// Tension is clipped when the displacement that it could cause exceeds this fraction of the present error.
constexpr double kTensionToError = 0.2;
// Errors above this are all the same: the set of nodes in contact is not yet known.
constexpr double kLargeError = 0.05;
// The preconditioner follows the contact when this fraction of its nodes has changed.
constexpr double kAdaptAfter = 0.02;
// Conjugacy is given up when one iteration changes this fraction of the nodes in contact.
constexpr double kRestartAfter = 0.05;
// Rises of the energy, each after a fresh convolution, until a part of the preconditioner is given up.
constexpr int kRises = 3;
// Iterations without a better certificate until the level is given up: round-off has been reached.
constexpr int kPatience = 150;
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
Level<Real>::Level(const Resources& resources, const Compliance<double>& exact, const Grid& grid, Boundary boundary,
                   const UndeformedGap& gap, Fields fields)
    : arena_(resources.backend.arena),
      grid_(grid),
      gap_(gap),
      fields_(fields),
      self_compliance_(influence::Displacement(grid.dx, grid.dy)(0, 0)),
      exact_(exact),
      fast_(make_fast<Real>(resources, grid, boundary)),
      preconditioner_(resources, grid, boundary, workspace_of(exact, fast_.get(), Real{})),
      passes_(arena_, resources.backend.kernels, grid.nodes()),
      v_(grid.nodes()),
      q_(grid.nodes()),
      z_(Buffer<Real>::uninitialised(grid.nodes())) {}

/// Clipped and rescaled pressure, its displacement by a fresh convolution, and all that follows from them.
template <class Real>
void Level<Real>::refresh(LevelResult& result) {
  total_ = passes_.clip(1, fields_.p);
  if (drive_ == Drive::force && total_ != target_) total_ = passes_.clip(target_ / total_, fields_.p);
  exact_.apply(fields_.p, fields_.g);
  ++result.convolutions;
  const simd::RefreshSums fresh = passes_.refresh(gap_, fields_.p, fields_.g);
  sums_ = {fresh.active, fresh.gap, fresh.min_gap, 0};
  const double mean_pressure = total_ / static_cast<double>(grid_.nodes());
  displacement_ = std::max(fresh.displacement, self_compliance_ * mean_pressure);
  energy_ = fresh.energy - (drive_ == Drive::approach ? target_ * total_ : 0);
}

template <class Real>
Certificate Level<Real>::estimate(double complementarity) const {
  return certificate_of({approach_, total_, displacement_, sums_.min_gap, complementarity,
                         self_compliance_ * std::max(0.0, sums_.tension)},
                        drive_, target_);
}

template <class Real>
void Level<Real>::correct_start(Drive drive, double target) {
  const simd::RefreshSums start = passes_.refresh(gap_, fields_.p, fields_.g);
  if (start.active == 0) return;
  const double approach = drive == Drive::force ? start.gap / start.active : target;
  passes_.residual(approach, 0, fields_.p, fields_.g, z_.data());
  preconditioner_.apply_local(z_.data());
  const double mean = drive == Drive::force ? passes_.sum(fields_.p, z_.data()) / start.active : 0;
  passes_.correct(mean, fields_.p, z_.data());
}

template <class Real>
LevelResult Level<Real>::solve(Drive drive, double target, double tolerance, std::int32_t max_iterations,
                               Observer observer) {
  LevelResult result;
  drive_ = drive;
  target_ = target;
  const double nodes = static_cast<double>(grid_.nodes());
  if (drive == Drive::force && !(passes_.clip(1, fields_.p) > 0)) {
    std::fill_n(fields_.p, grid_.nodes(), target / nodes);
  }
  refresh(result);
  preconditioner_.treat_large_scales(true);

  bool fresh = true;
  bool adapted = false;
  bool conjugate = false;
  bool preconditioned = true;
  int rises = 0;
  int idle = 0;
  double changed = 0;        // nodes that entered or left since the last direction
  double since_adapted = 0;  // and since the preconditioner was adapted
  double last_energy = std::numeric_limits<double>::infinity();
  double best = std::numeric_limits<double>::infinity();
  double fresh_error = best;  // as of the last fresh convolution
  double in_contact = sums_.active;

  while (true) {
    if (drive == Drive::approach || sums_.active > 0) {
      approach_ = drive == Drive::force ? sums_.gap / sums_.active : target;
    }
    const double seed = kSeed * std::max(total_ / nodes, std::numeric_limits<double>::min() / kSeed);
    simd::ResidualSums residual = passes_.residual(approach_, seed, fields_.p, fields_.g, z_.data());
    changed += residual.entered + std::max(0.0, in_contact - sums_.active);
    in_contact = residual.active;

    const Certificate certificate = estimate(residual.complementarity);
    if (!observer({grid_, result.iterations, fresh, certificate.worst()})) {
      fail(Status::cancelled, "the progress callback asked to stop");
    }
    if (fresh) {
      result.approach = approach_;
      result.total = total_;
      result.certificate = certificate;
      result.converged = certificate.worst() <= tolerance;
      fresh_error = certificate.worst();
      ++idle;
      if (certificate.worst() < best) {
        best = certificate.worst();
        idle = 0;
      }
      if (result.converged || idle > kPatience || result.iterations >= max_iterations || in_contact == 0)
        return result;
    } else {
      const double error = std::max(certificate.penetration, certificate.complementarity);
      const double allowed = kTensionToError * std::min(error, kLargeError);
      const bool outgrown = certificate.penetration >= 1;  // the displacement that it is relative to, by far
      const bool overdue = outgrown || certificate.tension > allowed || idle > kPatience ||
                           error <= std::max(tolerance, kBelieved<Real> * fresh_error) ||
                           residual.barred > allowed * displacement_;
      if (overdue || result.iterations >= max_iterations) {
        refresh(result);
        fresh = true;
        if (energy_ > last_energy + 1e-12 * std::fabs(last_energy) && error > 1e2 * tolerance) {
          conjugate = false;
          if (++rises % kRises == 0) {
            preconditioned = rises < 2 * kRises;
            preconditioner_.treat_large_scales(false);
          }
        }
        last_energy = energy_;
        continue;
      }
    }

    since_adapted += changed;
    if (preconditioned && (!adapted || since_adapted > kAdaptAfter * in_contact)) {
      preconditioner_.adapt(passes_, fields_.p, z_.data());
      residual = passes_.residual(approach_, seed, fields_.p, fields_.g, z_.data());
      adapted = true;
      since_adapted = 0;
    }
    if (preconditioned) preconditioner_.apply(z_.data());

    const simd::DirectionSums sums = passes_.correlate(fields_.p, z_.data(), v_.data(), q_.data());
    const double mean_z = drive == Drive::force ? sums.z / in_contact : 0;
    const double mean_v = drive == Drive::force ? sums.v / in_contact : 0;
    const double curvature_before = sums.vq - mean_v * sums.q;
    double beta = 0;
    if (conjugate && changed <= kRestartAfter * in_contact && curvature_before > 0) {
      beta = std::max(0.0, (sums.zq - mean_z * sums.q) / curvature_before);
    }
    double slope = passes_.redirect(beta, mean_v, mean_z, approach_, fields_.p, fields_.g, z_.data(), v_.data());
    if (!(slope < 0) && beta > 0) {
      slope = passes_.redirect(0, 0, mean_z, approach_, fields_.p, fields_.g, z_.data(), v_.data());
    }

    changed = 0;

    double step = 0;
    if (slope < 0) {
      if constexpr (std::is_same_v<Real, float>) {
        fast_->apply(v_.data(), q_.data());
      } else {
        exact_.apply(v_.data(), q_.data());
      }
      ++result.convolutions;
      const double curvature = passes_.dot(v_.data(), q_.data());
      if (curvature > 0) step = -slope / curvature;
    }
    ++result.iterations;
    ++idle;
    conjugate = step > 0;
    sums_ = passes_.advance(step, fields_.p, v_.data(), fields_.g, q_.data());
    fresh = false;
    if (step == 0) {  // a lone node, or a residual at round-off: only the entering nodes can change anything
      refresh(result);
      fresh = true;
    }
  }
}

template <class Real>
std::size_t Level<Real>::bytes(const fft::Backend& backend, const Grid& grid, Boundary boundary) {
  std::size_t bytes = Preconditioner<Real>::bytes(backend, grid) + 3 * Buffer<Real>::padded_bytes(grid.nodes());
  if constexpr (std::is_same_v<Real, float>) bytes += Compliance<float>::bytes(backend, grid, boundary);
  return bytes;
}

template class Level<double>;
template class Level<float>;

}  // namespace brinell::contact
