// Orders of convergence from errors on several grids.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace brinell::support {

/// Errors of one quantity, against the spacing.
class Convergence {
 public:
  void add(double spacing, double value, double exact) {
    spacings_.push_back(spacing);
    errors_.push_back(std::fabs(value / exact - 1));
  }

  /// Slope of log(error) over log(spacing) by least squares.
  double order() const {
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    const double n = static_cast<double>(errors_.size());
    for (std::size_t k = 0; k < errors_.size(); ++k) {
      mean_x += std::log(spacings_[k]) / n;
      mean_y += std::log(errors_[k]) / n;
    }
    for (std::size_t k = 0; k < errors_.size(); ++k) {
      const double x = std::log(spacings_[k]) - mean_x;
      xx += x * x;
      xy += x * (std::log(errors_[k]) - mean_y);
    }
    return xy / xx;
  }

  double last() const { return errors_.back(); }  // relative error on the finest grid
  const std::vector<double>& errors() const { return errors_; }

 private:
  std::vector<double> spacings_, errors_;
};

}  // namespace brinell::support
