// Elementary and swept surfaces as B-spline surfaces.
#include <cmath>
#include <numbers>

#include "exact_arcs.hpp"
#include "face_surface.hpp"

namespace knead::brep {
namespace {

Expected<Curve> segment(const Interval& range, const Point& from, const Point& to) {
  auto knots = KnotVector::create(1, {range.lower, range.lower, range.upper, range.upper});
  if (!knots) return std::unexpected(knots.error());
  Points points(2, 3);
  points << from.transpose(), to.transpose();
  return Curve::create({*std::move(knots)}, std::move(points));
}

}  // namespace

// The corner of a part is where the tangents at its ends meet: for a parabola the value of its
// blossom, for a hyperbola as for an ellipse with cosh and sinh.
Expected<Curve> EdgeCurve::spline(const Interval& range) const {
  if (const auto* table = std::get_if<CurveTable>(&form_)) return table->curve();
  if (std::holds_alternative<Line>(form_)) return segment(range, at(range.lower), at(range.upper));
  const auto& conic = std::get<Conic>(form_);
  const auto& [form, centre, a, b] = conic;
  if (form == Conic::Form::ellipse) return ellipse_spline(centre, a, b, range);
  const bool parabola = form == Conic::Form::parabola;
  // A parabola is a polynomial, one piece of any length. A hyperbola's middle weight is cosh(δ/2);
  // pieces of δ <= 1 keep it below 1.13.
  const int pieces = parabola ? 1 : std::max(1, static_cast<int>(std::ceil(range.length())));
  return conic_spline(
      range, pieces, false, [&](double t) { return at(t); },
      [&](double from, double to) {
        if (parabola)
          return ConicCorner{conic.centre + from * to * conic.a + (from + to) * conic.b, 1};
        const double middle = (from + to) / 2, weight = std::cosh((to - from) / 2);
        return ConicCorner{
            conic.centre + (std::cosh(middle) * conic.a + std::sinh(middle) * conic.b) / weight,
            weight};
      });
}

std::optional<Interval> EdgeCurve::whole() const {
  return std::holds_alternative<CurveTable>(form_) ? domain_ : std::nullopt;
}

std::array<std::optional<Interval>, 2> FaceSurface::whole() const {
  if (!profile_) return {};
  return kind_ == Kind::extrusion ? std::array{profile_->whole(), std::optional<Interval>()}
                                  : std::array{std::optional<Interval>(), profile_->whole()};
}

void FaceSurface::align(const Point& direction) {
  const Point across = direction - direction.dot(frame_.z) * frame_.z;
  if (kind_ != Kind::plane || !(across.norm() > 0)) return;
  frame_.x = across.normalized();
  frame_.y = frame_.z.cross(frame_.x);
}

Expected<Surface> FaceSurface::patch(const Interval& u, const Interval& v) const {
  const auto& [origin, x, y, z] = frame_;
  Expected<Curve> profile = std::unexpected(Error{});
  switch (kind_) {
    case Kind::plane:
      profile = segment(u, at({u.lower, 0}), at({u.upper, 0}));
      return profile ? swept_along(*profile, y, v)
                     : Expected<Surface>(std::unexpected(profile.error()));
    case Kind::extrusion:
      profile = profile_->spline(u);
      return profile ? swept_along(*profile, z, v)
                     : Expected<Surface>(std::unexpected(profile.error()));
    case Kind::cylinder:
    case Kind::cone:
      profile = segment(v, at({0, v.lower}), at({0, v.upper}));
      break;
    case Kind::sphere:
      profile = ellipse_spline(origin, radius_ * x, radius_ * z, v);
      break;
    case Kind::torus:
      profile = ellipse_spline(origin + radius_ * x, minor_ * x, minor_ * z, v);
      break;
    case Kind::revolution:
      if (one_side_ && profile_->whole())
        return input_error("the spline that it turns crosses its axis");
      profile = profile_->spline(v);
      break;
  }
  return profile ? swept_about(*profile, origin, z, u)
                 : Expected<Surface>(std::unexpected(profile.error()));
}

}  // namespace knead::brep
