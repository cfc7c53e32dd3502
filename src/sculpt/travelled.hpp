#pragma once

#include <span>

#include "spline/interpolation/site_values.hpp"

namespace knead {

/// Where a tool was, and where it is.
struct Travel {
  Point from, to;
};

/// A displacement of a shape (coefficients, N × 3) that tools have caused, as it would about be
/// after they have travelled a little: at each Greville abscissa as much as it was as far away in
/// the domain as the feet of the nearest tool are from each other, turned as the normal turns
/// between them. A guess: exact where the shape is a plane with even parameters. Where a foot is on
/// the border, the way there follows from the tangents; outside of the domain the displacement is
/// that of its border. `values` are those of the shape. Without travels, or where the shape has no
/// tangents at a foot: as it is. Cost: O(N p) per travel, and a search for two feet.
[[nodiscard]] Points travelled(const Surface& shape, const SiteValues<2>& values,
                               const Points& displacement, std::span<const Travel> travels);

}  // namespace knead
