// The same contact with different threads and instruction sets.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <cstring>
#include <set>
#include <vector>

#include "support/workbench.h"

namespace brinell::contact {
namespace {

using support::Pressed;
using support::Request;

struct Case {
  Grid grid;
  Boundary boundary;
  bool mixed_precision;
};

constexpr Case kCases[] = {
    {{200, 150, 1, 1}, Boundary::free, false},
    {{128, 160, 1, 1.5}, Boundary::periodic, false},
    {{131, 127, 1, 1}, Boundary::free, true},
    {{97, 101, 1, 1}, Boundary::periodic, true},
};

Pressed solved(const Case& c, int threads, const simd::KernelTable& kernels, const Request& request) {
  const support::Workbench bench(threads, kernels);
  const std::vector<double> gap = support::gap_of(support::self_affine(c.grid, 1), c.grid);
  return support::press(bench, c.grid, c.boundary, gap, request, c.mixed_precision);
}

Request request_of(const Case& c, Drive drive) {
  return {drive, drive == Drive::force ? 0.006 * static_cast<double>(c.grid.nodes()) : -0.2, 1e-10};
}

TEST(Solver, gives_the_same_bits_on_any_number_of_threads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  for (const Case& c : kCases) {
    for (const Drive drive : {Drive::force, Drive::approach}) {
      const Request request = request_of(c, drive);
      const Pressed one = solved(c, 1, simd::best_kernels(), request);
      EXPECT_TRUE(one.solution.converged);
      for (const int threads : {2, 3, 8}) {
        const Pressed many = solved(c, threads, simd::best_kernels(), request);
        const std::size_t bytes = one.pressure.size() * sizeof(double);
        EXPECT_EQ(std::memcmp(many.pressure.data(), one.pressure.data(), bytes), 0) << threads << " threads";
        EXPECT_EQ(std::memcmp(many.deformed_gap.data(), one.deformed_gap.data(), bytes), 0) << threads << " threads";
        EXPECT_EQ(many.solution.approach, one.solution.approach);
        EXPECT_EQ(many.solution.iterations, one.solution.iterations);
        EXPECT_EQ(many.solution.certificate.worst(), one.solution.certificate.worst());
      }
    }
  }
}

// Stands in for one kernel of a table, counts its calls and passes them on.
std::atomic<int> calls_in_double{0}, calls_in_single{0};
const simd::KernelTable* watched = nullptr;

void counted_in_double(std::size_t n, simd::Line x, double step, double* p, const double* v, double* g,
                       const double* q, simd::AdvanceSums* sums) {
  ++calls_in_double;
  watched->in_double.contact.advance(n, x, step, p, v, g, q, sums);
}
void counted_in_single(std::size_t n, simd::Line x, double step, double* p, const float* v, double* g, const float* q,
                       simd::AdvanceSums* sums) {
  ++calls_in_single;
  watched->in_single.contact.advance(n, x, step, p, v, g, q, sums);
}

TEST(Solver, runs_the_kernels_of_its_instruction_set_and_agrees_with_the_others) {
  for (const Case& c : kCases) {
    const Request request{Drive::force, 0.006 * static_cast<double>(c.grid.nodes()), 1e-12, 1000};
    const Pressed reference = solved(c, 1, simd::kernels(simd::Isa::baseline), request);
    std::set<void*> seen;
    for (const simd::Isa isa : simd::supported()) {
      SCOPED_TRACE(simd::name(isa));
      const simd::KernelTable& own = simd::kernels(isa);
      simd::KernelTable table = own;
      watched = &own;
      calls_in_double = calls_in_single = 0;
      table.in_double.contact.advance = counted_in_double;
      table.in_single.contact.advance = counted_in_single;
      const Pressed pressed = solved(c, 1, table, request);
      EXPECT_TRUE(pressed.solution.converged);
      EXPECT_GT(c.mixed_precision ? calls_in_single : calls_in_double, 0);
      // Certificates of 1e-12 leave pressures that differ by some ten times as much (see direct_test.cpp).
      EXPECT_LE(support::largest_difference(pressed.pressure, reference.pressure), 1e-9 * reference.largest());
      EXPECT_NEAR(pressed.solution.approach, reference.solution.approach, 1e-10);
      // Every set brings code of its own.
      const auto& contact = own.in_double.contact;
      EXPECT_TRUE(seen.insert(reinterpret_cast<void*>(contact.advance)).second);
      EXPECT_TRUE(seen.insert(reinterpret_cast<void*>(own.in_single.contact.advance)).second);
      EXPECT_TRUE(seen.insert(reinterpret_cast<void*>(contact.refresh)).second);
    }
  }
}

}  // namespace
}  // namespace brinell::contact
