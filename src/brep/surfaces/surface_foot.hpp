#pragma once

#include <optional>
#include <span>
#include <vector>

#include "brep/tessellation/parameter_region.hpp"
#include "face_surface.hpp"
#include "knead/spline/closest_point.hpp"

namespace knead::brep {

/// Finds the parameters of points that lie on a B-spline surface, in fractions of its domain.
class SurfaceFoot {
 public:
  /// Errors: as for `ClosestPointSearch`.
  [[nodiscard]] static Expected<SurfaceFoot> create(const Surface& surface);

  /// The fractions of the point of the surface nearest to p, and its distance. `hint`: fractions
  /// from which to descend first; the whole surface is searched if that ends farther away than
  /// `tolerance`, or than a tenth of the width of the surface: the foot on the other side of a
  /// sliver is as near as that.
  struct Result {
    Foot foot;
    double distance = 0;
  };
  [[nodiscard]] Result nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint,
                               double tolerance) const;

  /// The fractions of the nearest points to those of a curve on the surface, one after the other:
  /// without jumps over a seam, and beside poles with what is undetermined there taken from the
  /// neighbours. `tolerance`: as for `nearest`.
  struct Path {
    std::vector<Eigen::Vector2d> feet;
    double distance = 0;  ///< the largest
  };
  [[nodiscard]] Path along(std::span<const Point> points, double tolerance) const;
  /// The same for one more point, next to fractions on the path.
  [[nodiscard]] Eigen::Vector2d beside(const Point& p, const Eigen::Vector2d& before,
                                       double tolerance) const;

  /// Closed directions have period 1; edges of the domain that collapse to one point are poles.
  [[nodiscard]] const ParameterSpace& space() const { return space_; }

 private:
  explicit SurfaceFoot(ClosestPointSearch<2> search) : search_(std::move(search)) {}
  [[nodiscard]] Result result_of(const ClosestPoint<2>& closest) const;

  ClosestPointSearch<2> search_;
  std::array<Interval, 2> domain_;
  ParameterSpace space_;
  double narrow_ = 0;
};

}  // namespace knead::brep
