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

  /// The contact of a block as numbers: loops that mix bytes with doubles are compiled to several times the work.
  struct Membership {
    alignas(64) double on[kLongestStretch];

    Membership() {
    }  // NOLINT(modernize-use-equals-default,cppcoreguidelines-pro-type-member-init): written before read
    Membership(std::size_t n,
               const std::uint8_t* __restrict contact) {  // NOLINT(cppcoreguidelines-pro-type-member-init)
      for (std::size_t i = 0; i < n; ++i) on[i] = static_cast<double>(static_cast<int>(contact[i]));
    }
    void write(std::size_t n, std::uint8_t* __restrict contact) const {
      for (std::size_t i = 0; i < n; ++i) contact[i] = static_cast<std::uint8_t>(static_cast<int>(on[i]));
    }
  };

  static void advance(std::size_t n, Line x, double step, double* __restrict p, const Real* __restrict v,
                      double* __restrict g, const Real* __restrict q, AdvanceSums* sums) {
    double load = 0, load_x = 0, load_xx = 0, gap = 0, gap_x = 0, min_pressure = 0;
#pragma omp simd reduction(+ : load, load_x, load_xx, gap, gap_x) reduction(min : min_pressure)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] + step * static_cast<double>(v[i]);
      const double deformed = g[i] + step * static_cast<double>(q[i]);
      p[i] = pressure;
      g[i] = deformed;
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
    *sums = {{load, load_x, load_xx}, {gap, gap_x}, -min_pressure};
  }

  static void residual(std::size_t n, Line approach, double noise, double stiffness, const double* __restrict p,
                       const double* __restrict g, std::uint8_t* __restrict contact, Real* __restrict z,
                       ResidualSums* sums) {
    double active = 0, occupied = 0, changed = 0, complementarity = 0, deepest = 0;
    const Membership before(n, contact);
    Membership now;
#pragma omp simd reduction(+ : active, occupied, changed, complementarity) reduction(max : deepest)
    for (std::size_t i = 0; i < n; ++i) {
      const double r = g[i] - at(approach, i);
      const double pressure = p[i];
      const double wide = r + (pressure > 0 ? 0.0 : noise);
      const double on = pressure > stiffness * wide ? 1.0 : 0.0;
      now.on[i] = on;
      active += on;
      occupied += pressure != 0 ? 1.0 : on;
      changed += std::fabs(on - before.on[i]);
      complementarity += std::fabs(pressure * r);
      const double depth = -r;
      deepest = depth > deepest ? depth : deepest;
      z[i] = static_cast<Real>(on * r);
    }
    now.write(n, contact);
    *sums = {active, occupied, changed, complementarity, deepest};
  }

  static void correlate(std::size_t n, Line x, const std::uint8_t* __restrict contact, const Real* __restrict z,
                        const Real* __restrict v, const Real* __restrict q, CorrelationSums* sums) {
    double active = 0, active_x = 0, active_xx = 0, sz = 0, sz_x = 0, sq = 0, sq_x = 0, sv = 0, sv_x = 0, zq = 0,
           vq = 0;
    const Membership members(n, contact);
#pragma omp simd reduction(+ : active, active_x, active_xx, sz, sz_x, sq, sq_x, sv, sv_x, zq, vq)
    for (std::size_t i = 0; i < n; ++i) {
      const double on = members.on[i];
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

  /// Whether the direction leaves a node in contact some of its pressure, in the precision of the direction.
  static double is_free(double on, double p, Real v) {
    return v > static_cast<Real>(-p) ? on : 0.0;
  }

  static void redirect(std::size_t n, Line x, double beta, Line trend_v, double scale, Line trend_z,
                       const std::uint8_t* __restrict contact, const double* __restrict p, const Real* __restrict z,
                       Real* __restrict v, DirectionSums* sums) {
    double load = 0, load_x = 0, free = 0, free_x = 0, free_xx = 0;
    const Membership members(n, contact);
#pragma omp simd reduction(+ : load, load_x, free, free_x, free_xx)
    for (std::size_t i = 0; i < n; ++i) {
      const double along =
          beta * (static_cast<double>(v[i]) - at(trend_v, i)) - scale * (static_cast<double>(z[i]) - at(trend_z, i));
      const double wanted = members.on[i] > 0 ? along : -p[i];
      const double direction = wanted > -p[i] ? wanted : -p[i];
      v[i] = static_cast<Real>(direction);
      load += p[i] + direction;
      const double one = is_free(members.on[i], p[i], v[i]);
      free += one;
      if constexpr (kTilts) {
        load_x += (p[i] + direction) * at(x, i);
        free_x += one * at(x, i);
        free_xx += one * at(x, i) * at(x, i);
      }
    }
    *sums = {{load, load_x}, {free, free_x, free_xx}};
  }

  static SlopeSums balance(std::size_t n, Line shift, Line approach, const std::uint8_t* __restrict contact,
                           const double* __restrict p, const double* __restrict g, Real* __restrict v) {
    double free = 0, taken = 0;
    const Membership members(n, contact);
#pragma omp simd reduction(+ : free, taken)
    for (std::size_t i = 0; i < n; ++i) {
      const double shifted = static_cast<double>(v[i]) + at(shift, i);
      const double limited = shifted > -p[i] ? shifted : -p[i];
      const Real direction = is_free(members.on[i], p[i], v[i]) > 0 ? static_cast<Real>(limited) : v[i];
      v[i] = direction;
      const double work = static_cast<double>(direction) * (g[i] - at(approach, i));
      const double one = is_free(members.on[i], p[i], direction);
      free += one * work;
      taken += (1.0 - one) * std::fabs(work);
    }
    return {free, taken};
  }

  static double curvature(std::size_t n, const std::uint8_t* __restrict contact, const double* __restrict p,
                          const Real* __restrict v, const Real* __restrict q) {
    double sum = 0;
    const Membership members(n, contact);
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) {
      const double along = is_free(members.on[i], p[i], v[i]) * static_cast<double>(v[i]);
      sum += along * static_cast<double>(q[i]);
    }
    return sum;
  }

  static QuadraticSums carried(std::size_t n, Line x, Line factor, const std::uint8_t* __restrict contact,
                               const double* __restrict p) {
    double load = 0, load_x = 0, load_xx = 0;
    const Membership members(n, contact);
#pragma omp simd reduction(+ : load, load_x, load_xx)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] > 0 ? p[i] : 0.0;
      const double in_contact = members.on[i] * pressure;
      const double carried = at(factor, i) > 0 ? in_contact : 0.0;
      load += carried;
      if constexpr (kTilts) {
        const double moment = carried * at(x, i);
        load_x += moment;
        load_xx += moment * at(x, i);
      }
    }
    return {load, load_x, load_xx};
  }

  static void clip(std::size_t n, Line factor, const std::uint8_t* __restrict contact, double* __restrict p) {
    for (std::size_t i = 0; i < n; ++i) {
      const double scale = at(factor, i) > 0 ? at(factor, i) : 0.0;
      const double pressure = p[i] > 0 ? p[i] * scale : 0.0;
      p[i] = contact[i] != 0 ? pressure : 0.0;
    }
  }

  static void refresh(std::size_t n, Line x, double scale, double origin, const double* __restrict h,
                      const double* __restrict p, double* __restrict g, RefreshSums* sums) {
    double load = 0, load_x = 0, load_xx = 0, gap = 0, gap_x = 0, displacement = 0;
#pragma omp simd reduction(+ : load, load_x, load_xx, gap, gap_x) reduction(max : displacement)
    for (std::size_t i = 0; i < n; ++i) {
      const double u = g[i];
      const double deformed = scale * (h[i] - origin) + u;
      const double magnitude = std::fabs(u);
      g[i] = deformed;
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
    }
    *sums = {{load, load_x, load_xx}, {gap, gap_x}, displacement};
  }

  static void indicator(std::size_t n, const std::uint8_t* __restrict contact, Real* __restrict z) {
    for (std::size_t i = 0; i < n; ++i) z[i] = static_cast<Real>(contact[i]);
  }

  static void conductance(std::size_t n, const std::uint8_t* __restrict contact, const Real* __restrict z,
                          float* __restrict w) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real positive = z[i] > 0 ? z[i] : Real(0);
      w[i] = static_cast<float>(contact[i] != 0 ? positive : Real(0));
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
};

template <class Arch, class Real, bool kTilts>
constexpr ContactKernels<Real> contact_kernels() {
  using Passes = ContactPasses<Arch, Real, kTilts>;
  return {Passes::advance,     Passes::residual, Passes::correlate, Passes::redirect, Passes::balance,
          Passes::curvature,   Passes::carried,  Passes::clip,      Passes::refresh,  Passes::indicator,
          Passes::conductance, Passes::weigh,    Passes::relax};
}

}  // namespace
}  // namespace brinell::simd
