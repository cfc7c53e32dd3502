#pragma once

#include <array>
#include <functional>
#include <limits>

#include "oracle/occt_gaps.hpp"

namespace knead::oracle {

/// How far the feet of points of an edge on the surfaces of two faces are from each other, and
/// these points from their feet, mm; the angle between the normals there, as the edge runs along
/// both faces, degrees; -1 where a face has no normal, as beside a pole. And the normal curvatures
/// of both across the edge, 1/mm, with the sign that the normals of a smooth edge give them.
struct OcctFigures {
  static constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
  double gap = 0, off_curve = 0, angle = 0;
  std::array<double, 2> curvatures = {not_known, not_known};
};

/// An edge at which two faces meet, in coordinates of their part, mm.
struct OcctMeeting {
  Point start = Point::Zero(), middle = Point::Zero(), end = Point::Zero();
  OcctFigures largest;                          ///< of 201 points
  std::function<OcctFigures(const Point&)> at;  ///< at the point of the edge nearest to this one
};

}  // namespace knead::oracle
