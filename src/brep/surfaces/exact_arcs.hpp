#pragma once

#include <functional>

#include "knead/spline/spline.hpp"

namespace knead::brep {

/// A piece of a conic as a rational quadratic Bézier curve between weights 1: where the tangents at
/// its ends meet, and the weight there.
struct ConicCorner {
  Point place = Point::Zero();
  double weight = 1;
};

/// A conic over `range` in `pieces` even parts as one rational B-spline curve of degree 2 on the
/// same parameters, its inner knots double (Piegl & Tiller, The NURBS Book, 7.3 and 7.6). It passes
/// through `at` of every part's ends; between them it is the same curve, but runs through it at
/// another speed. \param at the point of a parameter \param corner of the part between two
/// parameters \param closed the end is the start, bit for bit
[[nodiscard]] Expected<Curve> conic_spline(
    const Interval& range, int pieces, bool closed, const std::function<Point(double)>& at,
    const std::function<ConicCorner(double, double)>& corner);

/// The ellipse centre + cos(t) a + sin(t) b over `range`, of which a whole turn is closed, in parts
/// of at most a quarter. With m and h the middle and half length of a part its corner is centre +
/// (cos(m) a + sin(m) b) / cos(h), and its weight cos(h).
[[nodiscard]] Expected<Curve> ellipse_spline(const Point& centre, const Point& a, const Point& b,
                                             const Interval& range);

/// Whether an angle is a whole turn, to rounding.
[[nodiscard]] bool whole_turn(double angle);

/// The surface that a curve sweeps along u over the angles `turn` about an axis (The NURBS
/// Book, 8.5), exact but for rounding: u the angle at every end of a part of at most a quarter, v
/// the parameter of the curve. Where the curve meets the axis, and over a whole turn, control
/// points are equal to the last bit. \param axis of unit length
[[nodiscard]] Expected<Surface> swept_about(const Curve& profile, const Point& origin,
                                            const Point& axis, const Interval& turn);

/// The surface curve(u) + v direction for v in `along`, exact but for rounding.
[[nodiscard]] Expected<Surface> swept_along(const Curve& profile, const Point& direction,
                                            const Interval& along);

}  // namespace knead::brep
