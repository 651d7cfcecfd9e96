// Every kernel of simd/contact_kernels.h, at every instruction set and in both precisions, against its formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "simd/contact_kernels.h"
#include "simd/kernel_table.h"

namespace brinell::simd {
namespace {

constexpr std::size_t kLongest = 4 * 16 + 1;  // of floats, whose registers hold up to 16
constexpr double kEps = std::numeric_limits<double>::epsilon();

/// An array that ends (and begins) in the middle of a register, between canaries.
template <class T>
class Guarded {
 public:
  Guarded(std::size_t size, std::size_t misalignment) : size_(size), begin_(kMargin + misalignment) {
    values_.assign(size + 2 * kMargin + misalignment, kCanary);
  }
  T* data() { return values_.data() + begin_; }
  const T* data() const { return values_.data() + begin_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  std::vector<T> copy() const { return {data(), data() + size_}; }
  bool intact() const {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if ((i < begin_ || i >= begin_ + size_) && values_[i] != kCanary) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kMargin = 40;
  static constexpr T kCanary = T(-777.25);
  std::size_t size_, begin_;
  std::vector<T> values_;
};

/// One block of the solver's fields, with nodes in contact, out of contact and in tension, zeros of both signs and
/// denormals.
template <class Real>
struct Block {
  std::size_t n;
  Guarded<double> p, g, h;
  Guarded<Real> v, q, z;
  Guarded<float> w;

  Block(std::size_t size, unsigned seed)
      : n(size), p(n, seed % 3), g(n, seed % 2), h(n, seed % 5), v(n, seed % 7), q(n, 1), z(n, seed % 4), w(n, 3) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    constexpr double kSpecial[] = {0, -0.0, 1e-310, -1e-310, 1e-30, 5e-324};
    for (std::size_t i = 0; i < n; ++i) {
      const unsigned kind = static_cast<unsigned>(random() % 8U);
      p[i] = kind < 3 ? 0 : kind == 3 ? kSpecial[random() % 6U] : uniform(random);
      g[i] = random() % 9U == 0 ? 0.25 : uniform(random);  // 0.25: exactly the approach of the tests
      h[i] = uniform(random);
      v[i] = static_cast<Real>(uniform(random));
      q[i] = static_cast<Real>(uniform(random));
      z[i] = static_cast<Real>(uniform(random));
      w[i] = random() % 3U == 0 ? 0.0F : static_cast<float>(std::fabs(uniform(random)));
    }
  }
  bool intact() const {
    return p.intact() && g.intact() && h.intact() && v.intact() && q.intact() && z.intact() && w.intact();
  }
};

/// A sum in long double, and what rounding in any order may do to it: n/2 ε Σ|terms|, and an ε for the terms.
class Sum {
 public:
  void add(long double term) {
    value_ += term;
    size_ += std::abs(term);
    ++terms_;
  }
  void expect(double actual, const char* what) const {
    const double allowed = kEps * static_cast<double>(size_) * (0.5 * static_cast<double>(terms_) + 2);
    EXPECT_NEAR(actual, static_cast<double>(value_), allowed) << what;
  }

 private:
  long double value_ = 0, size_ = 0;
  std::size_t terms_ = 0;
};

template <class Real>
double largest_of(std::size_t n, const Guarded<Real>& values, double least) {
  double most = least;
  for (std::size_t i = 0; i < n; ++i) most = std::max(most, static_cast<double>(values[i]));
  return most;
}

/// What a kernel may be asked: whether its lines have slopes, which the set for parallel bodies does not read.
struct Asked {
  bool tilts;

  double at(Line line, std::size_t i) const { return line.value + (tilts ? line.slope * static_cast<double>(i) : 0); }
};

/// Runs check(kernels, block, asked) at every instruction set, length and misalignment, for parallel bodies and for
/// such that may tilt.
template <class Real, class Check>
void for_every_block(const Check& check) {
  for (const Isa isa : supported()) {
    for (const bool tilts : {false, true}) {
      for (std::size_t n = 0; n <= kLongest; ++n) {
        Block<Real> block(n, static_cast<unsigned>(3 * n + 1));
        const RealKernels<Real>& sets = kernels(isa).of<Real>();
        check(tilts ? sets.tilting_contact : sets.contact, block, Asked{tilts});
        EXPECT_TRUE(block.intact());
        if (testing::Test::HasFailure()) {
          FAIL() << name(isa) << ", " << n << (sizeof(Real) == 4 ? " floats" : " doubles")
                 << (tilts ? ", tilting" : "");
        }
      }
    }
  }
}

// Places, approach, trends and factor of the tests; powers of two, so that they are exact at every node, but for the
// factor, which changes its sign.
constexpr Line kPlaces{-3, 0.25}, kApproach{0.25, 0.03125}, kTrendV{0.1, -0.0625}, kTrendZ{-0.2, 0.125},
    kFactor{1.75, -0.0625};

/// Sums and their moments, that a kernel for parallel bodies leaves zero.
struct MomentSums {
  explicit MomentSums(const Asked& of) : asked(of) {}

