// Every kernel of simd/contact_kernels.h, at every instruction set and in both precisions, against its formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
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
  static constexpr T kCanary = std::is_integral_v<T> ? T(177) : T(-777.25);
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
  Guarded<std::uint8_t> contact;

  Block(std::size_t size, unsigned seed)
      : n(size),
        p(n, seed % 3),
        g(n, seed % 2),
        h(n, seed % 5),
        v(n, seed % 7),
        q(n, 1),
        z(n, seed % 4),
        w(n, 3),
        contact(n, seed % 11) {
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
      contact[i] = random() % 2U;
    }
  }
  bool intact() const {
    return p.intact() && g.intact() && h.intact() && v.intact() && q.intact() && z.intact() && w.intact() &&
           contact.intact();
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
    double tension = 0;
    MomentSums load(asked), gap(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      expect_fused(at.p[i], p[i], 0.3, static_cast<double>(at.v[i]));
      expect_fused(at.g[i], g[i], 0.3, static_cast<double>(at.q[i]));
      tension = std::max(tension, -at.p[i]);
      if (!(at.p[i] > 0)) continue;
      load.add(at.p[i], i);
      gap.add(at.p[i] * at.g[i], i);
    }
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
    const auto before = at.contact.copy();
    const double noise = 0.125, stiffness = 0.5;  // powers of two: products are exact
    ResidualSums sums;
    run.residual(at.n, kApproach, noise, stiffness, at.p.data(), at.g.data(), at.contact.data(), at.z.data(), &sums);
    double active = 0, occupied = 0, changed = 0, depth = 0;
    Sum complementarity;
    for (std::size_t i = 0; i < at.n; ++i) {
      const double r = g[i] - asked.at(kApproach, i);
      depth = std::max(depth, -r);
      const bool on = p[i] > stiffness * (p[i] > 0 ? r : r + noise);
      EXPECT_EQ(at.contact[i], on ? 1 : 0);
      EXPECT_EQ(at.z[i], static_cast<TypeParam>(on ? r : 0));
      active += on ? 1 : 0;
      occupied += on || p[i] != 0 ? 1 : 0;
      changed += on != (before[i] != 0) ? 1 : 0;
      complementarity.add(std::fabs(static_cast<long double>(p[i]) * r));
    }
    EXPECT_EQ(at.p.copy(), p);
    EXPECT_EQ(at.g.copy(), g);
    EXPECT_EQ(sums.active, active);
    EXPECT_EQ(sums.occupied, occupied);
    EXPECT_EQ(sums.changed, changed);
    EXPECT_EQ(sums.depth, depth);
    complementarity.expect(sums.complementarity, "complementarity");
  });
}

TYPED_TEST(ContactKernelsOf, correlate) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    CorrelationSums sums;
    run.correlate(at.n, kPlaces, at.contact.data(), at.z.data(), at.v.data(), at.q.data(), &sums);
    MomentSums active(asked), z(asked), q(asked), v(asked);
    Sum zq, vq;
    for (std::size_t i = 0; i < at.n; ++i) {
      if (at.contact[i] == 0) continue;
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

/// In contact, and left some pressure by the direction.
template <class Real>
bool is_free(const Block<Real>& at, std::size_t i) {
  return at.contact[i] != 0 && at.v[i] > static_cast<Real>(-at.p[i]);
}

TYPED_TEST(ContactKernelsOf, redirect) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto v = at.v.copy();
    const double beta = 0.7, scale = 1.5;
    const double rounding = static_cast<double>(std::numeric_limits<TypeParam>::epsilon());
    DirectionSums sums;
    run.redirect(at.n, kPlaces, beta, kTrendV, scale, kTrendZ, at.contact.data(), at.p.data(), at.z.data(),
                 at.v.data(), &sums);
    MomentSums load(asked), free(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      const double wanted = beta * (static_cast<double>(v[i]) - asked.at(kTrendV, i)) -
                            scale * (static_cast<double>(at.z[i]) - asked.at(kTrendZ, i));
      const double direction = at.contact[i] != 0 ? std::max(wanted, -at.p[i]) : -at.p[i];
      // Terms below 16: a rounding each, and that of the result to Real.
      EXPECT_NEAR(static_cast<double>(at.v[i]), direction, 32 * kEps + 16 * rounding);
      if (direction == -at.p[i]) {
        EXPECT_EQ(at.v[i], static_cast<TypeParam>(-at.p[i]));
      }
      load.add(at.p[i] + direction, i);
      for (int terms = 0; terms < 32; ++terms) load.add(0, i);  // their roundings
      free.add(is_free(at, i) ? 1 : 0, i);
    }
    load.expect(sums.load, "load");
    free.expect(sums.free, "free");
  });
}

