#include "contact/passes.h"

#include <algorithm>
#include <cmath>

namespace brinell::contact {

template <class Real>
Passes<Real>::Passes(const parallel::Arena& arena, const simd::KernelTable& kernels, std::size_t nodes)
    : arena_(arena),
      kernels_(kernels.of<Real>().contact),
      nodes_(static_cast<std::int64_t>(nodes)),
      in_contact_((nodes + kBlock - 1) / kBlock, 1),
      moving_(in_contact_.size(), 1) {}

template <class Real>
template <class Sums, class Combine, class Body>
Sums Passes<Real>::over_blocks(const Combine& combine, const Body& body) {
  return ordered_sum<Sums>(arena_, nodes_, kChunk, combine, [&](std::int64_t begin, std::int64_t end) {
    Sums sums{};
    for (std::int64_t first = begin; first < end; first += kBlock) {
      combine(sums, body(first, static_cast<std::size_t>(std::min(kBlock, end - first)),
                         static_cast<std::size_t>(first / kBlock)));
    }
    return sums;
  });
}

namespace {

void add(double& total, double part) {
  total += part;
}

struct MinGap {
  simd::AdvanceSums sums{0, 0, HUGE_VAL, 0};
};

void combine(MinGap& total, const MinGap& part) {
  total.sums.active += part.sums.active;
  total.sums.gap += part.sums.gap;
  total.sums.min_gap = std::min(total.sums.min_gap, part.sums.min_gap);
  total.sums.tension = std::max(total.sums.tension, part.sums.tension);
}

struct Refreshed {
  simd::RefreshSums sums{0, 0, HUGE_VAL, 0, 0};
};

void combine(Refreshed& total, const Refreshed& part) {
  total.sums.active += part.sums.active;
  total.sums.gap += part.sums.gap;
  total.sums.min_gap = std::min(total.sums.min_gap, part.sums.min_gap);
  total.sums.displacement = std::max(total.sums.displacement, part.sums.displacement);
  total.sums.energy += part.sums.energy;
}

void combine(simd::ResidualSums& total, const simd::ResidualSums& part) {
  total.active += part.active;
  total.entered += part.entered;
  total.complementarity += part.complementarity;
  total.barred = std::max(total.barred, part.barred);
}

void combine(simd::DirectionSums& total, const simd::DirectionSums& part) {
  total.z += part.z;
  total.q += part.q;
  total.v += part.v;
  total.zq += part.zq;
  total.vq += part.vq;
}

const auto kCombine = [](auto& total, const auto& part) { combine(total, part); };

}  // namespace

template <class Real>
simd::AdvanceSums Passes<Real>::advance(double step, double* p, const Real* v, double* g, const Real* q) {
  return over_blocks<MinGap>(kCombine,
                             [&](std::int64_t i, std::size_t n, std::size_t) {
                               MinGap part;
                               kernels_.advance(n, step, p + i, v + i, g + i, q + i, &part.sums);
                               return part;
                             })
      .sums;
}

template <class Real>
simd::ResidualSums Passes<Real>::residual(double approach, double seed, double* p, const double* g, Real* z) {
  return over_blocks<simd::ResidualSums>(kCombine, [&](std::int64_t i, std::size_t n, std::size_t block) {
    simd::ResidualSums part;
    kernels_.residual(n, approach, seed, p + i, g + i, z + i, &part);
    in_contact_[block] = part.active > 0 ? 1 : 0;
    return part;
  });
}

template <class Real>
simd::DirectionSums Passes<Real>::correlate(const double* p, const Real* z, const Real* v, const Real* q) {
  return over_blocks<simd::DirectionSums>(kCombine, [&](std::int64_t i, std::size_t n, std::size_t block) {
    simd::DirectionSums part;
    if (in_contact_[block] != 0) kernels_.correlate(n, p + i, z + i, v + i, q + i, &part);
    return part;
  });
}

template <class Real>
double Passes<Real>::redirect(double beta, double mean_v, double mean_z, double approach, const double* p,
                              const double* g, const Real* z, Real* v) {
  return over_blocks<double>(add, [&](std::int64_t i, std::size_t n, std::size_t block) {
    if (in_contact_[block] != 0) {
      moving_[block] = 1;
      return kernels_.redirect(n, beta, mean_v, mean_z, approach, p + i, g + i, z + i, v + i);
    }
    if (moving_[block] != 0) {
      std::fill_n(v + i, n, Real(0));
      moving_[block] = 0;
    }
    return 0.0;
  });
}

template <class Real>
double Passes<Real>::dot(const Real* a, const Real* b) {
  return over_blocks<double>(add, [&](std::int64_t i, std::size_t n, std::size_t block) {
    return moving_[block] != 0 ? kernels_.dot(n, a + i, b + i) : 0.0;
  });
}

template <class Real>
double Passes<Real>::clip(double factor, double* p) {
  return over_blocks<double>(
      add, [&](std::int64_t i, std::size_t n, std::size_t) { return kernels_.clip(n, factor, p + i); });
}

template <class Real>
simd::RefreshSums Passes<Real>::refresh(const UndeformedGap& h, const double* p, double* g) {
  return over_blocks<Refreshed>(kCombine,
                                [&](std::int64_t i, std::size_t n, std::size_t) {
                                  Refreshed part;
                                  kernels_.refresh(n, h.scale, h.origin, h.values + i, p + i, g + i, &part.sums);
                                  return part;
                                })
      .sums;
}

template <class Real>
void Passes<Real>::indicator(const double* p, Real* z) {
  arena_.for_chunks(nodes_, kChunk, [&](std::int64_t begin, std::int64_t end, int) {
    kernels_.indicator(static_cast<std::size_t>(end - begin), p + begin, z + begin);
  });
}

template <class Real>
void Passes<Real>::conductance(const double* p, const Real* z, float* w) {
  arena_.for_chunks(nodes_, kChunk, [&](std::int64_t begin, std::int64_t end, int) {
    kernels_.conductance(static_cast<std::size_t>(end - begin), p + begin, z + begin, w + begin);
  });
}

template <class Real>
double Passes<Real>::sum(const double* p, const Real* z) {
  return correlate(p, z, z, z).z;
}

template <class Real>
double Passes<Real>::correct(double mean_z, double* p, const Real* z) {
  return over_blocks<double>(
      add, [&](std::int64_t i, std::size_t n, std::size_t) { return kernels_.correct(n, mean_z, p + i, z + i); });
}

template class Passes<double>;
template class Passes<float>;

}  // namespace brinell::contact
