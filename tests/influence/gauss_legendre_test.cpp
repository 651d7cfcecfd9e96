#include "influence/gauss_legendre.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace brinell::influence {
namespace {

TEST(GaussLegendre, integrates_polynomials_of_degree_up_to_2n_minus_1) {
  for (int nodes = 1; nodes <= simd::kMaxGaussNodes; ++nodes) {
    const simd::GaussRule& rule = gauss_legendre(nodes);
    ASSERT_EQ(rule.nodes, nodes);
    for (int degree = 0; degree < 2 * nodes; ++degree) {
      double sum = 0;
      for (int k = 0; k < nodes; ++k) sum += rule.weight[k] * std::pow(rule.node[k], degree);
      const double exact = degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0;
      EXPECT_NEAR(sum, exact, 2e-15) << nodes << " nodes, degree " << degree;  // a rounding for each node, sum 2
    }
  }
}

TEST(GaussLegendre, refuses_rules_it_does_not_know) {
  EXPECT_THROW(gauss_legendre(0), Error);
  EXPECT_THROW(gauss_legendre(simd::kMaxGaussNodes + 1), Error);
}

}  // namespace
}  // namespace brinell::influence
