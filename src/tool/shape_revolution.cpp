#include <algorithm>
#include <cmath>
#include <limits>

#include "shape_kernel.hpp"

namespace knead::detail {
namespace {

using Vector2 = Eigen::Vector2d;

MeridianPiece segment(double ra, double za, double rb, double zb) {
  return {MeridianPiece::Kind::segment, Vector2(ra, za), Vector2(rb, zb), true};
}
MeridianPiece arc(double rc, double zc, double along, double up, bool outward = true) {
  return {MeridianPiece::Kind::arc, Vector2(rc, zc), Vector2(along, up), outward};
}

/// Nearest point of one piece in the meridian plane.
struct Foot2 {
  double squared = std::numeric_limits<double>::infinity();
  double distance = 0;  ///< signed where smooth
  Vector2 point = Vector2::Zero(), normal = Vector2::Zero();
  double curvature = 0;  ///< second derivative of the distance along the meridian, at x
  bool smooth = false, tie = false;

  void consider_end(const Vector2& q, const Vector2& end) {
    const double d = (q - end).squaredNorm();
    if (d < squared) *this = {d, 0, end, Vector2::Zero(), 0, false, false};
  }
};

// In the half plane (ρ, z). The inside of the solid is on the left of a segment from a to b seen
// along it, so that the normal (d_z, −d_ρ) points out. Arcs are quarters of circles about a,
// towards the signs of b: q is before the arc if both coordinates of q − a have these signs. The
// curvature is that of the distance's level curve through q, ± 1 / |q − a|, and 0 before a segment.
Foot2 foot_of(const MeridianPiece& piece, const Vector2& q) {
  Foot2 f;
  if (piece.kind == MeridianPiece::Kind::segment) {
    const Vector2 d = piece.b - piece.a;
    const double length = d.norm(), t = d.dot(q - piece.a) / length;
    if (t >= 0 && t <= length) {
      f.normal = Vector2(d.y(), -d.x()) / length;
      f.distance = f.normal.dot(q - piece.a);
      f.point = q - f.distance * f.normal;
      f.squared = f.distance * f.distance;
      f.smooth = true;
      return f;
    }
    f.consider_end(q, piece.a);
    f.consider_end(q, piece.b);
    return f;
  }
  const Vector2 v = q - piece.a;
  const double r = std::abs(piece.b.x()), norm = v.norm();
  if (v.x() * piece.b.x() >= 0 && v.y() * piece.b.y() >= 0) {
    const double sign = piece.outward ? 1 : -1;
    f.smooth = true;
    f.distance = sign * (norm - r);
    f.squared = (norm - r) * (norm - r);
    f.tie = norm == 0;
    const Vector2 direction =
        f.tie ? Vector2(0, std::copysign(1.0, piece.b.y())) : Vector2(v / norm);
    f.point = piece.a + r * direction;
    f.normal = sign * direction;
    f.curvature = f.tie ? 0 : sign / norm;
    return f;
  }
  f.consider_end(q, piece.a + Vector2(piece.b.x(), 0));
  f.consider_end(q, piece.a + Vector2(0, piece.b.y()));
  return f;
}

class Revolution final : public ShapeKernel {
 public:
  Revolution(const Shape& shape, Meridian pieces) : shape_(shape), pieces_(std::move(pieces)) {
    double radius = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (const MeridianPiece& p : pieces_) {
      const Vector2 a =
          p.kind == MeridianPiece::Kind::arc ? Vector2(p.a + Vector2(p.b.x(), 0)) : p.a;
      const Vector2 b =
          p.kind == MeridianPiece::Kind::arc ? Vector2(p.a + Vector2(0, p.b.y())) : p.b;
      radius = std::max({radius, a.x(), b.x()});
      low = std::min({low, a.y(), b.y()});
      high = std::max({high, a.y(), b.y()});
    }
    box = {Point(-radius, -radius, low), Point(radius, radius, high)};
  }

