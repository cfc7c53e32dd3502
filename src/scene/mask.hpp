#pragma once

#include "scene.hpp"

namespace knead {

/// The control points that the mask of a surface holds: those whose weight is 1. Empty: none.
[[nodiscard]] std::vector<bool> masked_points(const SceneSurface& surface);

/// The mask as a spline of its surface, in the first coordinate. Requires: there is one.
[[nodiscard]] Expected<Surface> mask_field(const SceneSurface& surface);

/// The mask of one shape on the net of another with the same domain: the weight of a control point
/// is the value of the mask at its Greville abscissae. Errors: those of evaluation.
[[nodiscard]] Expected<std::vector<double>> mask_on(const Surface& field, const Surface& shape);

/// What is done to a whole mask.
enum class MaskChange {
  clear,   ///< nothing is masked
  fill,    ///< all is
  invert,  ///< m → 1 − m
  blur,    ///< the mean within a radius, weighed by a falloff and areas
  grow,    ///< the largest within a radius
  shrink,  ///< the smallest within a radius
};

/// Changes the mask of a surface; `radius` is a length in space. Errors: those of evaluation. Cost:
/// of blur, grow and shrink the square of the number of control points.
[[nodiscard]] Expected<void> change_mask(SceneSurface& surface, MaskChange change, double radius);

}  // namespace knead
