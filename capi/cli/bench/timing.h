// Times as ratios to a calibration that is measured in turn, so that what else the machine does cancels.
#pragma once

#include <functional>
#include <vector>

#include "handles.h"

namespace brinell::cli {

struct Band {
  double low = 0;  // 95 % of what the median may be, by bootstrap
  double middle = 0;
  double high = 0;
};

/// Median with its band. The same values give the same band.
Band median_band(const std::vector<double>& values);

/// The repeated measurement of one thing.
class Timing {
 public:
  /// once: carries the thing out and returns its seconds. calibration: index for brn_benchmark_run.
  Timing(brn_engine* engine, int calibration, std::function<double()> once)
      : engine_(engine), calibration_(calibration), once_(std::move(once)) {}

  /// The calibration, the thing, the calibration.
  void measure();

  /// All that was measured.
  void forget();

  Band ratio() const { return median_band(ratios_); }
  double seconds() const { return median_band(seconds_).middle; }
  const char* calibration() const { return brn_benchmark_name(calibration_); }

 private:
  double calibrate() const;

  brn_engine* engine_;
  int calibration_;
  std::function<double()> once_;
  std::vector<double> seconds_, ratios_;
};

/// Processor time of this process, or wall time if the engine has several threads.
double seconds_now(const brn_engine* engine);

}  // namespace brinell::cli
