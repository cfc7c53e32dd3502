#pragma once

#include <span>

#include "knead/spline/spline.hpp"

namespace knead::morph {

/// A displacement that is an affine function of the place: shift + linear · (x − centre).
struct AffinePart {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  Point shift = Point::Zero(), centre = Point::Zero();

  [[nodiscard]] Point at(const Point& x) const { return shift + linear * (x - centre); }
};

/// The one that makes Σ w |d − shift − linear (x − centre)|² least, centre the weighted mean of the
/// places. Of directions in which the places have no extent (less than 1e-5 of the largest) nothing
/// is known, and the displacement does not depend on them. Accuracy: affine data are reproduced to
/// a few units of rounding of the largest number, by a second solve on what the first one leaves.
/// Errors: a number that is not finite.
/// \param points, displacements N rows \param weights N numbers >= 0
[[nodiscard]] Expected<AffinePart> best_affine(const Points& points, const Points& displacements,
                                               std::span<const double> weights);

}  // namespace knead::morph