TYPED_TEST(ContactKernelsOf, balance_and_curvature) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    for (std::size_t i = 0; i < at.n; i += 3) at.v[i] = static_cast<TypeParam>(-at.p[i]);  // not free
    const auto v = at.v.copy();
    std::vector<bool> free_before(at.n);
    for (std::size_t i = 0; i < at.n; ++i) free_before[i] = is_free(at, i);
    const SlopeSums sums =
        run.balance(at.n, kTrendZ, kApproach, at.contact.data(), at.p.data(), at.g.data(), at.v.data());
    Sum expected_slope, expected_taken, expected_curvature;
    for (std::size_t i = 0; i < at.n; ++i) {
      const double shifted = std::max(static_cast<double>(v[i]) + asked.at(kTrendZ, i), -at.p[i]);
      if (free_before[i]) {
        // A rounding of the sum, whose terms are below 16, and that to Real.
        EXPECT_NEAR(static_cast<double>(at.v[i]), shifted,
                    16 * (kEps + static_cast<double>(std::numeric_limits<TypeParam>::epsilon())));
      } else {
        EXPECT_EQ(at.v[i], v[i]);
      }
      const long double work = static_cast<long double>(at.v[i]) * (at.g[i] - asked.at(kApproach, i));
      Sum& part = is_free(at, i) ? expected_slope : expected_taken;
      part.add(is_free(at, i) ? work : std::abs(work));
      part.add(0);  // the rounding of the difference
      if (!is_free(at, i)) continue;
      expected_curvature.add(static_cast<long double>(at.v[i]) * at.q[i]);
    }
    expected_slope.expect(sums.free, "slope");
    expected_taken.expect(sums.taken, "taken");
    expected_curvature.expect(run.curvature(at.n, at.contact.data(), at.p.data(), at.v.data(), at.q.data()),
                              "curvature");
  });
}

TYPED_TEST(ContactKernelsOf, weigh) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    Sum weigh;
    for (std::size_t i = 0; i < at.n; ++i) weigh.add(static_cast<long double>(at.w[i]) * at.z[i]);
    weigh.expect(run.weigh(at.n, at.w.data(), at.z.data()), "weigh");
  });
}

TYPED_TEST(ContactKernelsOf, carried_and_clip) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked& asked) {
    const auto p = at.p.copy();
    const QuadraticSums sums = run.carried(at.n, kPlaces, kFactor, at.contact.data(), at.p.data());
    EXPECT_EQ(at.p.copy(), p);
    run.clip(at.n, kFactor, at.contact.data(), at.p.data());
    MomentSums expected(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      const double factor = asked.at(kFactor, i);
      const bool carries = at.contact[i] != 0 && p[i] > 0 && factor > 0;
      EXPECT_EQ(at.p[i], carries ? p[i] * factor : 0);
      EXPECT_FALSE(std::signbit(at.p[i]));
      expected.add(carries ? p[i] : 0, i);
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
    double displacement = 0;
    MomentSums load(asked), gap(asked);
    for (std::size_t i = 0; i < at.n; ++i) {
      expect_fused(at.g[i], u[i], scale, at.h[i] - origin);
      displacement = std::max(displacement, std::fabs(u[i]));
      if (!(p[i] > 0)) continue;
      load.add(at.p[i], i);
      gap.add(at.p[i] * at.g[i], i);
    }
    EXPECT_EQ(at.p.copy(), p);
    load.expect(sums.load, "load");
    gap.expect(sums.gap, "gap");
    EXPECT_EQ(sums.displacement, displacement);
  });
}

TYPED_TEST(ContactKernelsOf, indicator_and_conductance) {
  for_every_block<TypeParam>([](const ContactKernels<TypeParam>& run, Block<TypeParam>& at, const Asked&) {
    run.conductance(at.n, at.contact.data(), at.z.data(), at.w.data());
    for (std::size_t i = 0; i < at.n; ++i) {
      EXPECT_EQ(at.w[i], at.contact[i] != 0 && at.z[i] > 0 ? static_cast<float>(at.z[i]) : 0.0F);
    }
    run.indicator(at.n, at.contact.data(), at.z.data());
    for (std::size_t i = 0; i < at.n; ++i) EXPECT_EQ(at.z[i], static_cast<TypeParam>(at.contact[i]));
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

}  // namespace
}  // namespace brinell::simd
