#include "influence/gauss_legendre.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"

namespace brinell::influence {

namespace {

simd::GaussRule make_rule(int nodes) {
  simd::GaussRule rule{};
  rule.nodes = nodes;
  const long double n = nodes;
  for (int k = 0; k < (nodes + 1) / 2; ++k) {
    // Newton on the Legendre polynomial P_n from the asymptotic place of its roots.
    long double t = -std::cos(std::numbers::pi_v<long double> * (k + 0.75L) / (n + 0.5L));
    long double slope = 0;
    for (int step = 0; step < 8; ++step) {
      long double previous = 1, value = t;
      for (int m = 2; m <= nodes; ++m) {
        const long double next = ((2 * m - 1) * t * value - (m - 1) * previous) / m;
        previous = value;
        value = next;
      }
      slope = n * (t * value - previous) / (t * t - 1);
      t -= value / slope;
    }
    if (2 * k + 1 == nodes) t = 0;
    rule.node[k] = static_cast<double>(t);
    rule.node[nodes - 1 - k] = -rule.node[k];
    rule.weight[k] = rule.weight[nodes - 1 - k] = static_cast<double>(2 / ((1 - t * t) * slope * slope));
  }
  return rule;
}

std::array<simd::GaussRule, simd::kMaxGaussNodes + 1> make_rules() {
  std::array<simd::GaussRule, simd::kMaxGaussNodes + 1> rules{};
  for (int nodes = 1; nodes <= simd::kMaxGaussNodes; ++nodes) rules[nodes] = make_rule(nodes);
  return rules;
}

}  // namespace

const simd::GaussRule& gauss_legendre(int nodes) {
  static const auto rules = make_rules();
  if (nodes < 1 || nodes > simd::kMaxGaussNodes) {
    fail(Status::internal, "Gauss-Legendre rule of " + std::to_string(nodes) + " nodes; 1 to " +
                               std::to_string(simd::kMaxGaussNodes) + " are known");
  }
  return rules[nodes];
}

}  // namespace brinell::influence
