#include "simd/isa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "base/error.h"
#include "simd/kernel_table.h"

namespace brinell::simd {
namespace {

constexpr Isa kAll[] = {Isa::baseline, Isa::avx2, Isa::avx512};

bool is_supported(Isa isa) {
  return std::ranges::find(supported(), isa) != supported().end();
}

TEST(Isa, supported_ones_begin_with_the_baseline_and_grow_stronger) {
  ASSERT_FALSE(supported().empty());
  EXPECT_EQ(supported().front(), Isa::baseline);
  for (std::size_t k = 1; k < supported().size(); ++k) EXPECT_LT(supported()[k - 1], supported()[k]);
}

TEST(Isa, supported_ones_are_those_of_the_processor) {
#if defined(__x86_64__)
  EXPECT_EQ(is_supported(Isa::avx2), __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"));
  EXPECT_LE(is_supported(Isa::avx512), is_supported(Isa::avx2) && __builtin_cpu_supports("avx512bw"));
#else
  EXPECT_EQ(supported().size(), 1U);
#endif
}

TEST(Isa, each_supported_one_has_its_own_table) {
  std::set<const KernelTable*> tables;
  for (const Isa isa : supported()) {
    EXPECT_EQ(kernels(isa).isa, isa);
    tables.insert(&kernels(isa));
    EXPECT_EQ(&kernels(isa), &kernels(isa));
  }
  EXPECT_EQ(tables.size(), supported().size());
  EXPECT_EQ(&best_kernels(), &kernels(supported().back()));
}

TEST(Isa, unsupported_ones_are_refused_by_name_with_those_that_exist) {
  const auto expect_refused = [](Isa isa) {
    try {
      kernels(isa);
      FAIL() << name(isa) << " accepted";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.status(), Status::unsupported);
      EXPECT_NE(message.find("'" + std::string(name(isa)) + "'"), std::string::npos) << message;
      for (const Isa has : supported()) EXPECT_NE(message.find(" " + std::string(name(has))), std::string::npos);
    }
  };
  expect_refused(static_cast<Isa>(0));
  expect_refused(static_cast<Isa>(4));
  for (const Isa isa : kAll) {
    if (!is_supported(isa)) expect_refused(isa);
  }
}

TEST(Isa, names_are_those_of_the_contract) {
  EXPECT_EQ(name(Isa::baseline), "baseline");
  EXPECT_EQ(name(Isa::avx2), "avx2");
  EXPECT_EQ(name(Isa::avx512), "avx512");
  EXPECT_EQ(name(static_cast<Isa>(9)), "unknown");
}

}  // namespace
}  // namespace brinell::simd
