// Passes of the contact solver. They are bound by memory, not by arithmetic: plain loops that the compiler vectorises
// for the instruction set of the including source, with the reductions' reordering allowed by `omp simd`.
#pragma once

#include <cmath>

#include "simd/contact_kernels.h"

namespace brinell::simd {
namespace {

template <class Arch, class Real>
struct ContactPasses {
  static void advance(std::size_t n, double step, double* __restrict p, const Real* __restrict v,
                      double* __restrict g, const Real* __restrict q, AdvanceSums* sums) {
    double active = 0, gap = 0, min_gap = HUGE_VAL, min_pressure = 0;
#pragma omp simd reduction(+ : active, gap) reduction(min : min_gap, min_pressure)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] + step * static_cast<double>(v[i]);
      const double deformed = g[i] + step * static_cast<double>(q[i]);
      p[i] = pressure;
      g[i] = deformed;
      active += pressure > 0 ? 1.0 : 0.0;
      gap += pressure > 0 ? deformed : 0.0;
      min_gap = deformed < min_gap ? deformed : min_gap;
      min_pressure = pressure < min_pressure ? pressure : min_pressure;
    }
    *sums = {active, gap, min_gap, -min_pressure};
  }

  static void residual(std::size_t n, double approach, double seed, double* __restrict p, const double* __restrict g,
                       Real* __restrict z, ResidualSums* sums) {
    double active = 0, entered = 0, complementarity = 0, barred = 0;
#pragma omp simd reduction(+ : active, entered, complementarity) reduction(max : barred)
    for (std::size_t i = 0; i < n; ++i) {
      const double r = g[i] - approach;
      const double before = p[i];
      const double enters = (before == 0 ? 1.0 : 0.0) * (r < 0 ? 1.0 : 0.0);
      const double pressure = enters != 0 ? seed : before;
      p[i] = pressure;
      entered += enters;
      active += pressure > 0 ? 1.0 : 0.0;
      complementarity += std::fabs(pressure * r);
      const double depth = before < 0 ? -r : 0.0;
      barred = depth > barred ? depth : barred;
      z[i] = static_cast<Real>(pressure > 0 ? r : 0.0);
    }
    *sums = {active, entered, complementarity, barred};
  }

  static void correlate(std::size_t n, const double* __restrict p, const Real* __restrict z, const Real* __restrict v,
                        const Real* __restrict q, DirectionSums* sums) {
    double sz = 0, sq = 0, sv = 0, zq = 0, vq = 0;
#pragma omp simd reduction(+ : sz, sq, sv, zq, vq)
    for (std::size_t i = 0; i < n; ++i) {
      const double on = p[i] > 0 ? 1.0 : 0.0;
      const double zi = on * static_cast<double>(z[i]);
      const double vi = on * static_cast<double>(v[i]);
      const double qi = static_cast<double>(q[i]);
      sz += zi;
      sv += vi;
      sq += on * qi;
      zq += zi * qi;
      vq += vi * qi;
    }
    *sums = {sz, sq, sv, zq, vq};
  }

  static double redirect(std::size_t n, double beta, double mean_v, double mean_z, double approach,
                         const double* __restrict p, const double* __restrict g, const Real* __restrict z,
                         Real* __restrict v) {
    double slope = 0;
#pragma omp simd reduction(+ : slope)
    for (std::size_t i = 0; i < n; ++i) {
      const double along = beta * (static_cast<double>(v[i]) - mean_v) - (static_cast<double>(z[i]) - mean_z);
      const Real direction = static_cast<Real>(p[i] > 0 ? along : 0.0);
      v[i] = direction;
      slope += static_cast<double>(direction) * (g[i] - approach);
    }
    return slope;
  }

  static double dot(std::size_t n, const Real* __restrict a, const Real* __restrict b) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
  }

  static double clip(std::size_t n, double factor, double* __restrict p) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) {
      const double pressure = p[i] > 0 ? p[i] * factor : 0.0;
      p[i] = pressure;
      sum += pressure;
    }
    return sum;
  }

  static void refresh(std::size_t n, double scale, double origin, const double* __restrict h,
                      const double* __restrict p, double* __restrict g, RefreshSums* sums) {
    double active = 0, gap = 0, min_gap = HUGE_VAL, displacement = 0, energy = 0;
#pragma omp simd reduction(+ : active, gap, energy) reduction(min : min_gap) reduction(max : displacement)
    for (std::size_t i = 0; i < n; ++i) {
      const double u = g[i];
      const double undeformed = scale * (h[i] - origin);
      const double deformed = undeformed + u;
      const double magnitude = std::fabs(u);
      g[i] = deformed;
      active += p[i] > 0 ? 1.0 : 0.0;
      gap += p[i] > 0 ? deformed : 0.0;
      min_gap = deformed < min_gap ? deformed : min_gap;
      displacement = magnitude > displacement ? magnitude : displacement;
      energy += p[i] * (0.5 * u + undeformed);
    }
    *sums = {active, gap, min_gap, displacement, energy};
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

  static double correct(std::size_t n, double mean_z, double* __restrict p, const Real* __restrict z) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) {
      const double relaxed = p[i] - (static_cast<double>(z[i]) - mean_z);
      const double kept = relaxed > 0 ? relaxed : 0.0;
      const double pressure = p[i] > 0 ? kept : 0.0;
      p[i] = pressure;
      sum += pressure;
    }
    return sum;
  }
};

template <class Arch, class Real>
constexpr ContactKernels<Real> contact_kernels() {
  using Passes = ContactPasses<Arch, Real>;
  return {Passes::advance, Passes::residual,  Passes::correlate,   Passes::redirect, Passes::dot,   Passes::clip,
          Passes::refresh, Passes::indicator, Passes::conductance, Passes::weigh,    Passes::relax, Passes::correct};
}

}  // namespace
}  // namespace brinell::simd
