#pragma once

#include "commands/new.hpp"

namespace knead {

// What new surfaces, curves and volumes share, and the making of the latter two.

/// Error (input), named `where`: not a length above 0.
[[nodiscard]] Expected<void> positive(double value, const char* where);

/// Errors (input): not one positive weight for each of `count` control points; none at all is
/// right.
[[nodiscard]] Expected<void> check_weights(const std::vector<double>& weights, int count);

/// Errors (input): `degree`, `net` or `size` has neither one number nor one for each direction.
[[nodiscard]] Expected<void> check_counts(const NewCommand& c, std::size_t directions);

/// The knots of one direction, as given, or clamped and uniform with `count` functions. Errors name
/// the field, or `counted_by`.
[[nodiscard]] Expected<KnotVector> knots_of(const NewCommand& c, std::size_t d, int count,
                                            const char* counted_by);

/// The spline with its origin at `position`; bits are unchanged where that is zero.
template <int D>
[[nodiscard]] Expected<Spline<D>> placed(Spline<D> spline, const Vector3& position) {
  if (position == Vector3{0, 0, 0}) return spline;
  Points points = spline.control_points();
  points.rowwise() += Eigen::RowVector3d(position[0], position[1], position[2]);
  return spline.with_control_points(std::move(points));
}

/// Whether the command makes a curve or a volume.
[[nodiscard]] inline bool makes_body(const NewCommand& c) {
  return c.shape == "curve" || c.shape == "volume";
}

/// The curve or volume of the command, named by its form. What is not exact is noted with its
/// error.
[[nodiscard]] Expected<SceneBody> new_body(const NewCommand& c, std::vector<std::string>& notes);

}  // namespace knead
