#include "model_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exchange/part21/part21_text.hpp"
#include "print.hpp"

namespace knead::step {
namespace {

constexpr double same_axes = 1e-14;  // of the longer semi-axis: an ellipse is a circle

}  // namespace

std::string ModelGeometry::direction(const Point& d) {
  return file_.add(fmt::format("DIRECTION('',({},{},{}))", format_real(d.x()), format_real(d.y()),
                               format_real(d.z())));
}

std::string ModelGeometry::placement(const brep::Frame& frame) {
  const auto origin = file_.add_point(frame.origin.data()), axis = direction(frame.z),
             along = direction(frame.x);
  return file_.add(fmt::format("AXIS2_PLACEMENT_3D('',{},{},{})", origin, axis, along));
}

std::string ModelGeometry::line(const brep::Line& line, bool turned) {
  const auto point = file_.add_point(line.origin.data()),
             way = direction(turned ? -line.direction : line.direction);
  const auto vector = file_.add(fmt::format("VECTOR('',{},{})", way, format_real(line.magnitude)));
  return file_.add(fmt::format("LINE('',{},{})", point, vector));
}

/// Turned, b points the other way.
/// A placement is right-handed, so that a conic runs the other way only if its axis z does.
std::string ModelGeometry::conic(const brep::Conic& conic, bool turned) {
  const double a = conic.a.norm(), b = conic.b.norm();
  brep::Frame frame{conic.centre};
  frame.x = conic.a / a;
  // The placement of a conic has no other freedom: x along a, and z such that y = z × x is along b.
  frame.z = conic.a.cross(turned ? Point(-conic.b) : conic.b).normalized();
  const auto position = placement(frame);
  switch (conic.form) {
    case brep::Conic::Form::hyperbola:
      return file_.add(
          fmt::format("HYPERBOLA('',{},{},{})", position, format_real(a), format_real(b)));
    case brep::Conic::Form::parabola:
      return file_.add(fmt::format("PARABOLA('',{},{})", position, format_real(a)));
    case brep::Conic::Form::ellipse:
      break;
  }
  if (std::abs(a - b) <= same_axes * std::max(a, b))
    return file_.add(fmt::format("CIRCLE('',{},{})", position, format_real(a)));
  return file_.add(fmt::format("ELLIPSE('',{},{},{})", position, format_real(a), format_real(b)));
}

std::string ModelGeometry::spline(const Surface& surface, const std::string& name) {
  std::vector<std::string> points;
  for (Eigen::Index k = 0; k < surface.size(); ++k)
    points.push_back(file_.add_point(surface.control_points().row(k).data()));
  return file_.add(print_surface(
      surface, encode_string(name), [&](int k) { return points[static_cast<std::size_t>(k)]; },
      "\n"));
}

std::string ModelGeometry::spline(const Curve& curve, const std::string& name) {
  std::vector<std::string> points;
  for (Eigen::Index k = 0; k < curve.size(); ++k)
    points.push_back(file_.add_point(curve.control_points().row(k).data()));
  return file_.add(print_curve(curve, encode_string(name),
                               [&](int k) { return points[static_cast<std::size_t>(k)]; }));
}

/// \param turned against its form, which lines and conics can be
std::string ModelGeometry::form(const brep::CurveGeometry& curve, bool turned) {
  if (const auto* typed = std::get_if<brep::Line>(&curve.form)) return line(*typed, turned);
  if (const auto* typed = std::get_if<brep::Conic>(&curve.form)) return conic(*typed, turned);
  const Curve& curve_spline = *std::get<std::shared_ptr<const Curve>>(curve.form);
  if (!curve.polyline) return spline(curve_spline, {});
  std::string corners;
  for (Eigen::Index k = 0; k < curve_spline.size(); ++k)
    corners += (k == 0 ? "" : ",") + file_.add_point(curve_spline.control_points().row(k).data());
  return file_.add("POLYLINE('',(" + corners + "))");
}

/// As the model has it: a spline that runs against its form is trimmed to all of it, the other way.
std::string ModelGeometry::swept_curve(const brep::CurveGeometry& curve) {
  const auto* typed = std::get_if<std::shared_ptr<const Curve>>(&curve.form);
  if (!curve.turned || typed == nullptr) return form(curve, curve.turned);
  const Interval domain = (*typed)->knots(0).domain();
  return file_.add(fmt::format(
      "TRIMMED_CURVE('',{},(PARAMETER_VALUE({})),(PARAMETER_VALUE({})),.F.,.PARAMETER.)",
      form(curve, false), format_real(domain.upper), format_real(domain.lower)));
}

std::string ModelGeometry::elementary(const brep::ElementarySurface& surface) {
  using Kind = brep::ElementarySurface::Kind;
  const auto position = placement(surface.frame), radius = format_real(surface.radius),
             second = format_real(surface.second);
  switch (surface.kind) {
    case Kind::plane:
      return file_.add(fmt::format("PLANE('',{})", position));
    case Kind::cylinder:
      return file_.add(fmt::format("CYLINDRICAL_SURFACE('',{},{})", position, radius));
    case Kind::cone:
      return file_.add(fmt::format("CONICAL_SURFACE('',{},{},{})", position, radius, second));
    case Kind::sphere:
      return file_.add(fmt::format("SPHERICAL_SURFACE('',{},{})", position, radius));
    case Kind::torus:
      break;
  }
  // A DEGENERATE_TOROIDAL_SURFACE (ISO 10303-42) has a minor radius above the major one: it meets
  // itself, and says whether its outer part is meant.
  if (surface.second <= surface.radius)
    return file_.add(fmt::format("TOROIDAL_SURFACE('',{},{},{})", position, radius, second));
  return file_.add(fmt::format("DEGENERATE_TOROIDAL_SURFACE('',{},{},{},{})", position, radius,
                               second, surface.inner ? ".F." : ".T."));
}

std::string ModelGeometry::swept(const brep::SweptSurface& surface) {
  const auto curve = swept_curve(*surface.curve), axis = direction(surface.frame.z);
  if (!surface.revolution) {
    const auto vector = file_.add(fmt::format("VECTOR('',{},1.)", axis));
    return file_.add(fmt::format("SURFACE_OF_LINEAR_EXTRUSION('',{},{})", curve, vector));
  }
  const auto origin = file_.add_point(surface.frame.origin.data());
  const auto position = file_.add(fmt::format("AXIS1_PLACEMENT('',{},{})", origin, axis));
  return file_.add(fmt::format("SURFACE_OF_REVOLUTION('',{},{})", curve, position));
}

std::string ModelGeometry::surface(brep::Index support) {
  const auto [at, fresh] = surfaces_.try_emplace(support);
  if (!fresh) return at->second;
  const brep::Support& stored = model_.supports[support];
  if (stored.spline != brep::none) {
    const brep::SplineSurface& s = model_.surfaces[stored.spline];
    return at->second = spline(s.surface, s.name);
  }
  if (const auto* form = std::get_if<brep::ElementarySurface>(&stored.form))
    return at->second = elementary(*form);
  return at->second = swept(std::get<brep::SweptSurface>(stored.form));
}

std::string ModelGeometry::vertex(brep::Index vertex) {
  const auto [at, fresh] = vertices_.try_emplace(vertex);
  if (fresh)
    at->second =
        file_.add("VERTEX_POINT(''," + file_.add_point(model_.vertices[vertex].place.data()) + ")");
  return at->second;
}

std::string ModelGeometry::edge(brep::Index edge) {
  const auto [at, fresh] = edges_.try_emplace(edge);
  if (!fresh) return at->second;
  const brep::Edge& stored = model_.edges[edge];
  const auto [curve, first] = curves_.try_emplace(stored.curve.get());
  if (first) curve->second = form(*stored.curve, false);
  return at->second = file_.add(fmt::format("EDGE_CURVE('',{},{},{},{})", vertex(stored.start),
                                            vertex(stored.end), curve->second,
                                            plan_.edges[edge]->backwards ? ".F." : ".T."));
}

}  // namespace knead::step
