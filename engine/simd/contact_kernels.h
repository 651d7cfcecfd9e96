// Fused passes of the contact solver over one block of nodes. Pressure p and gap g are double; direction v, its
// displacement q and the residual z are Real; contact is 1 at the nodes that are in contact, else 0. Among these,
// those are free that the direction does not take all their pressure from: v > −p.
//
// There are two sets of them. Where the bodies may tilt, a block is a stretch of one row, what is taken off is linear
// along it, and sums come with their first and second moments. The other set takes constants and leaves the moments
// out.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brinell::simd {

/// Nodes of a block at most.
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
  QuadraticSums load;  // of p where positive
  LinearSums gap;      // of p g where p is positive
  double tension = 0;  // largest −p, or 0
};

struct ResidualSums {
  double active = 0;           // nodes in contact
  double occupied = 0;         // nodes in contact or with pressure
  double changed = 0;          // nodes that this pass put into contact or took out
  double complementarity = 0;  // Σ |p (g − approach)|
  double depth = 0;            // largest approach − g, or 0
};

struct CorrelationSums {
  QuadraticSums active;  // of 1 over nodes in contact
  LinearSums z, q, v;    // over nodes in contact
  double zq = 0, vq = 0;
};

struct DirectionSums {
  LinearSums load;     // of p + v
  QuadraticSums free;  // of 1 over free nodes
};

struct SlopeSums {
  double free = 0;   // Σ v (g − approach) over free nodes
  double taken = 0;  // Σ |v (g − approach)| over the others
};

struct RefreshSums {
  QuadraticSums load;       // of p where positive
  LinearSums gap;           // of p g where p is positive
  double displacement = 0;  // largest |u|
};

template <class Real>
struct ContactKernels {
  /// p += step·v, g += step·q.
  void (*advance)(std::size_t n, Line x, double step, double* p, const Real* v, double* g, const Real* q,
                  AdvanceSums* sums);

  /// In contact is where p > stiffness·r, r = g − approach, to which noise is added where there is no pressure;
  /// z = r in contact, else 0.
  void (*residual)(std::size_t n, Line approach, double noise, double stiffness, const double* p, const double* g,
                   std::uint8_t* contact, Real* z, ResidualSums* sums);

  /// Sums that give the next direction.
  void (*correlate)(std::size_t n, Line x, const std::uint8_t* contact, const Real* z, const Real* v, const Real* q,
                    CorrelationSums* sums);

  /// v = max(beta·(v − trend_v) − scale·(z − trend_z), −p) in contact, else −p.
  void (*redirect)(std::size_t n, Line x, double beta, Line trend_v, double scale, Line trend_z,
                   const std::uint8_t* contact, const double* p, const Real* z, Real* v, DirectionSums* sums);

  /// v = max(v + shift, −p) where free; the sums are over what is free then.
  SlopeSums (*balance)(std::size_t n, Line shift, Line approach, const std::uint8_t* contact, const double* p,
                       const double* g, Real* v);

  /// Σ v·q over free nodes.
  double (*curvature)(std::size_t n, const std::uint8_t* contact, const double* p, const Real* v, const Real* q);

  /// Sums of p over nodes in contact where p and factor are positive.
  QuadraticSums (*carried)(std::size_t n, Line x, Line factor, const std::uint8_t* contact, const double* p);

  /// p = max(p, 0)·max(factor, 0) in contact, else 0.
  void (*clip)(std::size_t n, Line factor, const std::uint8_t* contact, double* p);

  /// On entry g holds the displacement u of p; g = u + scale·(h − origin).
  void (*refresh)(std::size_t n, Line x, double scale, double origin, const double* h, const double* p, double* g,
                  RefreshSums* sums);

  /// z = contact.
  void (*indicator)(std::size_t n, const std::uint8_t* contact, Real* z);

  /// w = z in contact where z > 0, else 0.
  void (*conductance)(std::size_t n, const std::uint8_t* contact, const Real* z, float* w);

  /// Σ w·z.
  double (*weigh)(std::size_t n, const float* w, const Real* z);

  /// z −= t·w.
  void (*relax)(std::size_t n, double t, const float* w, Real* z);
};

}  // namespace brinell::simd
