// One-dimensional transforms by FFTW: the only part of the engine that knows FFTW. Plans are single-threaded,
// contiguous and out of place (where FFTW's estimate is a third faster than in place), and are chosen by estimate or
// from given wisdom, never by a timing, so that a size is always transformed by the same operations: the same bits in
// every process. FFTW's planner is one per process; a lock shared by all caches guards it, and wisdom that the host
// program gathered is neither used nor changed.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

namespace brinell::fft {

/// What a plan computes, in FFTW's conventions: no normalisation, complex numbers interleaved, forward = exp(−i…).
enum class Kind : std::int32_t {
  complex_forward,   // n complex values
  complex_backward,  //
  real_to_complex,   // n reals -> n/2 + 1 complex values
  complex_to_real,   // the reverse; destroys its input
  cosines,           // REDFT01: Y_k = X_0 + 2 Σ_{j=1}^{n−1} X_j cos(π j (k + 1/2) / n)
  sines,             // RODFT01: Y_k = (−1)^k X_{n−1} + 2 Σ_{j=0}^{n−2} X_j sin(π (j + 1) (k + 1/2) / n)
};

/// A planned transform. Copies share the plan; use from several threads at a time is safe.
template <class Real>
class Transform {
 public:
  Transform() = default;

  /// in and out are different arrays, aligned to 16 bytes.
  void operator()(Real* in, Real* out) const { execute_(plan_.get(), in, out); }

 private:
  friend class PlanCache;
  std::shared_ptr<void> plan_;
  void (*execute_)(void* plan, Real* in, Real* out) = nullptr;
};

class PlanCache {
 public:
  /// How FFTW chooses. Only estimate gives the same bits in every process; measure is for benchmarks and for
  /// gathering wisdom.
  enum class Planning : std::int32_t { estimate, measure };

  explicit PlanCache(Planning planning = Planning::estimate) : planning_(planning) {}

  /// The transform of length n >= 1; planned at the first request. Real is float or double.
  template <class Real>
  Transform<Real> transform(Kind kind, std::int64_t n);

  /// Wisdom for the plans that follow, as text that export_wisdom gave (of any program that uses FFTW). Empty text
  /// forgets it. Throws Status::damaged_data if it is not such a text.
  template <class Real>
  void import_wisdom(const std::string& wisdom);

  /// What was imported, and what planning by measure has added.
  template <class Real>
  std::string export_wisdom() const;

 private:
  template <class Real>
  struct Plans {
    std::map<std::tuple<Kind, std::int64_t>, Transform<Real>> made;
    std::string wisdom;
  };

  template <class Real>
  Plans<Real>& plans();
  template <class Real>
  const Plans<Real>& plans() const;

  Planning planning_;
  mutable std::mutex mutex_;  // guards the members below
  Plans<double> in_double_;
  Plans<float> in_single_;
};

}  // namespace brinell::fft
