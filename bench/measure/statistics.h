// Robust statistics of repeated timings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace brinell::bench {

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

struct Band {
  double low = 0;
  double middle = 0;
  double high = 0;
};

/// Median of the values with its 95 % band by bootstrap: medians of samples drawn with replacement. The same values
/// give the same band.
inline Band bootstrap_median(const std::vector<double>& values) {
  constexpr int kSamples = 1000;
  std::mt19937_64 random(1);
  std::vector<double> medians(kSamples), sample(values.size());
  for (double& one : medians) {
    for (double& value : sample) value = values[random() % values.size()];
    one = median(sample);
  }
  std::sort(medians.begin(), medians.end());
  return {medians[kSamples / 40], median(values), medians[kSamples - 1 - kSamples / 40]};
}

}  // namespace brinell::bench
