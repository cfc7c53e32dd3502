#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "knead/spline/extremum.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

class Fields;

/// Shapes of tools in their own frame. Solids unless said otherwise: the distance is negative
/// inside.

/// x² + y² + z² <= radius².
struct SphereShape {
  double radius = 1;
  friend bool operator==(const SphereShape&, const SphereShape&) = default;
};

/// Σ (x_i / semi_axes_i)² <= 1.
struct EllipsoidShape {
  std::array<double, 3> semi_axes = {1, 1, 1};
  friend bool operator==(const EllipsoidShape&, const EllipsoidShape&) = default;
};

/// |x_i| <= half_sizes_i, with edges and corners rounded to the radius `rounding` (0 <= rounding <=
/// every half size); the half sizes are those of the finished box.
struct BoxShape {
  std::array<double, 3> half_sizes = {1, 1, 1};
  double rounding = 0;
  friend bool operator==(const BoxShape&, const BoxShape&) = default;
};

/// x² + y² <= radius², |z| <= half_height.
struct CylinderShape {
  double radius = 1, half_height = 1;
  friend bool operator==(const CylinderShape&, const CylinderShape&) = default;
};

/// The frustum from the disc of `radius` in z = 0 to the disc of `top_radius` (an apex where it is
/// 0) in z = height.
struct ConeShape {
  double radius = 1, height = 1, top_radius = 0;
  friend bool operator==(const ConeShape&, const ConeShape&) = default;
};

/// All points within `radius` of the segment from (0, 0, −half_height) to (0, 0, half_height).
struct CapsuleShape {
  double radius = 1, half_height = 1;
  friend bool operator==(const CapsuleShape&, const CapsuleShape&) = default;
};

/// All points within `minor` of the circle of radius `major` in z = 0; minor <= major.
struct TorusShape {
  double major = 1, minor = 0.25;
  friend bool operator==(const TorusShape&, const TorusShape&) = default;
};

/// The half space z <= 0.
struct PlaneShape {
  friend bool operator==(const PlaneShape&, const PlaneShape&) = default;
};

/// A hemispherical shell, open towards +z: radius − thickness <= |x| <= radius, z <= 0. Inside is
/// the material of the wall; the hollow (the concavity of thesis Fig. 6.13) is outside. The rim is
/// a flat ring in z = 0.
struct BowlShape {
  double radius = 1, thickness = 0.1;
  friend bool operator==(const BowlShape&, const BowlShape&) = default;
};

/// x = a cos^e1 η cos^e2 ω, y = b cos^e1 η sin^e2 ω, z = c sin^e1 η (thesis § 2.1.6: every
/// trigonometric factor raised to an exponent, signs kept), solid. e = 1 is round, e → 0 square, 2
/// straight, above 2 pinched. 0.1 <= e1, e2 <= 4.
struct SuperellipsoidShape {
  std::array<double, 3> semi_axes = {1, 1, 1};
  double e1 = 1, e2 = 1;
  friend bool operator==(const SuperellipsoidShape&, const SuperellipsoidShape&) = default;
};

/// x = (major + radial cos^e1 η) cos^e2 ω, y = (major + radial cos^e1 η) sin^e2 ω, z = axial sin^e1
/// η, solid, with semi_axes = {radial, axial} of the tube; radial < major, 0.1 <= e1, e2 <= 4.
struct SupertoroidShape {
  double major = 1;
  std::array<double, 2> semi_axes = {0.25, 0.25};
  double e1 = 1, e2 = 1;
  friend bool operator==(const SupertoroidShape&, const SupertoroidShape&) = default;
};

/// A straight ridge along x: |x| <= length / 2, z >= 0, and in y below two flanks that enclose
/// `angle` (degrees, below 180) and meet at the ridge, whose edge is rounded to the radius
/// `rounding` and touches z = height; the round edge ends above the foot, rounding · (1 − sin(angle
/// / 2)) <= height. The ends and the foot are flat with sharp edges.
struct WedgeShape {
  double length = 2, angle = 60, height = 1, rounding = 0;
  friend bool operator==(const WedgeShape&, const WedgeShape&) = default;
  friend void describe(WedgeShape& s, Fields& fields);
};

