#pragma once

#include <optional>
#include <vector>

#include "face_surface.hpp"
#include "knead/spline/closest_point.hpp"
#include "parameter_region.hpp"

namespace knead::step {

/// Finds the parameters of points that lie on a B-spline surface, in fractions of its domain.
class SurfaceFoot {
 public:
  /// Errors: as for `ClosestPointSearch`.
  [[nodiscard]] static Expected<SurfaceFoot> create(const Surface& surface);

  /// The fractions of the point of the surface nearest to p, and its distance. `hint`: fractions from which to descend
  /// first; the whole surface is searched if that ends farther away than `tolerance`.
  struct Result {
    Foot foot;
    double distance = 0;
  };
  [[nodiscard]] Result nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint, double tolerance) const;

  /// Closed directions have period 1; edges of the domain that collapse to one point are poles.
  [[nodiscard]] const ParameterSpace& space() const { return space_; }

 private:
  explicit SurfaceFoot(ClosestPointSearch<2> search) : search_(std::move(search)) {}
  [[nodiscard]] Result result_of(const ClosestPoint<2>& closest) const;

  ClosestPointSearch<2> search_;
  std::array<Interval, 2> domain_;
  ParameterSpace space_;
};

}  // namespace knead::step
