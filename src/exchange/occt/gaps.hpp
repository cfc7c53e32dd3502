#pragma once

#include <array>
#include <optional>
#include <vector>

#include "file.hpp"

namespace knead::occt {

/// How far what describes an edge lies apart, in the file's coordinates.
struct EdgeGap {
  double along = 0;  ///< of its curve in space from its points on surfaces, at equal parameters
  std::vector<double> at_vertex;  ///< of the ends of all its curves from each of the edge's `uses`
  double rounding = 0;  ///< what the distances may differ by alone: 1e-13 of the largest coordinate
};

/// Measures the edges of one file, as Open CASCADE's BRepCheck does: between curves at equal
/// parameters, and at their ends. Surfaces are read when an edge needs them first.
class GapMeter {
 public:
  explicit GapMeter(const BrepFile& file) : file_(file), surfaces_(file.surfaces.size()) {}

  /// At 201 parameters. None: one of its curves or surfaces is of a form that is not evaluated
  /// here: periodic, an offset, another surface than a B-spline; or its curves have different
  /// parameters. Cost: 201 points of each curve.
  [[nodiscard]] std::optional<EdgeGap> gap(const BrepShape& edge);

 private:
  /// None: of another form.
  const Surface* surface(int index);

  const BrepFile& file_;
  std::vector<std::optional<std::optional<Surface>>> surfaces_;
};

/// A point of a curve with so many coordinates. None: it is periodic, or an offset.
[[nodiscard]] std::optional<Point> point_of(const BrepCurve& curve, int dimension, double t);

}  // namespace knead::occt
