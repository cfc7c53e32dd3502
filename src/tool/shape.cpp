#include "knead/tool/shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "shape_kernel.hpp"

namespace knead {
namespace {

using detail::Kernel;

// Products of two of these, squared, are still numbers.
constexpr double least_size = 1e-50, greatest_size = 1e50;

/// The first invalid number of a shape, as an error that names the field.
class Check {
 public:
  Check& positive(double x, const char* field) {
    bound(std::isfinite(x) && x > 0, x, field, "a number > 0");
    return bound(x >= least_size && x <= greatest_size, x, field,
                 fmt::format("a number from {} to {}", least_size, greatest_size));
  }
  Check& at_least_zero(double x, const char* field) {
    bound(std::isfinite(x) && x >= 0, x, field, "a number >= 0");
    return bound(x <= greatest_size, x, field, fmt::format("a number up to {}", greatest_size));
  }
  Check& exponent(double x, const char* field) {
    return bound(x >= 0.1 && x <= 4, x, field, "an exponent from 0.1 to 4");
  }
  template <class Array>
  Check& positive_all(const Array& values, const char* field) {
    for (double x : values) positive(x, field);
    return *this;
  }
  Check& bound(bool right, double x, const char* field, const std::string& remedy) {
    if (!right && !error_) {
      error_ = Error{ErrorKind::input, fmt::format("{} cannot be the {}", x, field), field,
                     "use " + remedy};
    }
    return *this;
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  std::optional<Error> error_;
};

Point vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Shapes that validate and build themselves.
template <class S>
concept BuildsItself = requires(const S& s, const Point& scale) {
  detail::shape_kernel(s, scale);
};

/// Validates a shape's own fields.
struct Validate {
  Check check;
  void operator()(const SphereShape& s) { check.positive(s.radius, "radius"); }
  void operator()(const EllipsoidShape& s) { check.positive_all(s.semi_axes, "semi_axes"); }
  void operator()(const BoxShape& s) {
    check.positive_all(s.half_sizes, "half_sizes").at_least_zero(s.rounding, "rounding");
    check.bound(s.rounding <= vector(s.half_sizes).minCoeff(), s.rounding, "rounding",
                "at most the least half size");
  }
  void operator()(const CylinderShape& s) {
    check.positive(s.radius, "radius").positive(s.half_height, "half_height");
  }
  void operator()(const ConeShape& s) {
    check.at_least_zero(s.radius, "radius")
        .positive(s.height, "height")
        .at_least_zero(s.top_radius, "top_radius");
    check.positive(s.radius + s.top_radius, "radius");
  }
  void operator()(const CapsuleShape& s) {
    check.positive(s.radius, "radius").at_least_zero(s.half_height, "half_height");
  }
  void operator()(const TorusShape& s) {
    check.positive(s.major, "major").positive(s.minor, "minor");
    check.bound(s.minor <= s.major, s.minor, "minor", "at most the major radius");
  }
  void operator()(const PlaneShape&) {}
  void operator()(const BowlShape& s) {
    check.positive(s.radius, "radius").positive(s.thickness, "thickness");
    check.bound(s.thickness <= s.radius, s.thickness, "thickness", "at most the radius");
  }
  void operator()(const SuperellipsoidShape& s) {
    check.positive_all(s.semi_axes, "semi_axes").exponent(s.e1, "e1").exponent(s.e2, "e2");
  }
  void operator()(const SupertoroidShape& s) {
    check.positive(s.major, "major")
        .positive_all(s.semi_axes, "semi_axes")
        .exponent(s.e1, "e1")
        .exponent(s.e2, "e2");
    check.bound(s.semi_axes[0] < s.major, s.semi_axes[0], "semi_axes",
                "a radial semi-axis below the major radius");
  }
  void operator()(const SplineShape& s) {
    if (!s.surface) check.bound(false, 0, "surface", "a surface of the document");
  }
  void operator()(const BuildsItself auto&) {}
};

/// The smallest feature of a solid of revolution, with its two scales across and along the axis.
struct RevolutionFeature {
  double across, along;
  double operator()(const CylinderShape& s) const {
    return std::min(across * s.radius, along * s.half_height);
  }
  double operator()(const ConeShape& s) const {
    return std::min(across * std::max(s.radius, s.top_radius), along * 0.5 * s.height);
  }
  double operator()(const CapsuleShape& s) const { return std::min(across, along) * s.radius; }
  double operator()(const TorusShape& s) const { return std::min(across, along) * s.minor; }
  double operator()(const BowlShape& s) const { return std::min(across, along) * s.thickness; }
};

CylinderShape scaled(const CylinderShape& s, double r, double z) {
  return {s.radius * r, s.half_height * z};
}
ConeShape scaled(const ConeShape& s, double r, double z) {
  return {s.radius * r, s.height * z, s.top_radius * r};
}
CapsuleShape scaled(const CapsuleShape& s, double r, double) {
  return {s.radius * r, s.half_height * r};
}
TorusShape scaled(const TorusShape& s, double r, double) { return {s.major * r, s.minor * r}; }
BowlShape scaled(const BowlShape& s, double r, double) { return {s.radius * r, s.thickness * r}; }

// Scale factors along the axes are part of the shape, not of its place: distances are those in
// space, which do not scale. A shape that scaling leaves in its family (an ellipsoid, an upright
// cylinder stretched along its axis) keeps its kernel; the others get one that searches for the
// nearest point.
struct Build {
  Point scale;

