#pragma once

#include <vector>

#include "knead/tool/shape.hpp"

namespace knead {

/// A height field over the square −1 ≤ ξ, η ≤ 1, which the brush `stamp` presses (docs/brushes.md):
/// samples at the nodes of an even grid, linear in each direction in between. The first row is that
/// of η = 1, like the top of an image, and the first column that of ξ = −1. A value; empty by
/// default.
struct StampPattern {
  int columns = 0;
  std::vector<double> heights = {};  ///< row by row

  [[nodiscard]] bool empty() const { return heights.empty(); }
  /// The height at a point of the square, 0 outside. Cost: O(1).
  [[nodiscard]] double at(double xi, double eta) const;

  friend bool operator==(const StampPattern&, const StampPattern&) = default;
};

/// The height of a shape as it is seen from above, along its own z: from 0 at the lowest point that
/// is seen to 1 at the highest one, 0 beside the shape; 1 all over where all that is seen is of one
/// height. The shape is as wide as the part |ξ|, |η| ≤ `width` of the square. 97 × 97 samples, each
/// to 1e-9 of the size, by stepping down a ray by the distance. Errors (input): a shape without
/// bounds; those of PlacedShape. Cost: some 10⁵ distances.
[[nodiscard]] Expected<StampPattern> stamp_of(const Shape& shape, double width);

/// The weight of a stamp at its rim: f(|ξ|) f(|η|), f the falloff of brushes over 1 from the core
/// on.
[[nodiscard]] double stamp_rim(double xi, double eta, double core);

}  // namespace knead
