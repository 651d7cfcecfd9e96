// Passes of the contact solver. They are bound by memory, not by arithmetic: plain loops that the compiler vectorises
// for the instruction set of the including source, with the reductions' reordering allowed by `omp simd`.
#pragma once

#include <cmath>
#include <cstdint>

#include "simd/contact_kernels.h"

namespace brinell::simd {
namespace {

// 0, 1, 2, ...: loading it costs less than converting the index, which makes the compiler pack two registers as well.
struct Indices {
  alignas(64) double value[kLongestStretch];
};
constexpr Indices kIndices = [] {
  Indices indices{};
  for (std::size_t i = 0; i < kLongestStretch; ++i) indices.value[i] = static_cast<double>(i);
  return indices;
}();

template <class Arch, class Real, bool kTilts>
struct ContactPasses {
  static double at(Line line, std::size_t i) {
    if constexpr (kTilts) {
      return line.value + line.slope * kIndices.value[i];
    } else {
      return line.value;
    }
  }

  static void advance(std::size_t n, Line x, double step, double* __restrict p, const Real* __restrict v,
                      double* __restrict g, const Real* __restrict q, AdvanceSums* sums) {
    double active = 0, load = 0, load_x = 0, load_xx = 0, gap = 0, gap_x = 0, min_pressure = 0;
#pragma omp simd reduction(+ : active, load, load_x, load_xx, gap, gap_x) reduction(min : min_pressure)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] + step * static_cast<double>(v[i]);
      const double deformed = g[i] + step * static_cast<double>(q[i]);
      p[i] = pressure;
      g[i] = deformed;
      active += pressure > 0 ? 1.0 : 0.0;
      const double carried = pressure > 0 ? pressure : 0.0;
      load += carried;
      gap += carried * deformed;
      if constexpr (kTilts) {
        const double moment = carried * at(x, i);
        load_x += moment;
        load_xx += moment * at(x, i);
        gap_x += moment * deformed;
      }
      min_pressure = pressure < min_pressure ? pressure : min_pressure;
    }
    *sums = {active, {load, load_x, load_xx}, {gap, gap_x}, -min_pressure};
  }

  static void residual(std::size_t n, Line approach, double noise, double seed, double* __restrict p,
                       const double* __restrict g, Real* __restrict z, ResidualSums* sums) {
    double active = 0, entered = 0, complementarity = 0, barred = 0, deepest = 0;
#pragma omp simd reduction(+ : active, entered, complementarity) reduction(max : barred, deepest)
    for (std::size_t i = 0; i < n; ++i) {
      const double r = g[i] - at(approach, i);
      const double before = p[i];
      const bool enters = static_cast<int>(before == 0) & static_cast<int>(r < -noise);
      const double pressure = enters ? seed : before;
      p[i] = pressure;
      entered += enters ? 1.0 : 0.0;
      active += pressure > 0 ? 1.0 : 0.0;
      complementarity += std::fabs(pressure * r);
      const double depth = -r;
      deepest = depth > deepest ? depth : deepest;
      const double held = before < 0 ? depth : 0.0;
      barred = held > barred ? held : barred;
      z[i] = static_cast<Real>(pressure > 0 ? r : 0.0);
    }
    *sums = {active, entered, complementarity, barred, deepest};
  }

  static void correlate(std::size_t n, Line x, const double* __restrict p, const Real* __restrict z,
                        const Real* __restrict v, const Real* __restrict q, DirectionSums* sums) {
    double active = 0, active_x = 0, active_xx = 0, sz = 0, sz_x = 0, sq = 0, sq_x = 0, sv = 0, sv_x = 0, zq = 0,
           vq = 0;
#pragma omp simd reduction(+ : active, active_x, active_xx, sz, sz_x, sq, sq_x, sv, sv_x, zq, vq)
    for (std::size_t i = 0; i < n; ++i) {
      const double on = p[i] > 0 ? 1.0 : 0.0;
      const double zi = on * static_cast<double>(z[i]);
      const double vi = on * static_cast<double>(v[i]);
      const double qi = static_cast<double>(q[i]);
      active += on;
      sz += zi;
      sv += vi;
      sq += on * qi;
      zq += zi * qi;
      vq += vi * qi;
      if constexpr (kTilts) {
        const double xi = at(x, i);
        active_x += on * xi;
        active_xx += on * xi * xi;
        sz_x += zi * xi;
        sv_x += vi * xi;
        sq_x += on * qi * xi;
      }
    }
    *sums = {{active, active_x, active_xx}, {sz, sz_x}, {sq, sq_x}, {sv, sv_x}, zq, vq};
  }

