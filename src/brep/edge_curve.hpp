#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "curve_table.hpp"
#include "knead/brep/model.hpp"

namespace knead::brep {

/// How far chords may be from what they stand for. Both limits hold.
struct ChordLimit {
  double share;  ///< of the radius; of curves other than conics, of half their extent
  double length = std::numeric_limits<double>::infinity();

  /// Both, as a share of this radius.
  [[nodiscard]] double of(double radius) const {
    return radius > 0 ? std::min(share, length / radius) : share;
  }
};

/// A curve of a model in its own parametrisation (ISO 10303-42): lines, circles, ellipses,
/// hyperbolas, parabolas, polylines and B-spline curves.
class EdgeCurve {
 public:
  /// Errors: those of evaluating a spline.
  [[nodiscard]] static Expected<EdgeCurve> create(const CurveGeometry& geometry);

  [[nodiscard]] Point at(double t) const;
  /// A central difference for splines, exact otherwise.
  [[nodiscard]] Point derivative(double t) const;
  /// Of the point of the curve nearest to p; for conics, of the one on the ray from the centre.
  [[nodiscard]] double parameter(const Point& p) const;
  /// The domain of splines; 0 … 2π of circles and ellipses.
  [[nodiscard]] std::optional<Interval> domain() const { return domain_; }
  /// Whether the curve is closed: t and t + the length of the domain give the same point.
  [[nodiscard]] bool closed() const { return closed_; }
  /// A straight line.
  [[nodiscard]] bool straight() const { return std::holds_alternative<Line>(form_); }
  /// The domain of a spline or polyline, which `spline` gives as a whole; none of other curves.
  [[nodiscard]] std::optional<Interval> whole() const;
  /// The curve over `range`, which may lie up to a turn past the domain of an ellipse, as a
  /// B-spline curve on the same parameters: of degree 1 for lines, 2 for conics, exact but for
  /// rounding (`conic_spline`); splines and polylines as they are, whatever the range.
  [[nodiscard]] Expected<Curve> spline(const Interval& range) const;
  /// It runs against its form.
  [[nodiscard]] bool turned() const { return turned_; }

  /// The parameter in the record of the curve: that of a LINE counts multiples of its VECTOR, here
  /// it is a length.
  [[nodiscard]] double file_parameter(double t) const;
  /// Knots inside the domain of a multiplicity that is the degree or more, ascending: the curve may
  /// have corners there.
  [[nodiscard]] std::vector<double> corners() const;

  /// Parameters from `from` to `to` > from, both included. Circles and ellipses at even steps of at
  /// most 2 acos(1 − share): chords are then within `share` · radius. Others so closely that chords
  /// are within `share` · half the extent of the whole piece, and turn no more than a circle's
  /// would, unless that moves less than a fiftieth of the tolerance. `to` may lie up to one period
  /// past the domain of a closed curve.
  [[nodiscard]] std::vector<double> subdivided(double from, double to, ChordLimit chord) const;

 private:
  explicit EdgeCurve(std::variant<Line, Conic, CurveTable> form) : form_(std::move(form)) {}

  std::variant<Line, Conic, CurveTable> form_;
  std::optional<Interval> domain_;
  bool closed_ = false, turned_ = false;
};

/// Angle between neighbouring points of a circle whose chords are within `chord` · radius: 2 acos(1
/// − chord).
[[nodiscard]] double chord_angle(double chord);

}  // namespace knead::brep
