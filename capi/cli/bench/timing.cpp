#include "bench/timing.h"

#include <algorithm>
#include <ctime>
#include <random>

namespace brinell::cli {

namespace {

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

Band median_band(const std::vector<double>& values) {
  constexpr std::size_t kSamples = 2000;
  std::mt19937_64 random(1);
  std::vector<double> medians(kSamples), sample(values.size());
  for (double& one : medians) {
    for (double& value : sample) value = values[random() % values.size()];
    one = median(sample);
  }
  std::sort(medians.begin(), medians.end());
  sample = values;
  return {medians[kSamples / 40], median(sample), medians[kSamples - 1 - kSamples / 40]};
}

double Timing::calibrate() const {
  double seconds = 0;
  const brn_status status = brn_benchmark_run(engine_, calibration_, &seconds);
  if (status != BRN_OK) throw EngineError(status, brn_engine_message(engine_));
  return seconds;
}

void Timing::measure() {
  const double before = calibrate();
  const double seconds = once_();
  const double after = calibrate();
  seconds_.push_back(seconds);
  ratios_.push_back(2 * seconds / (before + after));
}

void Timing::forget() {
  seconds_.clear();
  ratios_.clear();
}

double seconds_now(const brn_engine* engine) {
  std::timespec now{};
  clock_gettime(brn_engine_threads(engine) > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace brinell::cli
