#pragma once

#include <array>

#include "knead/spline/spline.hpp"

namespace knead {

/// Where a function of a surface is largest, and its value there.
struct SurfaceMaximum {
  double value = 0;
  std::array<double, 2> parameters{};
};

/// max |S(u, v)| over the whole domain: for a displacement field, the largest displacement.
///
/// The surface is sampled p + 3 times per span and direction, span ends from both sides included;
/// the best local maxima of the samples are refined by projected Newton steps and a compass search.
/// Accuracy: 1e-9 relative, provided that the samples catch the highest peak (a peak narrower than
/// a third of a span can be missed). Where all weights are positive, spans whose control points are
/// all shorter than the largest value found are skipped. Cost: a pass over the control points, the
/// samples of the other spans, and eight refinements.
[[nodiscard]] SurfaceMaximum largest_norm(const Surface& surface);

/// Whether both have the same knots and weights, bit for bit: then their difference is the spline
/// of the differences of their control points.
[[nodiscard]] bool same_basis(const Surface& a, const Surface& b);

/// max |a(u, v) − b(u, v)| over their domain. Requires: the same domain (asserted).
/// With the same basis it is `largest_norm` of the difference. Otherwise both are sampled p + 3
/// times per span of either, p the larger degree, and the largest of these is refined by a compass
/// search to 1e-6 of a sample distance, which is 1e-9 relative under the proviso of `largest_norm`,
/// or 1e-6 for a maximum at a crease. NaN where a denominator is not positive.
[[nodiscard]] double largest_distance(const Surface& a, const Surface& b);

/// The axis-aligned box of the surface itself, not of its control points.
struct BoundingBox {
  Point lower = Point::Zero(), upper = Point::Zero();
  [[nodiscard]] double diagonal() const { return (upper - lower).norm(); }
  [[nodiscard]] Point centre() const { return lower + 0.5 * (upper - lower); }
};

/// Found like `largest_norm`, coordinate by coordinate; accuracy 1e-9 of the diagonal under the
/// same proviso.
[[nodiscard]] BoundingBox bounding_box(const Surface& surface);

}  // namespace knead
