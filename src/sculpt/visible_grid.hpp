#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "knead/sculpt/visible_region.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::detail {

/// The visible point with the least `cost(place)`, by grids of ever smaller extent round the best one so far. None
/// where no point of the first grid is visible.
template <class Cost>
[[nodiscard]] Expected<std::optional<VisiblePoint>> least_visible(const Surface& surface, const VisibleRegion& region,
                                                                  const Cost& cost) {
  constexpr int first = 41, later = 9, rounds = 8;
  auto [lower, upper] = region.extent();
  std::optional<VisiblePoint> best;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round <= rounds; ++round) {
    const int count = round == 0 ? first : later;
    const Eigen::Vector2d step = (upper - lower) / count;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const Eigen::Vector2d at = lower + step.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5));
        if (at.minCoeff() < 0 || at.maxCoeff() > 1 || !region.contains(at)) continue;
        const auto place = evaluate_point<2>(surface, parameters_of(surface, at));
        if (!place) return std::unexpected(place.error());
        const double value = cost(*place);
        if (!(value < least)) continue;
        least = value;
        best = VisiblePoint{at, *place, value};
      }
    }
    if (!best) return best;
    lower = best->at - 1.2 * step;
    upper = best->at + 1.2 * step;
  }
  return best;
}

}  // namespace knead::detail
