#include "fft/plan_cache.h"

#include <fftw3.h>

#include <cstdlib>

#include "base/error.h"

namespace brinell::fft {

namespace {

/// FFTW's planner and wisdom are global to the process.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

template <class Real>
struct Library;  // FFTW's functions of one precision

template <>
struct Library<double> {
  using Plan = fftw_plan;
  using Complex = fftw_complex;
  static constexpr auto allocate = fftw_malloc;
  static constexpr auto release = fftw_free;
  static constexpr auto plan_complex = fftw_plan_dft_1d;
  static constexpr auto plan_to_complex = fftw_plan_dft_r2c_1d;
  static constexpr auto plan_to_real = fftw_plan_dft_c2r_1d;
  static constexpr auto plan_real = fftw_plan_r2r_1d;
  static constexpr auto destroy = fftw_destroy_plan;
  static constexpr auto execute_complex = fftw_execute_dft;
  static constexpr auto execute_to_complex = fftw_execute_dft_r2c;
  static constexpr auto execute_to_real = fftw_execute_dft_c2r;
  static constexpr auto execute_real = fftw_execute_r2r;
  static constexpr auto export_wisdom = fftw_export_wisdom_to_string;
  static constexpr auto import_wisdom = fftw_import_wisdom_from_string;
  static constexpr auto forget_wisdom = fftw_forget_wisdom;
};

template <>
struct Library<float> {
  using Plan = fftwf_plan;
  using Complex = fftwf_complex;
  static constexpr auto allocate = fftwf_malloc;
  static constexpr auto release = fftwf_free;
  static constexpr auto plan_complex = fftwf_plan_dft_1d;
  static constexpr auto plan_to_complex = fftwf_plan_dft_r2c_1d;
  static constexpr auto plan_to_real = fftwf_plan_dft_c2r_1d;
  static constexpr auto plan_real = fftwf_plan_r2r_1d;
  static constexpr auto destroy = fftwf_destroy_plan;
  static constexpr auto execute_complex = fftwf_execute_dft;
  static constexpr auto execute_to_complex = fftwf_execute_dft_r2c;
  static constexpr auto execute_to_real = fftwf_execute_dft_c2r;
  static constexpr auto execute_real = fftwf_execute_r2r;
  static constexpr auto export_wisdom = fftwf_export_wisdom_to_string;
  static constexpr auto import_wisdom = fftwf_import_wisdom_from_string;
  static constexpr auto forget_wisdom = fftwf_forget_wisdom;
};

template <class Real>
std::string current_wisdom() {
  char* text = Library<Real>::export_wisdom();
  if (text == nullptr) fail(Status::out_of_memory, "FFTW could not write its wisdom");
  std::string wisdom(text);
  std::free(text);  // NOLINT(cppcoreguidelines-no-malloc): allocated by FFTW
  return wisdom;
}

/// While it lives, FFTW knows the given wisdom alone; then the host program's is put back. Hold the planner's lock.
template <class Real>
class WisdomScope {
 public:
  explicit WisdomScope(const std::string& wisdom) : host_(current_wisdom<Real>()) {
    Library<Real>::forget_wisdom();
    valid_ = wisdom.empty() || Library<Real>::import_wisdom(wisdom.c_str()) != 0;
  }
  ~WisdomScope() {
    Library<Real>::forget_wisdom();
    Library<Real>::import_wisdom(host_.c_str());
  }
  WisdomScope(const WisdomScope&) = delete;
  WisdomScope& operator=(const WisdomScope&) = delete;

  bool valid() const { return valid_; }

