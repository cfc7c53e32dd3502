#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "brep/face_loops.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "brep/surfaces/surface_foot.hpp"

namespace knead::brep {

/// A B-spline surface, ready for feet.
struct CheckedSpline {
  /// A knot inside the domain.
  struct Line {
    double fraction = 0;
    bool kink = false;  ///< second derivatives may jump there
  };
  std::shared_ptr<const Surface> surface;
  SurfaceFoot feet;
  double size = 0;
  std::array<std::vector<Line>, 2> lines;  ///< ascending
  std::array<double, 2> widths = {};       ///< in each direction

  [[nodiscard]] static Expected<std::shared_ptr<const CheckedSpline>> create(
      std::shared_ptr<const Surface> surface);
};

/// A surface at the foot of a point.
struct FaceFoot {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< fractions of a B-spline surface, parameters
  Point point = Point::Zero();
  double distance = 0;           ///< from the point whose foot it is
  Point normal = Point::Zero();  ///< of the surface, unit; zero where there is no tangent plane
  Eigen::Matrix3d bending =
      Eigen::Matrix3d::Zero();  ///< its shape operator for that normal: xᵀ W x is the normal
                                ///< curvature in a unit direction x
};

/// The surface under a face, as it is on the face's side of an edge. Surfaces of revolution and of
/// extrusion are followed as B-splines that are the same. Const access is thread-safe.
class CheckedFace {
 public:
  /// `spline`: of a face on a B-spline surface of the model. Errors (input): those of
  /// `FaceSurface`.
  [[nodiscard]] static Expected<CheckedFace> create(const Model& model, const Face& face,
                                                    std::shared_ptr<const CheckedSpline> spline);

  /// Which line of a B-spline surface a seam runs along: `end` of `direction`.
  struct Side {
    int direction = 0, end = 0;
  };
  /// The foot of p. `near`: that of a point beside it, or null. `along`: the direction of a curve
  /// through it; at knots the surface is seen from the left of that, from the tip of its normal.
  /// `side`: the foot is sought along that line only.
  [[nodiscard]] FaceFoot foot(const Point& p, const FaceFoot* near, const Point& along,
                              const std::optional<Side>& side = {}) const;
  /// Both lines where the surface meets itself at p, first the one of which the surface is to the
  /// left of `along`; none: it does not, or as if it did not.
  [[nodiscard]] std::optional<std::array<Side, 2>> seam_at(const Point& p,
                                                           const Point& along) const;
  /// The normal of the surface as the file has it is the opposite one.
  [[nodiscard]] bool turned() const { return turned_; }
  /// The knots inside its domain; none of other surfaces.
  [[nodiscard]] const std::array<std::vector<CheckedSpline::Line>, 2>& lines() const;
  /// The parameters to be told.
  [[nodiscard]] std::array<double, 2> told(const FaceFoot& foot) const;

 private:
  [[nodiscard]] FaceFoot spline_foot(const Point& p, const FaceFoot* near, const Point& along,
                                     const std::optional<Side>& side) const;
  [[nodiscard]] FaceFoot other_foot(const Point& p) const;
  /// The foot of p on one of the four sides of the domain. `near`: that of a point beside it, or
  /// null.
  [[nodiscard]] Eigen::Vector2d along_side(const Point& p, const Side& side,
                                           const FaceFoot* near) const;
  /// By Newton's method from one of its points.
  [[nodiscard]] Eigen::Vector2d slid_along(const Point& p, const Side& side,
                                           Eigen::Vector2d at) const;

  std::shared_ptr<const CheckedSpline> spline_;  // of the file, or one that is the same
  std::shared_ptr<const FaceSurface> other_;     // null on a B-spline surface of the file
  bool turned_ = false;
};

}  // namespace knead::brep
