#pragma once

#include <optional>
#include <vector>

#include "face_surface.hpp"
#include "knead/spline/evaluate.hpp"
#include "parameter_region.hpp"

namespace knead::step {

/// Finds the parameters of points that lie on a B-spline surface, in fractions of its domain.
class SurfaceFoot {
 public:
  /// Evaluates the grid that searches begin from. Errors: as of `evaluate_grid`.
  [[nodiscard]] static Expected<SurfaceFoot> create(const Surface& surface);

  /// The fractions of the point of the surface nearest to p, and its distance. `hint`: fractions near which to look
  /// first; the grid is searched where that ends farther away than `tolerance`.
  struct Result {
    Foot foot;
    double distance = 0;
  };
  [[nodiscard]] Result nearest(const Point& p, const std::optional<Eigen::Vector2d>& hint, double tolerance) const;

  /// Closed directions have period 1; edges of the domain that are one point are poles.
  [[nodiscard]] const ParameterSpace& space() const { return space_; }

 private:
  explicit SurfaceFoot(const Surface& surface) : surface_(&surface) {}
  [[nodiscard]] Result descend(const Point& p, Eigen::Vector2d start) const;

  const Surface* surface_;
  std::array<std::vector<double>, 2> grid_;  // parameters
  Points points_;                            // of the grid
  ParameterSpace space_;
};

}  // namespace knead::step