  // The nearest point of a solid of revolution lies in the half plane of x: the problem is one in
  // two dimensions with closed forms, exact to rounding. The Hessian of the distance has the normal
  // in its kernel and the eigenvectors t, along the meridian, with the curvature of the level
  // curve, and e_φ, around the axis, with n_ρ / ρ; on the axis both are equal by symmetry.
  Nearest nearest(const Point& x) const override {
    const double rho = std::hypot(x.x(), x.y());
    const Vector2 q(rho, x.z());
    Foot2 best;
    for (const MeridianPiece& piece : pieces_) {
      const Foot2 f = foot_of(piece, q);
      // Of two ends at the same place, the one reached along its normal determines the side.
      if (f.squared < best.squared || (f.squared == best.squared && f.smooth && !best.smooth))
        best = f;
    }
    // At a corner of the meridian the distance is that to a circle, whose sign the pieces cannot
    // tell.
    if (!best.smooth) {
      const double away = std::sqrt(best.squared);
      best.distance = in_meridian(shape_, q.x(), q.y()) ? -away : away;
      if (away > 0)
        best.normal = (q - best.point) / best.distance, best.curvature = 1 / best.distance;
    }
    Nearest r;
    const Point e = rho > 0 ? Point(x.x() / rho, x.y() / rho, 0) : Point::UnitX(),
                up = Point::UnitZ();
    r.distance = best.distance;
    r.point = best.point.x() * e + best.point.y() * up;
    if (best.tie || (rho == 0 && best.normal.x() != 0)) return r;  // a circle of points is nearest
    r.normal = best.normal.x() * e + best.normal.y() * up;
    const Point t = -best.normal.y() * e + best.normal.x() * up, round(-e.y(), e.x(), 0);
    const double circumferential = rho > 0 ? best.normal.x() / rho : best.curvature;
    r.hessian = best.curvature * t * t.transpose() + circumferential * round * round.transpose();
    return r;
  }

 private:
  Shape shape_;
  Meridian pieces_;
};

}  // namespace

Meridian meridian(const CylinderShape& s) {
  const double r = s.radius, h = s.half_height;
  return {segment(0, -h, r, -h), segment(r, -h, r, h), segment(r, h, 0, h)};
}

Meridian meridian(const ConeShape& s) {
  Meridian m;
  if (s.radius > 0) m.push_back(segment(0, 0, s.radius, 0));
  m.push_back(segment(s.radius, 0, s.top_radius, s.height));
  if (s.top_radius > 0) m.push_back(segment(s.top_radius, s.height, 0, s.height));
  return m;
}

Meridian meridian(const CapsuleShape& s) {
  const double r = s.radius, h = s.half_height;
  Meridian m = {arc(0, -h, r, -r), arc(0, h, r, r)};
  if (h > 0) m.push_back(segment(r, -h, r, h));
  return m;
}

Meridian meridian(const TorusShape& s) {
  const double r = s.minor;
  return {arc(s.major, 0, r, r), arc(s.major, 0, r, -r), arc(s.major, 0, -r, r),
          arc(s.major, 0, -r, -r)};
}

Meridian meridian(const BowlShape& s) {
  const double inner = s.radius - s.thickness;
  Meridian m = {arc(0, 0, s.radius, -s.radius), segment(s.radius, 0, inner, 0)};
  if (inner > 0) m.push_back(arc(0, 0, inner, -inner, false));
  return m;
}

bool in_meridian(const Shape& shape, double rho, double z) {
  if (const auto* c = std::get_if<CylinderShape>(&shape))
    return rho <= c->radius && std::abs(z) <= c->half_height;
  if (const auto* c = std::get_if<ConeShape>(&shape)) {
    return z >= 0 && z <= c->height &&
           rho * c->height <= c->radius * (c->height - z) + c->top_radius * z;
  }
  if (const auto* c = std::get_if<CapsuleShape>(&shape)) {
    return std::hypot(rho, std::max(0.0, std::abs(z) - c->half_height)) <= c->radius;
  }
  if (const auto* t = std::get_if<TorusShape>(&shape))
    return std::hypot(rho - t->major, z) <= t->minor;
  if (const auto* b = std::get_if<BowlShape>(&shape)) {
    const double r = std::hypot(rho, z);
    return z <= 0 && r <= b->radius && r >= b->radius - b->thickness;
  }
  return false;
}

Kernel revolution_kernel(const Shape& shape, Meridian pieces) {
  return std::make_unique<Revolution>(shape, std::move(pieces));
}

}  // namespace knead::detail
