#pragma once

#include <optional>

#include "span_grid.hpp"

namespace knead {

/// A point that moves evenly meets the plane of a triangle that does.
struct PlaneMeeting {
  double time = 0, closing = 0;
  std::array<double, 3> weights = {};  ///< of the corners
};

/// How exactly a point has to meet a triangle.
struct Reach {
  double nearest = 0;  ///< points that were not farther from it do not count
  /// Of its way that it may lack, beyond the tolerance, up to as much as it goes.
  double along = 0;
  double aside = 0;  ///< how far it may pass beside the triangle
};

/// Where a point on its way from `from` to `to` meets a triangle of a patch, or its plane no
/// farther beside it than `reach` says; none where it does not come nearer by more than the
/// tolerance.
///
/// The height above the plane changes evenly between what it is at first and in the end, which is
/// exact where the triangle does not turn; the place in the plane is that of this time.
[[nodiscard]] std::optional<PlaneMeeting> meeting(const Point& from, const Point& to,
                                                  const Patch& of,
                                                  const std::array<std::uint32_t, 3>& corners,
                                                  double tolerance, const Reach& reach);

/// The parameters at weights of the corners of a triangle.
[[nodiscard]] std::array<double, 2> place_in(const Patch& patch,
                                             const std::array<std::uint32_t, 3>& corners,
                                             const std::array<double, 3>& weights);

/// A normal at each corner: the sum of those of its triangles, at first.
[[nodiscard]] std::vector<Point> normals_of(const Patch& patch);

/// Whether a triangle faces the other way than a normal.
[[nodiscard]] bool faces_away(const Patch& patch, const std::array<std::uint32_t, 3>& corners,
                              const Point& normal);

}  // namespace knead
