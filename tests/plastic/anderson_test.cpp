#include "plastic/anderson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace brinell::plastic {
namespace {

TEST(Anderson, solves_a_linear_iteration_of_few_rates_exactly) {
  // map(x) = rate·x + 1 with four different rates: the Krylov space is complete after four differences.
  const parallel::Arena arena(1);
  constexpr std::size_t n = 4 * Anderson::kBlock;
  std::vector<double> x(n, 0.0), mapped(n);
  const std::vector<std::int64_t> blocks{0, 1, 2};  // the last stays what it is
  Anderson anderson(arena, 5);
  anderson.start(n);
  const auto rate = [](std::size_t i) { return 0.8 - 0.4 * static_cast<double>(i % 4); };
  for (int k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < n; ++i) mapped[i] = rate(i) * x[i] + 1;
    const AndersonPart part{x.data(), mapped.data(), n, blocks};
    anderson.advance({&part, 1});
  }
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(x[i], i < 3 * Anderson::kBlock ? 1 / (1 - rate(i)) : 0.0, 1e-9) << i;
  }
}

TEST(Anderson, of_one_step_is_the_plain_iteration) {
  const parallel::Arena arena(1);
  std::vector<double> x(Anderson::kBlock, 1.0), mapped(Anderson::kBlock);
  std::iota(mapped.begin(), mapped.end(), 0.0);
  const std::vector<std::int64_t> blocks{0};
  Anderson anderson(arena, 3);
  anderson.start(Anderson::kBlock);
  const AndersonPart part{x.data(), mapped.data(), Anderson::kBlock, blocks};
  anderson.advance({&part, 1});
  EXPECT_EQ(x, mapped);
}

}  // namespace
}  // namespace brinell::plastic