  void add(long double term, std::size_t i) {
    const long double x = asked.at(kPlaces, i);
    one.add(term);
    one.add(0);  // the rounding of the term
    if (!asked.tilts) return;
    first.add(term * x);
    first.add(0);
    second.add(term * x * x);
    second.add(0);
  }
  void expect(const LinearSums& sums, const char* what) const {
    one.expect(sums.one, what);
    first.expect(sums.x, what);
  }
  void expect(const QuadraticSums& sums, const char* what) const {
    one.expect(sums.one, what);
    first.expect(sums.x, what);
    second.expect(sums.xx, what);
  }

  Asked asked;
  Sum one, first, second;
};

template <class Real>
class ContactKernelsOf : public testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(ContactKernelsOf, Precisions);

// Products that an instruction set fuses into the sum differ by the rounding of one product and one sum.
void expect_fused(double actual, double a, double b, double c) {
  EXPECT_NEAR(actual, a + b * c, kEps * (std::fabs(a) + std::fabs(b * c)));
}

TYPED_TEST(ContactKernelsOf, advance) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto p = at.p.copy(), g = at.g.copy();
    AdvanceSums sums;
    run.advance(at.n, kPlaces, 0.3, at.p.data(), at.v.data(), at.g.data(), at.q.data(), &sums);
    double active = 0, tension = 0;
    MomentSums load(asked), gap(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      expect_fused(at.p[i], p[i], 0.3, static_cast<double>(at.v[i]));
      expect_fused(at.g[i], g[i], 0.3, static_cast<double>(at.q[i]));
      tension = std::max(tension, -at.p[i]);
      if (!(at.p[i] > 0)) continue;
      active += 1;
      load.add(at.p[i], i);
      gap.add(at.p[i] * at.g[i], i);
    }
    EXPECT_EQ(sums.active, active);
    load.expect(sums.load, "load");
    gap.expect(sums.gap, "gap");
    EXPECT_EQ(sums.tension, tension);
  });
}

TYPED_TEST(ContactKernelsOf, advance_by_nothing_changes_nothing) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    const auto p = at.p.copy(), g = at.g.copy();
    AdvanceSums sums;
    run.advance(at.n, kPlaces, 0, at.p.data(), at.v.data(), at.g.data(), at.q.data(), &sums);
    EXPECT_EQ(at.p.copy(), p);
    EXPECT_EQ(at.g.copy(), g);
  });
}

TYPED_TEST(ContactKernelsOf, residual) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto p = at.p.copy(), g = at.g.copy();
    const double noise = 0.125, seed = 1e-30;
    ResidualSums sums;
    run.residual(at.n, kApproach, noise, seed, at.p.data(), at.g.data(), at.z.data(), &sums);
    double active = 0, entered = 0, barred = 0, depth = 0;
    Sum complementarity;
    for (std::size_t i = 0; i < at.n; ++i) {
      const double approach = asked.at(kApproach, i);
      depth = std::max(depth, approach - g[i]);
      const bool enters = p[i] == 0 && g[i] - approach < -noise;
      EXPECT_EQ(at.p[i], enters ? seed : p[i]);
      EXPECT_EQ(at.z[i], static_cast<TypeParam>(at.p[i] > 0 ? g[i] - approach : 0));
      active += at.p[i] > 0 ? 1 : 0;
      entered += enters ? 1 : 0;
      if (p[i] < 0) barred = std::max(barred, approach - g[i]);
      complementarity.add(std::fabs(static_cast<long double>(at.p[i]) * (g[i] - approach)));
    }
    EXPECT_EQ(at.g.copy(), g);
    EXPECT_EQ(sums.active, active);
    EXPECT_EQ(sums.entered, entered);
    EXPECT_EQ(sums.barred, barred);
    EXPECT_EQ(sums.depth, depth);
    complementarity.expect(sums.complementarity, "complementarity");
  });
}

TYPED_TEST(ContactKernelsOf, correlate) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    DirectionSums sums;
    run.correlate(at.n, kPlaces, at.p.data(), at.z.data(), at.v.data(), at.q.data(), &sums);
    MomentSums active(asked), z(asked), q(asked), v(asked);
    Sum zq, vq;
    for (std::size_t i = 0; i < at.n; ++i) {
      if (!(at.p[i] > 0)) continue;
      const long double zi = at.z[i], qi = at.q[i], vi = at.v[i];
      active.add(1, i);
      z.add(zi, i);
      q.add(qi, i);
      v.add(vi, i);
      zq.add(zi * qi);
      vq.add(vi * qi);
    }
    active.expect(sums.active, "active");
    z.expect(sums.z, "z");
    q.expect(sums.q, "q");
    v.expect(sums.v, "v");
    zq.expect(sums.zq, "zq");
    vq.expect(sums.vq, "vq");
  });
}