  [[nodiscard]] bool equal() const { return scale.x() == scale.y() && scale.y() == scale.z(); }

  Expected<Kernel> operator()(const SphereShape& s) const {
    if (equal()) return detail::sphere_kernel(s.radius * scale.x());
    return detail::ellipsoid_kernel(s.radius * scale);
  }
  Expected<Kernel> operator()(const EllipsoidShape& s) const {
    const Point a = vector(s.semi_axes).cwiseProduct(scale);
    if (a.x() == a.y() && a.y() == a.z()) return detail::sphere_kernel(a.x());
    return detail::ellipsoid_kernel(a);
  }
  Expected<Kernel> operator()(const BoxShape& s) const {
    if (s.rounding > 0 && !equal()) return detail::scaled_box_kernel(s, scale);
    return detail::box_kernel(vector(s.half_sizes).cwiseProduct(scale), s.rounding * scale.x());
  }
  Expected<Kernel> operator()(const PlaneShape&) const { return detail::plane_kernel(); }
  // With round sections these are an ellipsoid and a torus, whose nearest points have a closed
  // form.
  Expected<Kernel> operator()(const SuperellipsoidShape& s) const {
    if (s.e1 == 1 && s.e2 == 1) return (*this)(EllipsoidShape{s.semi_axes});
    return detail::superellipsoid_kernel(s, scale);
  }
  Expected<Kernel> operator()(const SupertoroidShape& s) const {
    if (s.e1 == 1 && s.e2 == 1 && s.semi_axes[0] == s.semi_axes[1] && equal())
      return (*this)(TorusShape{s.major, s.semi_axes[0]});
    return detail::supertoroid_kernel(s, scale);
  }
  Expected<Kernel> operator()(const SplineShape& s) const {
    return detail::spline_kernel(*s.surface, scale);
  }

  Expected<Kernel> operator()(const BuildsItself auto& s) const {
    return detail::shape_kernel(s, scale);
  }

