#pragma once

#include <vector>

#include "knead/spline/spline.hpp"

namespace knead {

/// A path of straight pieces, taken at places of the same distance along it, however many points it
/// was given by.
///
/// The places are the first point and then one at every `spacing` of arc length; what is left over
/// of one piece counts for the next. A path that is given in several parts has the places of the
/// whole, to the last bit. A value.
struct ToolPath {
  double spacing = 1;         ///< > 0
  double rest = 0;            ///< way from the last place to the end, less than `spacing`
  Point end = Point::Zero();  ///< where the path has come to
  bool begun = false;         ///< whether it has a point

  /// Goes on to a point; appends the places on the way there. Cost: O(places).
  void go_to(const Point& point, std::vector<Point>& places);
  /// The end of the path becomes a place, where it is none yet.
  void finish(std::vector<Point>& places);

  friend bool operator==(const ToolPath&, const ToolPath&) = default;
};

}  // namespace knead
