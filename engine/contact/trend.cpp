#include "contact/trend.h"

#include <Eigen/Eigenvalues>

namespace brinell::contact {

PlaneSums PlaneWeights::times(const LinearTrend& a) const {
  return {one * a.constant + x * a.x + y * a.y, x * a.constant + xx * a.x + xy * a.y,
          y * a.constant + xy * a.x + yy * a.y};
}

LinearTrend fit(Freedom freedom, const PlaneWeights& weights, const PlaneSums& sums, const LinearTrend& start,
                double least_variance) {
  if (freedom == Freedom::none) return start;
  if (freedom == Freedom::constant) {
    return {(sums.one - weights.x * start.x - weights.y * start.y) / weights.one, start.x, start.y};
  }
  // The change from start, about the weights' centre, where constant and slopes part.
  const PlaneSums reached = weights.times(start);
  const double mean_x = weights.x / weights.one, mean_y = weights.y / weights.one;
  const double lacking = (sums.one - reached.one) / weights.one;
  const Eigen::Vector2d moments((sums.x - reached.x) / weights.one - mean_x * lacking,
                                (sums.y - reached.y) / weights.one - mean_y * lacking);
  Eigen::Matrix2d variance;
  variance << weights.xx / weights.one - mean_x * mean_x, weights.xy / weights.one - mean_x * mean_y,
      weights.xy / weights.one - mean_x * mean_y, weights.yy / weights.one - mean_y * mean_y;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(variance);
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const double along = axes.eigenvalues()[k];
    if (along > least_variance)
      slopes += axes.eigenvectors().col(k).dot(moments) / along * axes.eigenvectors().col(k);
  }
  return {start.constant + lacking - slopes[0] * mean_x - slopes[1] * mean_y, start.x + slopes[0],
          start.y + slopes[1]};
}

}  // namespace brinell::contact
