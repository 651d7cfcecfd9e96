// The constrained problem of normal contact, and the words in which its solution is certified.
//
//   p >= 0,   gap + K p − approach >= 0,   p · (gap + K p − approach) = 0
//
// with either the approach prescribed, or Σ p (then the approach follows). The bodies may be tilted against each
// other: then the approach is linear in the place, approach − sx·x − sy·y, with the slopes prescribed, or following
// from the point at which the force acts. Everything in this room is free of units: lengths in units of the finest
// grid's dx, pressures in units of the contact modulus E*, so that a change of units changes nothing.
#pragma once

#include <cstdint>

#include "base/function_ref.h"
#include "base/grid.h"
#include "fft/convolution.h"
#include "influence/spectrum_cache.h"

namespace brinell::contact {

/// What an engine lends to its solvers; all of it outlives them.
struct Resources {
  fft::Backend backend;
  influence::SpectrumCache& spectra;
};

/// The gap h = scale·(values − origin) of the undeformed surfaces, in unit lengths. Measured from where they first
/// touch, it keeps its digits where it matters, however far away its values have their zero.
struct UndeformedGap {
  const double* values;  // one per node [m]
  double scale;          // [1/m]
  double origin;         // [m]
};

enum class Drive : std::int32_t { force, approach };

/// What is prescribed. The slopes are those of the plane sx·x + sy·y that is added to the gap. With moments a force
/// acts at a point, and the slopes follow; it must lie within the hull of the nodes.
struct Load {
  Drive drive = Drive::force;
  double target = 0;
  double slope_x = 0, slope_y = 0;  // prescribed; ignored with moments
  bool moments = false;
  double force_x = 0, force_y = 0;  // where the force acts; read with moments

  bool tilts() const { return moments || slope_x != 0 || slope_y != 0; }
};

/// A grid, or part of one, and the place of its first node, in unit lengths from the centre of the whole grid.
struct PlacedGrid {
  Grid grid;
  double x = 0, y = 0;

  static PlacedGrid centred(const Grid& grid) { return {grid, grid.x(0), grid.y(0)}; }
};

struct Settings {
  double tolerance = 1e-8;             // on the certificate
  std::int32_t max_iterations = 2000;  // on the full grid
  bool mixed_precision = false;        // directions and their displacements in single precision
};

/// How far a state is from a solution; every entry relative. The largest displacement counts at least as what the
/// mean pressure causes where it acts on one cell: it is more on a free boundary, but may vanish on a periodic one.
struct Certificate {
  double penetration = 0;      // largest interpenetration / largest displacement
  double complementarity = 0;  // Σ p |deformed gap| / (Σ p · largest displacement)
  double tension = 0;          // displacement that the largest tensile pressure causes / largest displacement
  double balance = 0;  // of the force, |Σ p − prescribed| / prescribed, and of its moments, relative to the
                       // force times half the grid: the worst of them

  double worst() const;
};

/// Told after every iteration.
struct Report {
  const Grid& grid;  // unit lengths
  std::int32_t iteration;
  bool certified;  // the certificate was recomputed with a fresh convolution
  double certificate;
};

/// Returns false to stop: the solver then throws Status::cancelled.
using Observer = FunctionRef<bool(const Report&)>;

}  // namespace brinell::contact