 private:
  std::string host_;
  bool valid_;
};

template <class Real>
typename Library<Real>::Plan make_plan(Kind kind, int n, Real* in, Real* out, unsigned flags) {
  using Complex = typename Library<Real>::Complex;
  auto* numbers_in = reinterpret_cast<Complex*>(in);
  auto* numbers_out = reinterpret_cast<Complex*>(out);
  switch (kind) {
    case Kind::complex_forward: return Library<Real>::plan_complex(n, numbers_in, numbers_out, FFTW_FORWARD, flags);
    case Kind::complex_backward: return Library<Real>::plan_complex(n, numbers_in, numbers_out, FFTW_BACKWARD, flags);
    case Kind::real_to_complex: return Library<Real>::plan_to_complex(n, in, numbers_out, flags);
    case Kind::complex_to_real: return Library<Real>::plan_to_real(n, numbers_in, out, flags);
    case Kind::cosines: return Library<Real>::plan_real(n, in, out, FFTW_REDFT01, flags);
    case Kind::sines: return Library<Real>::plan_real(n, in, out, FFTW_RODFT01, flags);
  }
  return nullptr;
}

template <class Real>
auto execution(Kind kind) -> void (*)(void*, Real*, Real*) {
  using Plan = typename Library<Real>::Plan;
  using Complex = typename Library<Real>::Complex;
  switch (kind) {
    case Kind::complex_forward:
    case Kind::complex_backward:
      return [](void* plan, Real* in, Real* out) {
        Library<Real>::execute_complex(static_cast<Plan>(plan), reinterpret_cast<Complex*>(in),
                                       reinterpret_cast<Complex*>(out));
      };
    case Kind::real_to_complex:
      return [](void* plan, Real* in, Real* out) {
        Library<Real>::execute_to_complex(static_cast<Plan>(plan), in, reinterpret_cast<Complex*>(out));
      };
    case Kind::complex_to_real:
      return [](void* plan, Real* in, Real* out) {
        Library<Real>::execute_to_real(static_cast<Plan>(plan), reinterpret_cast<Complex*>(in), out);
      };
    case Kind::cosines:
    case Kind::sines: break;
  }
  return [](void* plan, Real* in, Real* out) { Library<Real>::execute_real(static_cast<Plan>(plan), in, out); };
}

}  // namespace

template <>
PlanCache::Plans<double>& PlanCache::plans<double>() {
  return in_double_;
}
template <>
PlanCache::Plans<float>& PlanCache::plans<float>() {
  return in_single_;
}
template <>
const PlanCache::Plans<double>& PlanCache::plans<double>() const {
  return in_double_;
}
template <>
const PlanCache::Plans<float>& PlanCache::plans<float>() const {
  return in_single_;
}

template <class Real>
Transform<Real> PlanCache::transform(Kind kind, std::int64_t n) {
  if (n < 1 || n > INT32_MAX / 4) {
    fail(Status::too_large, "transform length " + std::to_string(n) + " is not within 1 .. 536870911");
  }
  const std::lock_guard lock(mutex_);
  Plans<Real>& mine = plans<Real>();
  if (const auto found = mine.made.find({kind, n}); found != mine.made.end()) return found->second;

  const auto plan = [&] {
    const std::lock_guard planner_lock(planner_mutex());
    const WisdomScope<Real> scope(mine.wisdom);
    // Room for two arrays, each aligned like those that will be transformed.
    const std::size_t room = (2 * static_cast<std::size_t>(n) + 2 + 15) / 16 * 16;
    const std::unique_ptr<void, void (*)(void*)> memory(Library<Real>::allocate(2 * sizeof(Real) * room),
                                                        Library<Real>::release);
    if (memory == nullptr)
      fail(Status::out_of_memory, "no memory to plan a transform of length " + std::to_string(n));
    const unsigned flags = planning_ == Planning::measure ? FFTW_MEASURE : FFTW_ESTIMATE;
    auto* in = static_cast<Real*>(memory.get());
    const auto made = make_plan(kind, static_cast<int>(n), in, in + room, flags);
    if (planning_ == Planning::measure) mine.wisdom = current_wisdom<Real>();
    return made;
  }();
  if (plan == nullptr) fail(Status::internal, "FFTW has no plan for length " + std::to_string(n));

  Transform<Real> transform;
  transform.plan_ = std::shared_ptr<void>(plan, [](void* planned) {
    const std::lock_guard release_lock(planner_mutex());
    Library<Real>::destroy(static_cast<typename Library<Real>::Plan>(planned));
  });
  transform.execute_ = execution<Real>(kind);
  mine.made.emplace(std::tuple{kind, n}, transform);
  return transform;
}

template <class Real>
void PlanCache::import_wisdom(const std::string& wisdom) {
  const std::lock_guard lock(mutex_);
  {
    const std::lock_guard planner_lock(planner_mutex());
    const WisdomScope<Real> scope(wisdom);
    if (!scope.valid()) {
      fail(Status::damaged_data, std::string("the text given as ") +
                                     (sizeof(Real) == sizeof(double) ? "double" : "single") +
                                     "-precision wisdom is not wisdom of this FFTW");
    }
  }
  plans<Real>().wisdom = wisdom;
}

template <class Real>
std::string PlanCache::export_wisdom() const {
  const std::lock_guard lock(mutex_);
  return plans<Real>().wisdom;
}

template Transform<double> PlanCache::transform<double>(Kind, std::int64_t);
template Transform<float> PlanCache::transform<float>(Kind, std::int64_t);
template void PlanCache::import_wisdom<double>(const std::string&);
template void PlanCache::import_wisdom<float>(const std::string&);
template std::string PlanCache::export_wisdom<double>() const;
template std::string PlanCache::export_wisdom<float>() const;

}  // namespace brinell::fft
