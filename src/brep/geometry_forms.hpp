#pragma once

#include <optional>
#include <span>

#include "knead/brep/model.hpp"

/// Curves and surfaces from what files give: directions of any length, axes that need not be
/// perpendicular, lengths that need not be positive. Errors (input) say what is wrong; where, only
/// the reader knows.
namespace knead::brep {

/// None if the axis has zero length, or the reference direction is along it, or a number is above
/// `largest_number`.
[[nodiscard]] std::optional<Frame> frame_of(const Point& origin, const Point& axis,
                                            const Point& reference);

[[nodiscard]] Expected<CurveGeometry> line_of(const Point& origin, const Point& direction,
                                              double magnitude = 1);
/// Semi-axes a and b, along x and y of the frame; of a parabola a = b is the focal length.
[[nodiscard]] Expected<CurveGeometry> conic_of(Conic::Form form, const std::optional<Frame>& frame,
                                               double a, double b);
[[nodiscard]] Expected<CurveGeometry> polyline_of(std::span<const Point> corners);
[[nodiscard]] CurveGeometry spline_of(Curve curve);

/// `second` as in `ElementarySurface`.
[[nodiscard]] Expected<ElementarySurface> elementary_of(ElementarySurface::Kind kind,
                                                        const std::optional<Frame>& frame,
                                                        double radius = 0, double second = 0);

/// Newell's normal of a polygon, twice its area long; zero where it spans no plane.
[[nodiscard]] Point newell_normal(std::span<const Point> polygon);

}  // namespace knead::brep
