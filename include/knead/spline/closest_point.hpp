#pragma once

#include <limits>
#include <memory>

#include "knead/spline/spline.hpp"

namespace knead {

/// The point of a spline nearest to a point in space.
template <int D>
struct ClosestPoint {
  std::array<double, D> parameters{};
  Point point = Point::Zero();  ///< the spline there
  double distance = std::numeric_limits<double>::infinity();
  /// No point of the spline is nearer, up to rounding (`ClosestPointSearch::nearest`); never set by
  /// a local search.
  bool certified = false;
};

/// Finds closest points on one curve (D = 1) or surface (D = 2), repeatedly. Immutable, const is
/// thread-safe; copies share the data.
///
/// Ends: the nearest point may lie on the border of the domain, where the distance need not be
/// stationary. Closed splines: of two parameters with the same point, one is returned. Collapsed
/// edges (poles): any parameter along one gives the same point. Of points at the same distance, one
/// is returned.
template <int D>
class ClosestPointSearch {
 public:
  /// Prepares the search: boxes around the Bézier pieces, halved until tangents hardly vary within
  /// one. Cost: linear in the number of spans, and in the area in units of 2 % of the size, about a
  /// microsecond times (p + 1)^D each. Errors (numerical): a rational denominator that is not
  /// positive where it is sampled.
  [[nodiscard]] static Expected<ClosestPointSearch> create(const Spline<D>& spline);

  /// The global closest point, by branch and bound: parts of the spline are discarded by their
  /// boxes, and where interval arithmetic shows that the gradient of |x − S|² does not vanish;
  /// where it shows that the Hessian is positive definite, Newton's iteration finds the unique
  /// minimum; other parts are halved.
  ///
  /// Accuracy where `certified`: nothing is nearer by more than 1e-11 of the size in |x − S|² over
  /// (size + distance), size being half the diagonal of the net's box. Not certified: where 8,000
  /// parts did not suffice, as for points equidistant from the whole spline (a centre), then the
  /// best found; and where a Bézier weight is not positive, so that the convex hull property fails:
  /// local searches start from the four nearest samples, p + 1 per span. Cost: 2 to 100 µs for a
  /// bicubic surface; milliseconds near centres of curvature.
  [[nodiscard]] ClosestPoint<D> nearest(const Point& x) const;

  /// A local minimum of the distance, downhill from `start`: Newton's iteration on |x − S|²/2,
  /// Gauss–Newton where that is not convex, with Levenberg–Marquardt damping, along the border of
  /// the domain where it is reached. \param start  parameters; outside the domain they are moved to
  /// its border. \param closed directions in which the search passes from one end of the domain to
  /// the other. Accuracy: 1e-12 of the domain's length, times the condition of the Hessian. Cost: 3
  /// to 8 evaluations of order 2.
  [[nodiscard]] ClosestPoint<D> nearest_from(const Point& x, const std::array<double, D>& start,
                                             const std::array<bool, D>& closed = {}) const;

 private:
  struct Data;
  explicit ClosestPointSearch(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// The same for one point: `ClosestPointSearch<D>::create(spline)->nearest(x)`. Cost: mostly that
/// of `create`.
template <int D>
[[nodiscard]] Expected<ClosestPoint<D>> closest_point(const Spline<D>& spline, const Point& x);

/// A local minimum without a search to prepare: as `ClosestPointSearch<D>::nearest_from`.
template <int D>
[[nodiscard]] ClosestPoint<D> closest_point_from(const Spline<D>& spline, const Point& x,
                                                 const std::array<double, D>& start,
                                                 const std::array<bool, D>& closed = {});

}  // namespace knead
