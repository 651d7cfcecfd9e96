// Fused passes of the contact solver over one block of nodes. Pressure p and gap g are double; direction v, its
// displacement q and the residual z are Real. A node is active, that is in contact, where p > 0; p < 0 is tension
// that waits to be clipped, p = 0 is out of contact.
//
// There are two sets of them. Where the bodies may tilt, a block is a stretch of one row, what is taken off is linear
// along it, and sums come with their first and second moments. The other set takes constants and leaves the moments
// out.
#pragma once

#include <cstddef>

namespace brinell::simd {

/// Nodes of a block at most, where the bodies may tilt.
constexpr std::size_t kLongestStretch = 512;

/// value + slope·i at node i of the block; the slope is read where the bodies may tilt.
struct Line {
  double value = 0;
  double slope = 0;
};

/// Σ s and Σ s x.
struct LinearSums {
  double one = 0, x = 0;
};

/// Σ s, Σ s x and Σ s x².
struct QuadraticSums {
  double one = 0, x = 0, xx = 0;
};

struct AdvanceSums {
  double active = 0;   // number of active nodes
  QuadraticSums load;  // of p over them
  LinearSums gap;      // of p g over them
  double tension = 0;  // largest −p, or 0
};

struct ResidualSums {
  double active = 0;
  double entered = 0;          // nodes that this pass put into contact
  double complementarity = 0;  // Σ |p (g − approach)|
  double barred = 0;           // largest approach − g of nodes that cannot enter before their tension is clipped
  double depth = 0;            // largest approach − g, or 0
};

struct DirectionSums {
  QuadraticSums active;  // of 1 over active nodes
  LinearSums z, q, v;    // over active nodes
  double zq = 0, vq = 0;
};

struct RefreshSums {
  double active = 0;
  QuadraticSums load;       // of p over active nodes
  LinearSums gap;           // of p g over active nodes
  double displacement = 0;  // largest |u|
  double energy = 0;        // Σ p (u/2 + scale·(h − origin))
};

template <class Real>
struct ContactKernels {
  /// p += step·v, g += step·q.
  void (*advance)(std::size_t n, Line x, double step, double* p, const Real* v, double* g, const Real* q,
                  AdvanceSums* sums);

  /// p = seed where p = 0 and g < approach − noise; then z = g − approach where active, else 0.
  void (*residual)(std::size_t n, Line approach, double noise, double seed, double* p, const double* g, Real* z,
                   ResidualSums* sums);

  /// Sums that give the next direction.
  void (*correlate)(std::size_t n, Line x, const double* p, const Real* z, const Real* v, const Real* q,
                    DirectionSums* sums);

  /// v = beta·(v − trend_v) − (z − trend_z) where active, else 0. Returns Σ v (g − approach).
  double (*redirect)(std::size_t n, double beta, Line trend_v, Line trend_z, Line approach, const double* p,
                     const double* g, const Real* z, Real* v);

  /// Σ a·b.
  double (*dot)(std::size_t n, const Real* a, const Real* b);

  /// Sums of p over nodes where p and factor are positive.
  QuadraticSums (*carried)(std::size_t n, Line x, Line factor, const double* p);

  /// p = max(p, 0)·max(factor, 0).
  void (*clip)(std::size_t n, Line factor, double* p);

  /// On entry g holds the displacement u of p; g = u + scale·(h − origin).
  void (*refresh)(std::size_t n, Line x, double scale, double origin, const double* h, const double* p, double* g,
                  RefreshSums* sums);

  /// z = 1 where active, else 0.
  void (*indicator)(std::size_t n, const double* p, Real* z);

  /// w = z where active and z > 0, else 0.
  void (*conductance)(std::size_t n, const double* p, const Real* z, float* w);

  /// Σ w·z.
  double (*weigh)(std::size_t n, const float* w, const Real* z);

  /// z −= t·w.
  void (*relax)(std::size_t n, double t, const float* w, Real* z);

  /// p = max(p − (z − trend_z), 0) where active.
  void (*correct)(std::size_t n, Line trend_z, double* p, const Real* z);
};

}  // namespace brinell::simd
