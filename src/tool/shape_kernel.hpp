#pragma once

#include <memory>

#include "knead/tool/shape.hpp"

namespace knead::detail {

/// A scaled shape in its own frame, which PlacedShape rotates and moves.
class ShapeKernel {
 public:
  ShapeKernel() = default;
  ShapeKernel(const ShapeKernel&) = delete;
  ShapeKernel& operator=(const ShapeKernel&) = delete;
  virtual ~ShapeKernel() = default;

  [[nodiscard]] virtual Nearest nearest(const Point& x) const = 0;

  double size = 1;
  BoundingBox box;  ///< in its own frame
};

using Kernel = std::unique_ptr<ShapeKernel>;

/// Sphere, ellipsoid, box (rounded only without unequal scale) and plane; sizes include the scale.
[[nodiscard]] Kernel sphere_kernel(double radius);
[[nodiscard]] Kernel ellipsoid_kernel(const Point& semi_axes);
[[nodiscard]] Kernel box_kernel(const Point& half_sizes, double rounding);
[[nodiscard]] Kernel plane_kernel();

/// One piece of a meridian in the half plane (ρ, z), ρ >= 0: the segment from a to b with its
/// outward normal on the right when going from a to b, or a quarter of an ellipse a + (cos · b.x,
/// sin · b.y), 0 <= angle <= π/2, whose outside is away from a (outward) or towards it.
struct MeridianPiece {
  enum class Kind { segment, arc } kind = Kind::segment;
  Eigen::Vector2d a, b;
  bool outward = true;
};
using Meridian = std::vector<MeridianPiece>;

/// Solids of revolution about z as meridians (closed, or from the axis to the axis).
[[nodiscard]] Meridian meridian(const CylinderShape& s);
[[nodiscard]] Meridian meridian(const ConeShape& s);
[[nodiscard]] Meridian meridian(const CapsuleShape& s);
[[nodiscard]] Meridian meridian(const TorusShape& s);
[[nodiscard]] Meridian meridian(const BowlShape& s);

/// True where (ρ, z) lies in the solid, its surface included.
[[nodiscard]] bool in_meridian(const Shape& shape, double rho, double z);

/// The solid itself, arcs circular.
[[nodiscard]] Kernel revolution_kernel(const Shape& shape, Meridian pieces);

/// Any solid, unequally scaled, by search.
[[nodiscard]] Kernel scaled_revolution_kernel(const Shape& shape, const Meridian& pieces,
                                              const Point& scale);
[[nodiscard]] Kernel scaled_box_kernel(const BoxShape& shape, const Point& scale);
[[nodiscard]] Kernel superellipsoid_kernel(const SuperellipsoidShape& shape, const Point& scale);
[[nodiscard]] Kernel supertoroid_kernel(const SupertoroidShape& shape, const Point& scale);

/// Whether x lies outside of a solid of which that is known in a fraction of the time that its
/// nearest point takes: a superellipsoid or a supertoroid. False: it does not, or nothing is known.
[[nodiscard]] bool is_outside(const PlacedShape& placed, const Point& x);

/// The surface scaled in its own coordinates. Errors: a Bézier weight that is not positive.
[[nodiscard]] Expected<Kernel> spline_kernel(const Surface& surface, const Point& scale);

/// Shapes that validate and build themselves, each in its own file. Errors name the field.
[[nodiscard]] Expected<Kernel> shape_kernel(const WedgeShape& shape, const Point& scale);

}  // namespace knead::detail
