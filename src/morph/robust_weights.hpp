#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::morph {

/// What a share of the distances does not exceed. 0 of none.
[[nodiscard]] inline double quantile(std::vector<double>& distances, double share) {
  if (distances.empty()) return 0;
  const double place = share * static_cast<double>(distances.size() - 1);
  const auto at = distances.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(distances.begin(), at, distances.end());
  return *at;
}

/// The standard deviation of distances from 0 that are normally distributed, from their median:
/// 1.4826 median |r| (P. Rousseeuw and C. Croux, 1993). Half of them may be outliers.
[[nodiscard]] inline double median_deviation(std::vector<double> distances) {
  return 1.4826 * quantile(distances, 0.5);
}

/// The same, and at least that of the distance which nine tenths do not exceed, |r|₀.₉ / 1.645: a
/// tenth of outliers hardly counts, and tails that are heavier than normal ones are no outliers.
[[nodiscard]] inline double robust_deviation(std::vector<double> distances) {
  return std::max(1.4826 * quantile(distances, 0.5), quantile(distances, 0.9) / 1.6449);
}

/// J. Tukey's biweight, (1 − (r / c)²)² and 0 beyond c, of c six deviations: 95 % of the weight
/// of normal distances stays. 1 where the deviation is 0.
[[nodiscard]] inline double tukey_weight(double distance, double deviation) {
  if (!(deviation > 0)) return 1;
  const double t = distance / (6 * deviation);
  return t < 1 ? (1 - t * t) * (1 - t * t) : 0.0;
}

/// What feet are off by at most where they are found, of the size.
inline constexpr double search_accuracy = 1e-9;

/// Whether a point is beside its nearest point on a surface with this normal, rather than above or
/// below it: the way between them leans by more than 30° from the normal. So it is only on a border
/// of what is visible. `rounding` is a length that means nothing.
[[nodiscard]] inline bool beside(const Point& way, const Point& normal, double rounding = 0) {
  return (way - way.dot(normal) * normal).norm() > std::max(rounding, 0.5 * way.norm());
}

}  // namespace knead::morph
