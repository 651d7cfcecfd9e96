// Fused passes of the contact solver over one block of nodes. Pressure p and gap g are double; direction v, its
// displacement q and the residual z are Real. A node is active, that is in contact, where p > 0; p < 0 is tension
// that waits to be clipped, p = 0 is out of contact.
#pragma once

#include <cstddef>

namespace brinell::simd {

struct AdvanceSums {
  double active = 0;   // number of active nodes
  double gap = 0;      // Σ g over them
  double min_gap = 0;  // over the block
  double tension = 0;  // largest −p, or 0
};

struct ResidualSums {
  double active = 0;
  double entered = 0;          // nodes that this pass put into contact
  double complementarity = 0;  // Σ |p (g − approach)|
  double barred = 0;           // largest approach − g of nodes that cannot enter before their tension is clipped
};

struct DirectionSums {
  double z = 0, q = 0, v = 0;  // Σ over active nodes
  double zq = 0, vq = 0;
};

struct RefreshSums {
  double active = 0;
  double gap = 0;           // Σ g over active nodes
  double min_gap = 0;       // over the block
  double displacement = 0;  // largest |u|
  double energy = 0;        // Σ p (u/2 + scale·(h − origin))
};

template <class Real>
struct ContactKernels {
  /// p += step·v, g += step·q.
  void (*advance)(std::size_t n, double step, double* p, const Real* v, double* g, const Real* q, AdvanceSums* sums);

  /// p = seed where p = 0 and g < approach; then z = g − approach where active, else 0.
  void (*residual)(std::size_t n, double approach, double seed, double* p, const double* g, Real* z,
                   ResidualSums* sums);

  /// Sums that give the next direction.
  void (*correlate)(std::size_t n, const double* p, const Real* z, const Real* v, const Real* q, DirectionSums* sums);

  /// v = beta·(v − mean_v) − (z − mean_z) where active, else 0. Returns Σ v (g − approach).
  double (*redirect)(std::size_t n, double beta, double mean_v, double mean_z, double approach, const double* p,
                     const double* g, const Real* z, Real* v);

  /// Σ a·b.
  double (*dot)(std::size_t n, const Real* a, const Real* b);

  /// p = max(p, 0)·factor; returns Σ p.
  double (*clip)(std::size_t n, double factor, double* p);

  /// On entry g holds the displacement u of p; g = u + scale·(h − origin).
  void (*refresh)(std::size_t n, double scale, double origin, const double* h, const double* p, double* g,
                  RefreshSums* sums);

  /// z = 1 where active, else 0.
  void (*indicator)(std::size_t n, const double* p, Real* z);

  /// w = z where active and z > 0, else 0.
  void (*conductance)(std::size_t n, const double* p, const Real* z, float* w);

  /// Σ w·z.
  double (*weigh)(std::size_t n, const float* w, const Real* z);

  /// z −= t·w.
  void (*relax)(std::size_t n, double t, const float* w, Real* z);

  /// p = max(p − (z − mean_z), 0) where active; returns Σ p.
  double (*correct)(std::size_t n, double mean_z, double* p, const Real* z);
};

}  // namespace brinell::simd
