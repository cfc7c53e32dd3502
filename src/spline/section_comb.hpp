#pragma once

#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// The points p with normal · p = offset.
struct SectionPlane {
  Point normal = Point::UnitX();  ///< of length 1
  double offset = 0;
};

/// Curvature along one curve in which a plane cuts a surface, tooth by tooth.
struct SectionComb {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> parameters;  ///< one row per tooth
  Points places;  ///< likewise, on the surface and the plane
  /// κN of the plane curve, 1/length: in the plane, towards the centre of curvature; zero where the
  /// curve is straight, where the plane touches the surface, and where the surface has no tangent
  /// plane.
  Points vectors;
};

/// The curves in which a plane cuts a surface, with their curvature from the derivatives of the
/// surface: the tangent is t = m × n / |m × n| with the normals m of the plane and n = S_u × S_v /
/// |S_u × S_v| of the surface, the normal curvature k = II(t, t), and by Meusnier's theorem κN = k
/// / (b · n) b with b = t × m (do Carmo, Differential Geometry of Curves and Surfaces, 3.2).
///
/// Teeth are where the curves cross the lines of a grid whose chords are within `tolerance` of the
/// surface
/// (`grid_lines`); a curve that crosses none of them is not found. Curves whose ends meet repeat
/// their first tooth. At a knot where curvature jumps, it is that of larger parameters. Accuracy:
/// teeth are on the plane to 1e-12 of the extent of the control points; curvature is exact there
/// but for rounding, divided by the sine of the angle between plane and tangent plane. Cost: a grid
/// evaluation, and about six of order 1 at the teeth. Errors: a normal whose length is not 1, to
/// 1e-9, or a tolerance that is not positive (usage); a denominator that is not positive
/// (numerical).
[[nodiscard]] Expected<std::vector<SectionComb>> section_combs(const Surface& surface,
                                                               const SectionPlane& plane,
                                                               double tolerance);

}  // namespace knead