  /// Solids of revolution: straight meridians keep their form when only the axis is scaled
  /// differently.
  template <class Solid>
  Expected<Kernel> operator()(const Solid& s) const {
    constexpr bool straight =
        std::is_same_v<Solid, CylinderShape> || std::is_same_v<Solid, ConeShape>;
    Kernel kernel;
    if (equal() || (straight && scale.x() == scale.y())) {
      const Solid grown = scaled(s, scale.x(), scale.z());
      kernel = detail::revolution_kernel(grown, detail::meridian(grown));
    } else {
      kernel = detail::scaled_revolution_kernel(s, detail::meridian(s), scale);
    }
    kernel->size = RevolutionFeature{std::min(scale.x(), scale.y()), scale.z()}(s);
    return kernel;
  }
};

std::optional<Error> wrong_pose(const Eigen::Quaterniond& rotation, const Point& position) {
  if (!(std::abs(rotation.coeffs().norm() - 1) < 1e-9)) {
    return Error{ErrorKind::input, "the quaternion is not of length 1", "rotation",
                 "use a unit quaternion"};
  }
  if (!position.allFinite())
    return Error{ErrorKind::input, "a coordinate is not a finite number", "position",
                 "use smaller ones"};
  return std::nullopt;
}

}  // namespace

Expected<PlacedShape> PlacedShape::create(const Shape& shape, const Placement& placement) {
  Validate validate;
  std::visit([&](const auto& s) { validate(s); }, shape);
  validate.check.positive_all(placement.scale, "scale");
  if (validate.check.error()) return std::unexpected(*validate.check.error());
  if (const auto error = wrong_pose(placement.rotation, placement.position))
    return std::unexpected(*error);
  auto kernel = std::visit(Build{vector(placement.scale)}, shape);
  if (!kernel) return std::unexpected(kernel.error());
  PlacedShape placed;
  placed.shape_ = shape;
  placed.placement_ = placement;
  placed.rotation_ = placement.rotation.normalized().toRotationMatrix();
  placed.upright_ = placed.rotation_ == Eigen::Matrix3d::Identity();
  placed.kernel_ = std::move(*kernel);
  return placed;
}

Expected<PlacedShape> PlacedShape::moved(const Eigen::Quaterniond& rotation,
                                         const Point& position) const {
  if (const auto error = wrong_pose(rotation, position)) return std::unexpected(*error);
  PlacedShape placed = *this;
  placed.placement_.rotation = rotation;
  placed.placement_.position = position;
  placed.rotation_ = rotation.normalized().toRotationMatrix();
  placed.upright_ = placed.rotation_ == Eigen::Matrix3d::Identity();
  return placed;
}

Nearest PlacedShape::nearest(const Point& x) const {
  if (upright_) {
    Nearest r = kernel_->nearest(x - placement_.position);
    r.point += placement_.position;
    return r;
  }
  Nearest r = kernel_->nearest(rotation_.transpose() * (x - placement_.position));
  r.point = rotation_ * r.point + placement_.position;
  r.normal = rotation_ * r.normal;
  r.hessian = rotation_ * r.hessian * rotation_.transpose();
  return r;
}

NearestPoints PlacedShape::nearest_points(const Points& x) const {
  const Eigen::Index n = x.rows();
  NearestPoints r;
  r.distances.resize(n);
  r.points.resize(n, 3);
  r.normals.resize(n, 3);
  r.hessians.resize(static_cast<std::size_t>(n));
  r.converged.resize(static_cast<std::size_t>(n));
  for (Eigen::Index k = 0; k < n; ++k) {
    const Nearest one = nearest(x.row(k));
    r.distances[k] = one.distance;
    r.points.row(k) = one.point;
    r.normals.row(k) = one.normal;
    r.hessians[static_cast<std::size_t>(k)] = one.hessian;
    r.converged[static_cast<std::size_t>(k)] = one.converged;
  }
  return r;
}

double PlacedShape::size() const { return kernel_->size; }

BoundingBox PlacedShape::bounding_box() const {
  const Point half = 0.5 * (kernel_->box.upper - kernel_->box.lower);
  if (!half.allFinite()) return kernel_->box;
  // The box of a turned box: |R| times its half sizes.
  const Point centre = rotation_ * kernel_->box.centre() + placement_.position,
              reach = rotation_.cwiseAbs() * half;
  return {centre - reach, centre + reach};
}

Eigen::Quaterniond turn_between(const Point& from, const Point& to) {
  const Point a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  if (cosine > -1 + 1e-12) {
    const double twice = std::sqrt((1 + cosine) * 2);  // twice the cosine of half the angle
    const Point axis = a.cross(b) * (1 / twice);
    return {0.5 * twice, axis.x(), axis.y(), axis.z()};
  }
  const Point aside = a.unitOrthogonal();  // half a turn as two quarters
  return turn_between(aside, b) * turn_between(a, aside);
}

}  // namespace knead