TYPED_TEST(ContactKernelsOf, redirect) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto v = at.v.copy();
    const double beta = 0.7;
    const double slope =
        run.redirect(at.n, beta, kTrendV, kTrendZ, kApproach, at.p.data(), at.g.data(), at.z.data(), at.v.data());
    Sum expected;
    for (std::size_t i = 0; i < at.n; ++i) {
      if (!(at.p[i] > 0)) {
        EXPECT_EQ(at.v[i], 0);
        continue;
      }
      const double direction = beta * (static_cast<double>(v[i]) - asked.at(kTrendV, i)) -
                               (static_cast<double>(at.z[i]) - asked.at(kTrendZ, i));
      // Terms below 16: a rounding each, and that of the result to Real.
      EXPECT_NEAR(static_cast<double>(at.v[i]), direction,
                  32 * kEps + 16 * static_cast<double>(std::numeric_limits<TypeParam>::epsilon()));
      expected.add(static_cast<long double>(at.v[i]) * (at.g[i] - asked.at(kApproach, i)));
      expected.add(0);  // the rounding of the difference
    }
    expected.expect(slope, "slope");
  });
}

TYPED_TEST(ContactKernelsOf, dot_and_weigh) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    Sum dot, weigh;
    for (std::size_t i = 0; i < at.n; ++i) {
      dot.add(static_cast<long double>(at.v[i]) * at.q[i]);
      weigh.add(static_cast<long double>(at.w[i]) * at.z[i]);
    }
    dot.expect(run.dot(at.n, at.v.data(), at.q.data()), "dot");
    weigh.expect(run.weigh(at.n, at.w.data(), at.z.data()), "weigh");
  });
}

TYPED_TEST(ContactKernelsOf, carried_and_clip) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto p = at.p.copy();
    const QuadraticSums sums = run.carried(at.n, kPlaces, kFactor, at.p.data());
    EXPECT_EQ(at.p.copy(), p);
    run.clip(at.n, kFactor, at.p.data());
    MomentSums expected(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      const double factor = asked.at(kFactor, i);
      EXPECT_EQ(at.p[i], p[i] > 0 && factor > 0 ? p[i] * factor : 0);
      EXPECT_FALSE(std::signbit(at.p[i]));
      expected.add(p[i] > 0 && factor > 0 ? p[i] : 0, i);
    }
    expected.expect(sums, "carried");
  });
}

TYPED_TEST(ContactKernelsOf, refresh) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto u = at.g.copy(), p = at.p.copy();
    const double scale = 1.3, origin = -0.6;
    RefreshSums sums;
    run.refresh(at.n, kPlaces, scale, origin, at.h.data(), at.p.data(), at.g.data(), &sums);
    double active = 0, displacement = 0;
    MomentSums load(asked), gap(asked);
    Sum energy;
    for (std::size_t i = 0; i < at.n; ++i) {
      expect_fused(at.g[i], u[i], scale, at.h[i] - origin);
      displacement = std::max(displacement, std::fabs(u[i]));
      const long double h = static_cast<long double>(scale) * (at.h[i] - origin);
      energy.add(p[i] * (u[i] / 2 + h));
      energy.add(0);  // the rounding of h
      if (!(p[i] > 0)) continue;
      active += 1;
      load.add(at.p[i], i);
      gap.add(at.p[i] * at.g[i], i);
    }
    EXPECT_EQ(at.p.copy(), p);
    EXPECT_EQ(sums.active, active);
    load.expect(sums.load, "load");
    gap.expect(sums.gap, "gap");
    EXPECT_EQ(sums.displacement, displacement);
    energy.expect(sums.energy, "energy");
  });
}

TYPED_TEST(ContactKernelsOf, indicator_and_conductance) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    run.conductance(at.n, at.p.data(), at.z.data(), at.w.data());
    for (std::size_t i = 0; i < at.n; ++i) {
      EXPECT_EQ(at.w[i], at.p[i] > 0 && at.z[i] > 0 ? static_cast<float>(at.z[i]) : 0.0F);
    }
    run.indicator(at.n, at.p.data(), at.z.data());
    for (std::size_t i = 0; i < at.n; ++i) EXPECT_EQ(at.z[i], at.p[i] > 0 ? 1 : 0);
  });
}

TYPED_TEST(ContactKernelsOf, relax) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    const auto z = at.z.copy();
    run.relax(at.n, 0.6, at.w.data(), at.z.data());
    for (std::size_t i = 0; i < at.n; ++i) {
      // In Real: the rounding of 0.6, of the product and of the sum, all of them below 2.
      EXPECT_NEAR(static_cast<double>(at.z[i]), static_cast<double>(z[i]) - 0.6 * static_cast<double>(at.w[i]),
                  2 * static_cast<double>(std::numeric_limits<TypeParam>::epsilon()));
    }
  });
}

TYPED_TEST(ContactKernelsOf, correct) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto p = at.p.copy();
    run.correct(at.n, kTrendZ, at.p.data(), at.z.data());
    for (std::size_t i = 0; i < at.n; ++i) {
      const double relaxed = p[i] - (static_cast<double>(at.z[i]) - asked.at(kTrendZ, i));
      if (!(p[i] > 0)) {
        EXPECT_EQ(at.p[i], 0);
      } else {
        EXPECT_GE(at.p[i], 0);
        EXPECT_NEAR(at.p[i], std::max(0.0, relaxed), 32 * kEps);  // terms below 16: a rounding each
      }
    }
  });
}

}  // namespace
}  // namespace brinell::simd
