#pragma once

#include <span>

#include "scene/scene.hpp"

namespace knead {

/// The way of a brush over the selected surfaces. Between two points of one surface it is straight
/// in its parameters, on a closed surface the shorter way around; between points of two surfaces it
/// is straight in space, and its places are the nearest points of the surfaces.
class BrushPath {
 public:
  /// \param selection the surfaces that it may lead over, by their index; with their shapes in the
  /// same order. \param spacing   largest distance of places, file units. \param rope      the
  /// pointer draws the brush by a rope of this length; 0: they are together.
  BrushPath(std::span<const int> selection, std::span<const OpenStroke::Before> shapes,
            double spacing, double rope);

  /// The places on the way of the brush from where it is (`at`) while the pointer goes from `from`
  /// to `to`. Errors (input): points outside of the domain, a way of more than 20,000 places.
  [[nodiscard]] Expected<std::vector<BrushPoint>> places(const BrushPoint& from,
                                                         const BrushPoint& to,
                                                         const BrushPoint& at) const;
  /// The point there, with its normal S_u × S_v / |S_u × S_v|, zero where undefined.
  [[nodiscard]] Expected<BrushPlace> place(const BrushPoint& at) const;
  /// The nearest point of one of the surfaces, a local minimum from the abscissae of the nearest
  /// control point. `surface` has to be one of them, as that of all points.
  [[nodiscard]] BrushPoint nearest(int surface, const Point& x) const;

 private:
  struct Sheet {
    int surface = 0;
    std::shared_ptr<const Surface> shape;
    std::array<bool, 2> closed = {};
    Point lower, upper;  ///< of the box of its control points
  };
  [[nodiscard]] const Sheet& sheet(int surface) const;
  [[nodiscard]] Expected<Point> point(const BrushPoint& at) const;
  [[nodiscard]] Expected<BrushPoint> towards(const BrushPoint& from, const BrushPoint& to,
                                             double share) const;
  [[nodiscard]] Expected<double> length(const BrushPoint& from, const BrushPoint& to) const;

  std::vector<Sheet> sheets_;
  double spacing_, rope_;
};

}  // namespace knead
