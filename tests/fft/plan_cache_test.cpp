#include "fft/plan_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "base/buffer.h"
#include "base/error.h"
#include "fft/good_sizes.h"

namespace brinell::fft {
namespace {

TEST(GoodSize, is_the_next_product_of_2_3_5_7) {
  EXPECT_EQ(good_size(0), 1);
  EXPECT_EQ(good_size(1), 1);
  EXPECT_EQ(good_size(11), 12);
  EXPECT_EQ(good_size(13), 14);
  EXPECT_EQ(good_size(1023), 1024);
  EXPECT_EQ(good_size(1025), 1029);
}

TEST(PlanCache, transforms_as_its_formulas_say) {
  PlanCache plans;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int n = 1; n <= 17; ++n) {
    Buffer<double> data(2 * n + 2), out(2 * n + 2);
    std::vector<std::complex<double>> input(n);
    for (auto& value : input) value = {uniform(random), uniform(random)};
    // n terms of size <= √2, each rounded a few times: 8 n eps is ample.
    const double tolerance = 8 * n * 2.3e-16;

    for (const Kind kind : {Kind::complex_forward, Kind::complex_backward}) {
      std::memcpy(data.data(), input.data(), sizeof(double) * 2 * n);
      plans.transform<double>(kind, n)(data.data(), out.data());
      for (int k = 0; k < n; ++k) {
        std::complex<double> sum = 0;
        for (int j = 0; j < n; ++j) {
          sum += input[j] * std::polar(1.0, (kind == Kind::complex_forward ? -2 : 2) * std::numbers::pi * j * k / n);
        }
        EXPECT_NEAR(out[2 * k], sum.real(), tolerance);
        EXPECT_NEAR(out[2 * k + 1], sum.imag(), tolerance);
      }
    }

    for (int j = 0; j < n; ++j) data[j] = input[j].real();
    plans.transform<double>(Kind::cosines, n)(data.data(), out.data());
    for (int k = 0; k < n; ++k) {
      double sum = input[0].real();
      for (int j = 1; j < n; ++j) sum += 2 * input[j].real() * std::cos(std::numbers::pi * j * (k + 0.5) / n);
      EXPECT_NEAR(out[k], sum, tolerance);
    }

    for (int j = 0; j < n; ++j) data[j] = input[j].real();
    plans.transform<double>(Kind::sines, n)(data.data(), out.data());
    for (int k = 0; k < n; ++k) {
      double sum = (k % 2 == 0 ? 1 : -1) * input[n - 1].real();
      for (int j = 0; j < n - 1; ++j) {
        sum += 2 * input[j].real() * std::sin(std::numbers::pi * (j + 1) * (k + 0.5) / n);
      }
      EXPECT_NEAR(out[k], sum, tolerance);
    }

    for (int j = 0; j < n; ++j) data[j] = input[j].real();
    plans.transform<double>(Kind::real_to_complex, n)(data.data(), out.data());
    plans.transform<double>(Kind::complex_to_real, n)(out.data(), data.data());
    for (int j = 0; j < n; ++j) EXPECT_NEAR(data[j], n * input[j].real(), n * tolerance);
  }
}

TEST(PlanCache, refuses_lengths_it_cannot_plan) {
  PlanCache plans;
  EXPECT_THROW(plans.transform<double>(Kind::complex_forward, 0), Error);
  EXPECT_THROW(plans.transform<float>(Kind::cosines, std::int64_t{1} << 40), Error);
}

TEST(PlanCache, carries_wisdom_from_one_cache_to_another) {
  PlanCache measured(PlanCache::Planning::measure);
  measured.transform<double>(Kind::complex_forward, 48);
  measured.transform<float>(Kind::complex_forward, 48);
  const std::string wisdom = measured.export_wisdom<double>();
  EXPECT_NE(wisdom.find("fftw"), std::string::npos);

  PlanCache plans;
  EXPECT_EQ(plans.export_wisdom<double>(), "");
  plans.import_wisdom<double>(wisdom);
  plans.import_wisdom<float>(measured.export_wisdom<float>());
  EXPECT_EQ(plans.export_wisdom<double>(), wisdom);
  plans.import_wisdom<double>("");
  EXPECT_EQ(plans.export_wisdom<double>(), "");
}

TEST(PlanCache, refuses_damaged_wisdom_and_keeps_what_it_had) {
  PlanCache plans;
  EXPECT_THROW(plans.import_wisdom<double>("(no wisdom"), Error);
  EXPECT_EQ(plans.export_wisdom<double>(), "");
}

TEST(PlanCache, serves_several_threads) {
  PlanCache plans;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&plans] {
      for (int n = 1; n < 60; ++n) {
        Buffer<double> data(2 * n), out(2 * n);
        data[0] = 1;
        plans.transform<double>(Kind::complex_forward, n)(data.data(), out.data());
        for (int k = 0; k < n; ++k) ASSERT_NEAR(out[2 * k], 1.0, 1e-15);  // of a unit impulse: exact but for 0·w
      }
    });
  }
  for (auto& thread : threads) thread.join();
}

}  // namespace
}  // namespace brinell::fft
