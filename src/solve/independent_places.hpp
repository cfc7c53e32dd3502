#pragma once

#include <optional>

#include "constraint_space.hpp"
#include "dissection.hpp"

namespace knead::detail {

/// Below so many unknowns there is nothing for threads to share, and L is as small by approximate
/// minimum degree.
inline constexpr int least_dissected = 8000;

/// The places of the independent unknowns of a space, from those of all points; none where the
/// points have none or a matrix of the space is better not dissected.
inline std::optional<GridPlaces> independent_places(const ConstraintSpace& space,
                                                    const GridPlaces* points) {
  if (points == nullptr || space.free_count() < least_dissected) return std::nullopt;
  GridPlaces result{points->directions, {}};
  for (const int i : space.independent()) {
    const int point = space.coupled() ? i / 3 : i;
    for (int d = 0; d < points->directions; ++d) result.indices.push_back(points->at(point, d));
  }
  return result;
}

}  // namespace knead::detail
