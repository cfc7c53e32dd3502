#include "geometry.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "brep/geometry_forms.hpp"
#include "curves.hpp"
#include "instances.hpp"

namespace knead::step {

using brep::Conic;
using brep::CurveGeometry;

std::optional<brep::Frame> frame_of(const brep::AxisPlacement& placement) {
  return brep::frame_of(placement.origin, placement.axis, placement.ref_direction);
}

namespace {

// Curves and surfaces that are no B-splines, by the entities of ISO 10303-42 (clause 4.5) whose
// attributes are
//   LINE(pnt, dir)                              VECTOR(orientation, magnitude)
//   CIRCLE(position, radius)                    ELLIPSE(position, semi_axis_1, semi_axis_2)
//   HYPERBOLA(position, semi_axis, semi_imag_axis)   PARABOLA(position, focal_dist)
//   TRIMMED_CURVE(basis_curve, trim_1, trim_2, sense_agreement, master_representation)
//   PLANE(position)                             CYLINDRICAL_SURFACE(position, radius)
//   CONICAL_SURFACE(position, radius, semi_angle)
//   SPHERICAL_SURFACE(position, radius)         TOROIDAL_SURFACE(position, major, minor)
//   DEGENERATE_TOROIDAL_SURFACE(position, major, minor, select_outer)
//   SURFACE_OF_REVOLUTION(swept_curve, axis_position)
//   SURFACE_OF_LINEAR_EXTRUSION(swept_curve, extrusion_axis)
// each behind the name of its REPRESENTATION_ITEM. `inherited` counts the attributes before those
// that an entity declares itself: 1 is that name, 2 is also the position, or the swept curve.
constexpr int max_curve_nesting = 8;  // nested curves; more is a loop

std::optional<std::uint32_t> reference_at(const Reader& reader, std::uint32_t instance,
                                          const char* entity, std::size_t inherited,
                                          std::size_t k) {
  const auto attributes = reader.attributes(instance, entity, inherited, k + 1);
  return attributes.empty() ? std::nullopt : reader.reference(attributes[k]);
}

/// What a form says, at the record that it is read from.
template <class T>
Expected<T> at_record(const Reader& reader, std::uint32_t instance, Expected<T> form) {
  if (form || !form.error().where.empty()) return form;
  return reader.error(instance, form.error().what);
}

Expected<CurveGeometry> read_polyline(const Reader& reader, std::uint32_t instance) {
  const auto attributes = reader.attributes(instance, "POLYLINE", 1, 1);
  std::vector<Point> corners;
  for (const auto k :
       attributes.empty() ? std::vector<std::uint32_t>() : reader.references(attributes[0])) {
    const auto point = reader.point(k);
    if (!point) return std::unexpected(point.error());
    corners.push_back(*point);
  }
  return at_record(reader, instance, brep::polyline_of(corners));
}

/// CONIC(position); then CIRCLE(radius), PARABOLA(focal_dist), or both semi-axes.
Expected<CurveGeometry> read_conic(const Reader& reader, std::uint32_t instance, const char* entity,
                                   Conic::Form form) {
  const auto position =
      reference_at(reader, instance, "CONIC", reader.file().instance(instance).complex ? 0 : 1, 0);
  const auto placement = position ? read_placement(reader, *position) : std::nullopt;
  const bool one = reader.is(instance, "CIRCLE") || form == Conic::Form::parabola;
  const auto attributes = reader.attributes(instance, entity, 2, one ? 1 : 2);
  const double a = attributes.empty() ? 0 : reader.length(attributes[0]).value_or(0);
  const double b = one || attributes.empty() ? a : reader.length(attributes[1]).value_or(0);
  return at_record(reader, instance,
                   brep::conic_of(form, placement ? frame_of(*placement) : std::nullopt, a, b));
}

/// LINE(pnt, dir) with VECTOR(orientation, magnitude).
Expected<CurveGeometry> read_line(const Reader& reader, std::uint32_t instance) {
  const auto from = reference_at(reader, instance, "LINE", 1, 0);
  const auto vector = reference_at(reader, instance, "LINE", 1, 1);
  const auto orientation = vector ? reference_at(reader, *vector, "VECTOR", 1, 0) : std::nullopt;
  const auto point =
      from ? reader.point(*from) : Expected<Point>(reader.error(instance, "it has no point"));
  const auto direction = orientation ? reader.direction(*orientation) : std::nullopt;
  if (!point || !direction) return reader.error(instance, "it has no point or direction");
  const auto attributes = reader.attributes(*vector, "VECTOR", 1, 2);
  const double magnitude = attributes.empty() ? 1 : reader.length(attributes[1]).value_or(1);
  return at_record(reader, instance, brep::line_of(*point, *direction, magnitude));
}

Expected<CurveGeometry> read_nested(const Reader& reader, std::uint32_t instance, int depth) {
  if (depth > max_curve_nesting) return reader.error(instance, "it is made of itself");
  if (reader.is(instance, "LINE")) return read_line(reader, instance);
  for (const auto& [entity, form] :
       {std::pair("CIRCLE", Conic::Form::ellipse), std::pair("ELLIPSE", Conic::Form::ellipse),
        std::pair("HYPERBOLA", Conic::Form::hyperbola),
        std::pair("PARABOLA", Conic::Form::parabola)}) {
    if (reader.is(instance, entity)) return read_conic(reader, instance, entity, form);
  }
  if (is_surface_curve(reader, instance)) {
    const auto inner = reference_at(reader, instance, "SURFACE_CURVE", 1, 0);
    if (!inner) return reader.error(instance, "it has no curve in space");
    return read_nested(reader, *inner, depth + 1);
  }
  if (reader.is(instance, "TRIMMED_CURVE")) {
    const auto attributes = reader.attributes(instance, "TRIMMED_CURVE", 1, 4);
    const auto basis = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
    if (!basis) return reader.error(instance, "it has no basis curve");
    auto curve = read_nested(reader, *basis, depth + 1);
    if (curve && reader.enumeration(attributes[3]) == "F") curve->turned = !curve->turned;
    return curve;
  }
  if (reader.is(instance, "POLYLINE")) return read_polyline(reader, instance);
  auto spline = read_b_spline_curve(reader, instance);
  if (!spline) return std::unexpected(std::move(spline.error()));
  return brep::spline_of(*std::move(spline));
}

std::optional<brep::Frame> position_of(const Reader& reader, std::uint32_t instance) {
  const bool complex = reader.file().instance(instance).complex;
  const auto attributes = reader.attributes(instance, "ELEMENTARY_SURFACE", complex ? 0 : 1, 1);
  const auto position = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
  const auto placement = position ? read_placement(reader, *position) : std::nullopt;
  return placement ? frame_of(*placement) : std::nullopt;
}

/// Of an AXIS1_PLACEMENT(location, axis).
Expected<brep::Frame> axis_of(const Reader& reader, std::uint32_t instance) {
  const auto attributes = reader.attributes(instance, "AXIS1_PLACEMENT", 1, 2);
  const auto location = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
  const auto axis = attributes.empty() ? std::nullopt : reader.reference(attributes[1]);
  const auto origin = location ? reader.point(*location)
                               : Expected<Point>(reader.error(instance, "it has no location"));
  const Point z = (axis ? reader.direction(*axis) : std::nullopt).value_or(Point::UnitZ());
  if (!origin) return std::unexpected(origin.error());
  if (!(z.norm() > 0)) return reader.error(instance, "its axis has no length");
  return brep::frame_about(*origin, z);
}

/// Of a VECTOR(orientation, magnitude), at the origin.
Expected<brep::Frame> direction_of(const Reader& reader, std::uint32_t instance) {
  const auto attributes = reader.attributes(instance, "VECTOR", 1, 2);
  const auto orientation = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
  const auto direction = orientation ? reader.direction(*orientation) : std::nullopt;
  if (!direction || !(direction->norm() > 0)) return reader.error(instance, "it has no direction");
  return brep::frame_about(Point::Zero(), *direction);
}

struct ElementaryForm {
  const char* entity;
  brep::ElementarySurface::Kind kind;
  std::size_t lengths;
};

Expected<brep::ElementarySurface> read_elementary(const Reader& reader, std::uint32_t instance,
                                                  const ElementaryForm& form) {
  const auto attributes = reader.attributes(instance, form.entity, 2, form.lengths);
  const auto length = [&](std::size_t k) {
    return k < attributes.size() ? reader.length(attributes[k]).value_or(0) : 0.0;
  };
  auto surface = at_record(
      reader, instance,
      brep::elementary_of(form.kind, position_of(reader, instance), length(0), length(1)));
  if (!surface) return surface;
  // select_outer F is the part inside, the lemon, which exists only where the minor radius is the
  // larger one.
  surface->inner = form.lengths == 3 && reader.enumeration(attributes[2]) == "F" &&
                   surface->second > surface->radius;
  return surface;
}

Expected<brep::SweptSurface> read_swept(const Reader& reader, std::uint32_t instance,
                                        const char* entity) {
  const bool revolution = std::string_view(entity) == "SURFACE_OF_REVOLUTION";
  const bool complex = reader.file().instance(instance).complex;
  const auto sweep = reader.attributes(instance, entity, 2, 1);
  const auto target =
      sweep.empty() ? no_instance : reader.reference(sweep[0]).value_or(no_instance);
  const auto swept = reader.attributes(instance, "SWEPT_SURFACE", complex ? 0 : 1, 1);
  const auto curve = swept.empty() ? no_instance : reader.reference(swept[0]).value_or(no_instance);
  if (target == no_instance || curve == no_instance)
    return reader.error(instance, "it has no swept curve, or no way to sweep it");
  const auto frame = revolution ? axis_of(reader, target) : direction_of(reader, target);
  if (!frame) return std::unexpected(frame.error());
  brep::SweptSurface surface{revolution, *frame};
  auto geometry = read_curve(reader, curve);
  if (geometry)
    surface.curve = std::make_shared<const CurveGeometry>(*std::move(geometry));
  else
    surface.wrong = brep::fault(std::move(geometry.error()));
  return surface;
}

}  // namespace

bool is_surface_curve(const Reader& reader, std::uint32_t instance) {
  constexpr std::array kinds = {"SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE",
                                "BOUNDED_SURFACE_CURVE"};
  return std::ranges::any_of(kinds, [&](const char* kind) { return reader.is(instance, kind); });
}

bool is_parameter_curve(const Reader& reader, std::uint32_t instance) {
  return reader.is(instance, "PCURVE") || reader.is(instance, "BOUNDED_PCURVE");
}

Expected<CurveGeometry> read_curve(const Reader& reader, std::uint32_t instance) {
  return read_nested(reader, instance, 0);
}

void read_form(const Reader& reader, std::uint32_t instance, brep::Support& support) {
  using Kind = brep::ElementarySurface::Kind;
  constexpr std::array<ElementaryForm, 6> elementary_forms = {
      {{"PLANE", Kind::plane, 0},
       {"CYLINDRICAL_SURFACE", Kind::cylinder, 1},
       {"CONICAL_SURFACE", Kind::cone, 2},
       {"SPHERICAL_SURFACE", Kind::sphere, 1},
       {"TOROIDAL_SURFACE", Kind::torus, 2},
       {"DEGENERATE_TOROIDAL_SURFACE", Kind::torus, 3}}};
  const auto fill = [&](auto form) {
    if (form)
      support.form = *std::move(form);
    else
      support.wrong = brep::fault(std::move(form.error()));
  };
  for (const auto& form : elementary_forms) {
    if (reader.is(instance, form.entity)) return fill(read_elementary(reader, instance, form));
  }
  for (const char* entity : {"SURFACE_OF_REVOLUTION", "SURFACE_OF_LINEAR_EXTRUSION"}) {
    if (reader.is(instance, entity)) return fill(read_swept(reader, instance, entity));
  }
}

// Files mix contexts in degrees and in radians, and a conical surface does not say in which it
// stands. All units are collected, and the edges of a face tell which one brings the cone to them
// (`FaceSurface::create`).
std::vector<double> plane_angle_units(const Reader& reader) {
  std::vector<double> result;
  const auto add = [&](double unit) {
    if (std::find(result.begin(), result.end(), unit) == result.end()) result.push_back(unit);
  };
  for (const auto k : reader.file().named({"PLANE_ANGLE_UNIT"})) {
    if (reader.is(k, "SI_UNIT")) {
      add(1);
    } else if (const auto attributes = reader.attributes(k, "CONVERSION_BASED_UNIT", 1, 2);
               !attributes.empty()) {
      // PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174…), radian)
      const auto measure = reader.reference(attributes[1]);
      const auto value = measure ? reader.attributes(*measure, "MEASURE_WITH_UNIT", 0, 2)
                                 : std::vector<std::uint32_t>();
      if (value.empty() || reader.file().value(value[0]).kind != Part21Kind::typed) continue;
      const auto inner = reader.file().children(value[0]);
      const auto radians = inner.empty() ? std::nullopt : reader.real(inner[0]);
      if (radians && *radians > 0) add(*radians);
    }
  }
  if (result.empty()) result.push_back(1);
  return result;
}

}  // namespace knead::step