/// A B-spline or NURBS surface. Its outside is the side of S_u × S_v. Where the nearest point lies
/// on an open border and the direction to it is not along the normal there, x counts as outside
/// (the distance is that to the border): the signed distance of an open sheet jumps on the strip
/// behind it bounded by its border normals.
struct SplineShape {
  std::shared_ptr<const Surface> surface;
  friend bool operator==(const SplineShape&, const SplineShape&) = default;
};

using Shape = std::variant<SphereShape, EllipsoidShape, BoxShape, CylinderShape, ConeShape,
                           CapsuleShape, TorusShape, PlaneShape, BowlShape, SuperellipsoidShape,
                           SupertoroidShape, SplineShape, WedgeShape>;

/// The nearest point of a shape's surface to x, and the signed distance φ with its first two
/// derivatives at x.
struct Nearest {
  double distance = 0;           ///< φ(x), negative inside; |φ| = |x − point|
  Point point = Point::Zero();   ///< a nearest point of the surface
  Point normal = Point::Zero();  ///< ∇φ(x), of length 1; zero where a whole circle or sphere of
                                 ///< points is nearest
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< ∇²φ(x); zero where the normal is zero
  /// False where the search could not prove that no other point is nearer by more than 1e-11 of the
  /// size: the other fields then hold the best it found.
  bool converged = true;
};

/// The nearest points of many points; row k belongs to point k.
struct NearestPoints {
  Eigen::VectorXd distances;
  Points points, normals;
  std::vector<Eigen::Matrix3d> hessians;
  std::vector<bool> converged;
};

/// A shape x ↦ position + rotation · (scale ∘ x).
struct Placement {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< of length 1
  Point position = Point::Zero();
  std::array<double, 3> scale = {1, 1, 1};  ///< along the shape's own axes, each > 0
};

/// The rotation by the smallest angle that takes the direction of `from` to that of `to`, both
/// non-zero. Where they are opposite, about an axis perpendicular to them.
[[nodiscard]] Eigen::Quaterniond turn_between(const Point& from, const Point& to);

namespace detail {
class ShapeKernel;
}

/// A shape in space, prepared for nearest-point queries. Immutable; copies and `moved` share the
/// prepared data.
///
/// Distances are those of the scaled shape, not scaled distances: a sphere scaled unequally is an
/// ellipsoid, a box remains a box; where unequal scaling leaves no closed form, the nearest point
/// is found by search (docs/tools.md).
class PlacedShape {
 public:
  /// Errors name the field ("radius", "rotation", "scale", …). A spline surface needs positive
  /// Bézier weights.
  [[nodiscard]] static Expected<PlacedShape> create(const Shape& shape,
                                                    const Placement& placement = {});

  /// The same shape and scale elsewhere: cheap, the prepared data is reused. Errors as in `create`.
  [[nodiscard]] Expected<PlacedShape> moved(const Eigen::Quaterniond& rotation,
                                            const Point& position) const;

  [[nodiscard]] const Shape& shape() const { return shape_; }
  [[nodiscard]] const Placement& placement() const { return placement_; }

  /// Accuracy: distance and point to 1e-10 of the size (far away: plus rounding of x) where
  /// `converged`. Cost: closed forms 0.1 to 0.3 µs, searched shapes 5 to 150 µs (docs/tools.md):
  /// cull by `bounding_box` first.
  [[nodiscard]] Nearest nearest(const Point& x) const;
  [[nodiscard]] NearestPoints nearest_points(const Points& x) const;

  /// The smallest feature that integrated forces must resolve: the smallest radius, half thickness
  /// or half side; a wall counts with its thickness, a spline surface with its diagonal; infinite
  /// for a plane.
  [[nodiscard]] double size() const;

  /// An axis-aligned box that contains the whole shape (not always the tightest); infinite for a
  /// plane. For culling: distances are 1-Lipschitz, so φ >= φ(x) − r throughout the ball of radius
  /// r around x.
  [[nodiscard]] BoundingBox bounding_box() const;

 private:
  PlacedShape() = default;
  Shape shape_;
  Placement placement_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  bool upright_ = true;  // no rotation
  std::shared_ptr<const detail::ShapeKernel> kernel_;
};

}  // namespace knead
