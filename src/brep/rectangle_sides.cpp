#include "rectangle_sides.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "boundary_curve.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "edge_curve.hpp"

namespace knead::brep {
namespace {

constexpr double point_size = 1e-9;     // of the surface's: sides that are points
constexpr double beside_domain = 1e-9;  // of a domain, by rounding

/// Points of a swept surface at the corners of the rectangle, which say how much of an unbounded
/// profile is needed.
Expected<std::vector<Point>> points_on(const Support& support, const Interval& u,
                                       const Interval& v) {
  std::vector<Point> result;
  const auto* swept = std::get_if<SweptSurface>(&support.form);
  if (swept == nullptr || !swept->curve) return result;
  const auto profile = EdgeCurve::create(*swept->curve);
  if (!profile) return std::unexpected(profile.error());
  const Interval& along = swept->revolution ? v : u;
  for (const double t : {along.lower, along.upper}) result.push_back(profile->at(t));
  return result;
}

/// The exact spline that a surface is over a rectangle, which may be a part of it.
Expected<Surface> spline_over(const Model& model, const Support& support, const Interval& u,
                              const Interval& v) {
  if (support.spline != none) return model.surfaces[support.spline].surface;
  const auto on_it = points_on(support, u, v);
  if (!on_it) return std::unexpected(on_it.error());
  const auto surface = FaceSurface::create(model, support, *on_it);
  if (!surface) return std::unexpected(surface.error());
  const auto whole = surface->whole();
  return surface->patch(whole[0].value_or(u), whole[1].value_or(v));
}

/// A parameter that rounding put beside a domain; none farther out.
std::optional<double> within(double t, const Interval& domain) {
  const double near = beside_domain * domain.length();
  if (!(t >= domain.lower - near && t <= domain.upper + near)) return std::nullopt;
  return std::clamp(t, domain.lower, domain.upper);
}

}  // namespace

Expected<std::vector<BoundaryPiece>> rectangle_sides(const Model& model, const Support& support,
                                                     const Interval& u, const Interval& v) {
  if (support.wrong) return std::unexpected(*support.wrong);
  if (!(u.length() > 0 && v.length() > 0))
    return model.error(support, "its parameters enclose nothing");
  const auto surface = spline_over(model, support, u, v);
  if (!surface) return std::unexpected(surface.error());
  std::array<Interval, 2> range = {u, v};
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = surface->knots(static_cast<int>(d)).domain();
    const auto lower = within(range[d].lower, domain), upper = within(range[d].upper, domain);
    if (!lower || !upper)
      return model.error(support, "the rectangle reaches beyond its parameters");
    range[d] = {*lower, *upper};
  }
  const double size = net_diagonal(surface->control_points());
  std::vector<BoundaryPiece> result;
  struct Side {
    int across, end;
    bool reversed;
  };
  // Counter-clockwise in (u, v): v lower, u upper, v upper backwards, u lower backwards. Sides that
  // are points, as at poles, are left out.
  for (const Side& side :
       {Side{1, 0, false}, Side{0, 1, false}, Side{1, 1, true}, Side{0, 0, true}}) {
    const Interval& across = range[static_cast<std::size_t>(side.across)];
    const Interval along = range[static_cast<std::size_t>(1 - side.across)];
    auto made = isocurve(*surface, side.across, side.end == 0 ? across.lower : across.upper,
                         side.end == 0 ? knead::Side::right : knead::Side::left);
    if (!made) return std::unexpected(made.error());
    if (net_diagonal(made->control_points()) <= point_size * size) continue;
    BoundaryPiece& piece = result.emplace_back();
    piece.set(std::make_shared<const Curve>(*std::move(made)), along);
    piece.reversed = side.reversed;
  }
  return result;
}

Expected<std::array<Interval, 2>> whole_rectangle(const Model& model, const Support& support) {
  if (support.wrong) return std::unexpected(*support.wrong);
  if (support.spline != none) {
    const Surface& surface = model.surfaces[support.spline].surface;
    return std::array{surface.knots(0).domain(), surface.knots(1).domain()};
  }
  const auto surface = FaceSurface::create(model, support, {});
  if (!surface) return std::unexpected(surface.error());
  std::array<Interval, 2> result;
  for (std::size_t d = 0; d < 2; ++d) {
    if (const auto whole = surface->whole()[d]) {
      result[d] = *whole;
    } else if (surface->periods()[d] > 0) {
      result[d] = {0, surface->periods()[d]};
    } else if (d == 1 && surface->poles()[0] && surface->poles()[1]) {
      result[d] = {*surface->poles()[0], *surface->poles()[1]};
    } else {
      return model.error(support, "it is unbounded, and has no boundary of its own");
    }
  }
  return result;
}

}  // namespace knead::brep
