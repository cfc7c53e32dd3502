#pragma once

#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "knead/spline/spline.hpp"

namespace knead::brep {

/// The parameter of the point of a curve nearest to `point`, and the distance: the best of the
/// tabulated points and their neighbourhoods, by Newton's iteration.
class CurveTable {
 public:
  /// Tabulates the curve. Errors: as for `evaluate`.
  [[nodiscard]] static Expected<CurveTable> create(Curve curve);

  struct Foot {
    double parameter = 0;
    double distance = 0;
  };
  /// Feet farther away than `limit` may be approximate.
  [[nodiscard]] Foot closest(const Point& point,
                             double limit = std::numeric_limits<double>::infinity()) const;
  [[nodiscard]] const Curve& curve() const { return curve_; }
  [[nodiscard]] const std::vector<double>& parameters() const { return parameters_; }
  [[nodiscard]] const Points& points() const { return points_; }
  /// Whether first and last point agree to `tolerance`.
  [[nodiscard]] bool closed(double tolerance) const;

 private:
  explicit CurveTable(Curve curve) : curve_(std::move(curve)) {}
  [[nodiscard]] std::optional<std::array<Point, 3>> jet(double t) const;
  void descend(const Point& point, Eigen::Index k, Foot& foot) const;

  Curve curve_;
  std::vector<double> parameters_;
  Points points_;
  Point lower_ = Point::Zero(), upper_ = Point::Zero();  // of the box around the points
  double longest_chord_ = 0;                             // from one point to the next
};

}  // namespace knead::brep
