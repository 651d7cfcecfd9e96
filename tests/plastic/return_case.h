// Points to return, in arrays as the engine takes them, and the laws that the tests go through.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "parallel/arena.h"
#include "plastic/return_mapping.h"
#include "simd/kernel_table.h"
#include "support/return_reference.h"

namespace brinell::plastic {

inline constexpr double kShearModulus = 80e9;  // E = 208 GPa with nu = 0.3

struct NamedLaw {
  std::string name;
  HardeningLaw law;
};

/// Slopes at zero plastic strain reach 2e17 Pa, a million times E.
inline std::vector<NamedLaw> laws() {
  return {{"swift", Swift{1240e6, 30, 0.085, 1e6}},
          {"swift_n_half", Swift{2e9, 1, 0.5, 1e3}},
          {"swift_n_tiny", Swift{1e9, 1, 1e-12, 1e6}},
          {"swift_n_tiny_without_offset", Swift{1e9, 0, 1e-12, 1e6}},
          {"swift_n_small", Swift{1e9, 0.01, 1e-3, 1}},
          {"swift_n_zero", Swift{1e9, 3, 0, 1e6}},
          {"swift_n_one", Swift{1e8, 4, 1, 100}},
          {"swift_n_one_without_offset", Swift{1e8, 0, 1, 100}},
          {"swift_n_almost_one", Swift{1e8, 4, 1 - 1e-9, 100}},
          {"swift_without_offset", Swift{1240e6, 0, 0.085, 1e6}},
          {"swift_offset_tiny", Swift{1e9, 1e-30, 0.2, 1e6}},
          {"swift_steep", Swift{1e9, 6e-6, 0.5, 1e6}},
          {"linear", LinearHardening{500e6, 10e9}},
          {"linear_steep", LinearHardening{500e6, 2e17}},
          {"perfect", PerfectPlasticity{250e6}},
          {"voce", Voce{300e6, 700e6, 12}},
          {"voce_steep", Voce{300e6, 800e6, 4e8}},
          {"voce_saturated", Voce{300e6, 300e6, 5}},
          {"voce_high", Voce{1e3, 1e9, 100}},
          {"ramberg_osgood", RambergOsgood{4320e6, 12.6, 0}},
          {"ramberg_osgood_onset", RambergOsgood{4320e6, 12.6, 1500e6}},
          {"ramberg_osgood_linear", RambergOsgood{50e9, 1, 0}},
          {"ramberg_osgood_linear_onset", RambergOsgood{50e9, 1, 100e6}},
          {"ramberg_osgood_flat", RambergOsgood{1e9, 100, 0}},
          {"table_one", HardeningTable{{0}, {400e6}}},
          {"table_two", HardeningTable{{0, 0.1}, {400e6, 600e6}}},
          {"table", HardeningTable{{0, 1e-4, 1e-3, 0.01, 0.05, 0.3}, {300e6, 420e6, 500e6, 500e6, 700e6, 810e6}}},
          {"table_steep", HardeningTable{{0, 1e-9, 1e-8, 0.1}, {200e6, 400e6, 420e6, 500e6}}}};
}

struct Point {
  support::LongTensor trial{};  // doubles
  double plastic_strain = 0;
};

/// A trial stress of von Mises stress q in a random direction, with a pressure.
template <class Random>
Point random_point(Random& random, double q, double pressure, double plastic_strain) {
  std::normal_distribution<double> normal;
  support::LongTensor s{};
  for (auto& component : s) component = normal(random);
  s = support::deviator_of(s);
  const auto size = support::von_mises_of(s);
  Point point;
  for (std::size_t c = 0; c < 6; ++c) {
    point.trial[c] = static_cast<double>(s[c] * q / size - (c < 3 ? pressure : 0));
  }
  point.plastic_strain = plastic_strain;
  return point;
}

/// From zero to 10^6 times the yield stress, old plastic strains from none to 2.
inline std::vector<Point> points_for(const HardeningLaw& law, double factor, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Point> points;
  for (const double p : {0.0, 1e-14, 1e-9, 1e-5, 1e-3, 0.02, 2.0}) {
    const auto yield = static_cast<double>(factor * support::yield_of(law, p));
    for (const double reach :
         {0.0, 0.5, 1 - 1e-12, 1.0, 1 + 1e-12, 1 + 1e-9, 1 + 1e-5, 1.01, 1.3, 3.0, 40.0, 1e3, 1e6}) {
      points.push_back(random_point(random, reach * yield, 2 * yield, p));
    }
    for (const double q : {1e-40, 1.0, 1e6, 3e8, 1e10, 1e15}) points.push_back(random_point(random, q, 0, p));
  }
  std::uniform_real_distribution<double> uniform;
  for (int k = 0; k < 60; ++k) {
    const double p = 0.1 * std::pow(uniform(random), 4),
                 yield = static_cast<double>(factor * support::yield_of(law, p));
    points.push_back(random_point(random, (0.5 + 3 * uniform(random)) * yield, 10 * uniform(random) * yield, p));
  }
  return points;
}

/// Arrays of points and of results, one behind the other with a canary between them, off alignment.
class Field {
 public:
  explicit Field(std::size_t count)
      : count_(count), inputs_(7 * (count + 2) + 1, kCanary), outputs_(16 * (count + 2) + 1, kCanary) {
    for (std::size_t k = 0; k < 7; ++k) std::fill(input(k), input(k) + count, 0.0);
  }

  explicit Field(const std::vector<Point>& points) : Field(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) set(i, points[i]);
  }

  void set(std::size_t i, const Point& point) {
    for (std::size_t c = 0; c < 6; ++c) input(c)[i] = static_cast<double>(point.trial[c]);
    input(6)[i] = point.plastic_strain;
  }

  TrialState state(std::span<const double> factors = {}) {
    TrialState state;
    state.count = count_;
    for (std::size_t c = 0; c < 6; ++c) state.trial[c] = input(c);
    state.plastic_strain = input(6);
    state.layer_factor = factors;
    return state;
  }
  MappedState result() {
    MappedState result;
    for (std::size_t c = 0; c < 6; ++c) {
      result.increment[c] = output(c);
      result.stress[c] = output(10 + c);
    }
    result.plastic_strain = output(6);
    result.von_mises = output(7);
    result.theta = output(8);
    result.theta_bar = output(9);
    return result;
  }

  double* input(std::size_t k) { return inputs_.data() + k * (count_ + 2) + 2; }
  /// 0 to 5 increment, 6 plastic strain, 7 von Mises, 8 theta, 9 theta_bar, 10 to 15 stress.
  double* output(std::size_t k) { return outputs_.data() + k * (count_ + 2) + 2; }
  const std::vector<double>& outputs() const { return outputs_; }

  bool canaries_live() {
    for (std::size_t k = 0; k < 16; ++k) {
      if (output(k)[-1] != kCanary || output(k)[count_] != kCanary) return false;
    }
    return true;
  }

 private:
  static constexpr double kCanary = -77.5;
  std::size_t count_;
  std::vector<double> inputs_, outputs_;
};

}  // namespace brinell::plastic
