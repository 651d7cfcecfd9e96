// A sphere of 105 µm pressed into steel that hardens after Swift, on a small grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "plastic/elastic_plastic.h"
#include "support/workbench.h"

namespace brinell::plastic {

constexpr double kYoung = 210e9, kPoisson = 0.3;
constexpr double kModulus = kYoung / (1 - kPoisson * kPoisson);  // against a rigid body
inline const Swift kSteel{1240e6, 30, 0.085, 1e6};

inline PlasticMaterial material(const HardeningLaw& law) {
  return {kYoung, kPoisson, {law, {}}};
}

inline Pair lower(const HardeningLaw& law) {
  Pair pair;
  pair.material[0] = material(law);
  return pair;
}

/// A sphere of 105 µm pressed on a grid.
struct Indentation {
  Indentation(const Pair& pair, double modulus, std::int64_t nodes, double spacing, Layers layers,
              double tolerance = 1e-7, int threads = 1, double increment_tolerance = 0)
      : bench(threads),
        grid{nodes, nodes, spacing, spacing},
        contact_modulus(modulus),
        gap(support::gap_of(surface::Sphere{105e-6}, grid)),
        present(gap),
        solver(bench.resources, grid, Boundary::free, present.data(), false),
        loop(bench.resources, grid, gap.data(), present.data(), solver, pair,
             {modulus, layers, tolerance, 2000, std::size_t{1} << 28, increment_tolerance}) {}

  PlasticSolution press(double force) {
    return drive({contact::Drive::force, force / (contact_modulus * grid.cell_area())});
  }
  PlasticSolution approach(double target) { return drive({contact::Drive::approach, target}); }
  PlasticSolution drive(const contact::Load& load) {
    return loop.advance(load, [](const contact::Report&) { return true; });
  }
  double force(const PlasticSolution& solution) const {
    return solution.contact.total * contact_modulus * grid.cell_area();
  }
  std::vector<double> pressure() const { return {solver.pressure().begin(), solver.pressure().end()}; }

  double peak() const { return *std::max_element(solver.pressure().begin(), solver.pressure().end()); }

  support::Workbench bench;
  Grid grid;
  double contact_modulus;
  std::vector<double> gap, present;
  contact::Solver solver;
  ElasticPlastic loop;
};

constexpr std::int64_t kNodes = 24;
constexpr double kSpacing = 0.5e-6;
constexpr Layers kLayers{16, 0.5e-6};
constexpr double kForce = 0.12;  // [N], radius of contact about 3 µm

inline std::unique_ptr<Indentation> indentation(const Pair& pair, double tolerance = 1e-7, int threads = 1,
                                                double increment_tolerance = 0) {
  return std::make_unique<Indentation>(pair, kModulus, kNodes, kSpacing, kLayers, tolerance, threads,
                                       increment_tolerance);
}

inline double relative(double a, double b) {
  return std::fabs(a - b) / std::fabs(b);
}

}  // namespace brinell::plastic