  static double redirect(std::size_t n, double beta, Line trend_v, Line trend_z, Line approach,
                         const double* __restrict p, const double* __restrict g, const Real* __restrict z,
                         Real* __restrict v) {
    double slope = 0;
#pragma omp simd reduction(+ : slope)
    for (std::size_t i = 0; i < n; ++i) {
      const double along =
          beta * (static_cast<double>(v[i]) - at(trend_v, i)) - (static_cast<double>(z[i]) - at(trend_z, i));
      const Real direction = static_cast<Real>(p[i] > 0 ? along : 0.0);
      v[i] = direction;
      slope += static_cast<double>(direction) * (g[i] - at(approach, i));
    }
    return slope;
  }

  static double dot(std::size_t n, const Real* __restrict a, const Real* __restrict b) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
  }

  static QuadraticSums carried(std::size_t n, Line x, Line factor, const double* __restrict p) {
    double load = 0, load_x = 0, load_xx = 0;
#pragma omp simd reduction(+ : load, load_x, load_xx)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] > 0 ? p[i] : 0.0;
      const double carried = at(factor, i) > 0 ? pressure : 0.0;
      load += carried;
      if constexpr (kTilts) {
        const double moment = carried * at(x, i);
        load_x += moment;
        load_xx += moment * at(x, i);
      }
    }
    return {load, load_x, load_xx};
  }

  static void clip(std::size_t n, Line factor, double* __restrict p) {
    for (std::size_t i = 0; i < n; ++i) {
      const double scale = at(factor, i) > 0 ? at(factor, i) : 0.0;
      p[i] = p[i] > 0 ? p[i] * scale : 0.0;
    }
  }

  static void refresh(std::size_t n, Line x, double scale, double origin, const double* __restrict h,
                      const double* __restrict p, double* __restrict g, RefreshSums* sums) {
    double active = 0, load = 0, load_x = 0, load_xx = 0, gap = 0, gap_x = 0, displacement = 0, energy = 0;
#pragma omp simd reduction(+ : active, load, load_x, load_xx, gap, gap_x, energy) reduction(max : displacement)
    for (std::size_t i = 0; i < n; ++i) {
      const double u = g[i];
      const double undeformed = scale * (h[i] - origin);
      const double deformed = undeformed + u;
      const double magnitude = std::fabs(u);
      g[i] = deformed;
      active += p[i] > 0 ? 1.0 : 0.0;
      const double carried = p[i] > 0 ? p[i] : 0.0;
      load += carried;
      gap += carried * deformed;
      if constexpr (kTilts) {
        const double moment = carried * at(x, i);
        load_x += moment;
        load_xx += moment * at(x, i);
        gap_x += moment * deformed;
      }
      displacement = magnitude > displacement ? magnitude : displacement;
      energy += p[i] * (0.5 * u + undeformed);
    }
    *sums = {active, {load, load_x, load_xx}, {gap, gap_x}, displacement, energy};
  }

  static void indicator(std::size_t n, const double* __restrict p, Real* __restrict z) {
    for (std::size_t i = 0; i < n; ++i) z[i] = p[i] > 0 ? Real(1) : Real(0);
  }

  static void conductance(std::size_t n, const double* __restrict p, const Real* __restrict z, float* __restrict w) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real positive = z[i] > 0 ? z[i] : Real(0);
      w[i] = static_cast<float>(p[i] > 0 ? positive : Real(0));
    }
  }

  static double weigh(std::size_t n, const float* __restrict w, const Real* __restrict z) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(w[i]) * static_cast<double>(z[i]);
    return sum;
  }

  static void relax(std::size_t n, double t, const float* __restrict w, Real* __restrict z) {
    for (std::size_t i = 0; i < n; ++i) z[i] -= static_cast<Real>(t) * static_cast<Real>(w[i]);
  }

  static void correct(std::size_t n, Line trend_z, double* __restrict p, const Real* __restrict z) {
    for (std::size_t i = 0; i < n; ++i) {
      const double relaxed = p[i] - (static_cast<double>(z[i]) - at(trend_z, i));
      const double kept = relaxed > 0 ? relaxed : 0.0;
      p[i] = p[i] > 0 ? kept : 0.0;
    }
  }
};

template <class Arch, class Real, bool kTilts>
constexpr ContactKernels<Real> contact_kernels() {
  using Passes = ContactPasses<Arch, Real, kTilts>;
  return {Passes::advance, Passes::residual, Passes::correlate, Passes::redirect,  Passes::dot,
          Passes::carried, Passes::clip,     Passes::refresh,   Passes::indicator, Passes::conductance,
          Passes::weigh,   Passes::relax,    Passes::correct};
}

}  // namespace
}  // namespace brinell::simd
