#include "boundary_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "brep/edge_curve.hpp"
#include "brep/fitted_curve.hpp"
#include "exchange/step/faces.hpp"
#include "exchange/step/geometry.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::step {
namespace {

constexpr int most_nested = 8;

bool is_composite(const Reader& reader, std::uint32_t instance) {
  constexpr std::array kinds = {"COMPOSITE_CURVE", "COMPOSITE_CURVE_ON_SURFACE", "BOUNDARY_CURVE",
                                "OUTER_BOUNDARY_CURVE"};
  return std::ranges::any_of(kinds, [&](const char* kind) { return reader.is(instance, kind); });
}

/// A curve from one parameter to another, which may be less.
struct Range {
  brep::CurveGeometry geometry;
  std::shared_ptr<const brep::EdgeCurve> curve;
  std::optional<double> from = {}, to = {};  ///< none: it has no end
};

/// The parameter of a TRIMMED_CURVE's limit: a point or PARAMETER_VALUE(t), or both.
std::optional<double> limit_of(const Reader& reader, std::uint32_t list, const Range& range,
                               bool prefer_parameter, double angle_unit) {
  std::optional<double> by_point, by_parameter;
  for (const std::uint32_t value :
       reader.is_list(list) ? reader.file().children(list) : std::vector<std::uint32_t>()) {
    if (const auto target = reader.reference(value)) {
      if (const auto place = reader.point(*target)) by_point = range.curve->parameter(*place);
    } else if (reader.file().value(value).kind == Part21Kind::typed) {
      const auto inner = reader.file().children(value);
      const auto t = inner.empty() ? std::nullopt : reader.real(inner[0]);
      if (!t) continue;
      const auto* line = std::get_if<brep::Line>(&range.geometry.form);
      const auto* conic = std::get_if<brep::Conic>(&range.geometry.form);
      const bool angle = conic != nullptr && conic->form == brep::Conic::Form::ellipse;
      by_parameter = *t * (line != nullptr ? line->magnitude : angle ? angle_unit : 1);
    }
  }
  // master_representation says which to prefer where both are given; points are the better ones
  // where it does not, as parameters of lines and circles are often in the wrong unit.
  return prefer_parameter && by_parameter ? by_parameter : by_point ? by_point : by_parameter;
}

/// The curve in space or in parameters that a record gives, with its ends.
Expected<Range> range_of(const Reader& reader, std::uint32_t instance) {
  auto geometry = read_curve(reader, instance);
  if (!geometry) return std::unexpected(std::move(geometry.error()));
  auto made = brep::EdgeCurve::create(*geometry);
  if (!made) return std::unexpected(std::move(made.error()));
  Range range{*geometry, std::make_shared<const brep::EdgeCurve>(*std::move(made))};
  if (const auto domain = range.curve->domain()) {
    range.from = domain->lower;
    range.to = domain->upper;
  }
  if (!reader.is(instance, "TRIMMED_CURVE")) return range;
  const auto attributes = reader.attributes(instance, "TRIMMED_CURVE", 1, 5);
  const bool forward = attributes.empty() || reader.enumeration(attributes[3]) != "F";
  const bool conic = std::holds_alternative<brep::Conic>(range.geometry.form);
  const auto unit = conic ? reader.angle_unit(instance) : Expected<double>(1);
  if (attributes.empty() || !unit)
    return attributes.empty() ? reader.error(instance, "it has no limits")
                              : std::unexpected(unit.error());
  const bool by_parameter = reader.enumeration(attributes[4]) == "PARAMETER";
  range.from = limit_of(reader, attributes[1], range, by_parameter, *unit);
  range.to = limit_of(reader, attributes[2], range, by_parameter, *unit);
  if (!range.from || !range.to || !range.curve->closed()) return range;
  const double period = range.curve->domain()->length(), near = 1e-9 * period;
  // A closed curve is run through from trim_1 to trim_2 in the direction of sense_agreement: across
  // its start, if need be.
  if (forward && *range.to <= *range.from + near) *range.to += period;
  if (!forward && *range.from <= *range.to + near) *range.from += period;
  return range;
}

Expected<SurfacePiece> with_ends(const Reader& reader, std::uint32_t instance, const Range& range) {
  if (!range.from || !range.to)
    return reader.error(instance, "a boundary's curve has no ends",
                        "give it limits, as a TRIMMED_CURVE has");
  SurfacePiece piece;
  piece.geometry = range.geometry;
  piece.at = [curve = range.curve, from = *range.from, to = *range.to](double t) {
    return curve->at(std::lerp(from, to, t));
  };
  return piece;
}

}  // namespace

Expected<std::array<double, 2>> parameter_scale(const Reader& reader, std::uint32_t surface,
                                                const brep::Support& support) {
  std::array<double, 2> scale = {1, 1};
  const auto angle = [&](double& factor) -> Expected<void> {
    const auto unit = reader.angle_unit(surface);
    if (!unit) return std::unexpected(unit.error());
    factor = *unit;
    return {};
  };
  const auto profile = [&](const brep::CurveGeometry& curve, double& factor) -> Expected<void> {
    if (const auto* line = std::get_if<brep::Line>(&curve.form)) factor = line->magnitude;
    const auto* conic = std::get_if<brep::Conic>(&curve.form);
    return conic != nullptr && conic->form == brep::Conic::Form::ellipse ? angle(factor)
                                                                         : Expected<void>();
  };
  Expected<void> found;
  if (const auto* elementary = std::get_if<brep::ElementarySurface>(&support.form)) {
    using Kind = brep::ElementarySurface::Kind;
    if (elementary->kind != Kind::plane) found = angle(scale[0]);
    if (elementary->kind == Kind::sphere || elementary->kind == Kind::torus)
      found = angle(scale[1]);
  } else if (const auto* swept = std::get_if<brep::SweptSurface>(&support.form);
             swept != nullptr && swept->curve) {
    if (swept->revolution) found = angle(scale[0]);
    if (found) found = profile(*swept->curve, scale[swept->revolution ? 1 : 0]);
    if (!swept->revolution) {
      const auto attributes = reader.attributes(surface, "SURFACE_OF_LINEAR_EXTRUSION", 2, 1);
      const auto vector = attributes.empty() ? std::nullopt : reader.reference(attributes[0]);
      const auto magnitude =
          vector ? reader.attributes(*vector, "VECTOR", 1, 2) : std::vector<std::uint32_t>();
      if (!magnitude.empty()) scale[1] = reader.length(magnitude[1]).value_or(1);
    }
  }
  if (!found) return std::unexpected(found.error());
  return scale;
}

Expected<Point> PieceReader::Surface::at(const brep::Model& model, const Point& uv) const {
  const double u = scale[0] * uv.x(), v = scale[1] * uv.y();
  if (form) return form->at({u, v});
  const brep::SplineSurface& spline = model.surfaces[support->spline];
  std::array<double, 2> at = {u, v};
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = spline.surface.knots(static_cast<int>(d)).domain();
    if (spline.closed[d])
      at[d] -= std::floor((at[d] - domain.lower) / domain.length()) * domain.length() *
               (at[d] < domain.lower || at[d] > domain.upper ? 1 : 0);
    at[d] = std::clamp(at[d], domain.lower, domain.upper);
  }
  return evaluate_point<2>(spline.surface, at);
}

Expected<PieceReader::Surface> PieceReader::surface(std::uint32_t basis,
                                                    const brep::Support& support) const {
  if (support.wrong) return std::unexpected(*support.wrong);
  Surface result{basis, &support};
  if (support.spline != brep::none) return result;
  const auto scale = parameter_scale(reader_, basis, support);
  if (!scale) return std::unexpected(scale.error());
  result.scale = *scale;
  // What is drawn of an unbounded profile is not known here: a point in parameters lies anywhere on
  // it.
  if (const auto* swept = std::get_if<brep::SweptSurface>(&support.form);
      swept == nullptr || !swept->curve ||
      std::holds_alternative<std::shared_ptr<const Curve>>(swept->curve->form)) {
    auto form = brep::FaceSurface::create(model_, support, {});
    if (!form) return std::unexpected(std::move(form.error()));
    result.form = *std::move(form);
  }
  return result;
}

Expected<void> PieceReader::add(std::uint32_t curve, std::uint32_t basis,
                                const brep::Support& support, std::vector<SurfacePiece>& pieces) {
  const auto on = surface(basis, support);
  if (!on) return std::unexpected(on.error());
  return add_composite(curve, true, *on, 0, pieces);
}

Expected<void> PieceReader::add_composite(std::uint32_t curve, bool forward, const Surface& on,
                                          int depth, std::vector<SurfacePiece>& pieces) {
  if (depth > most_nested) return reader_.error(curve, "it is made of itself");
  if (!is_composite(reader_, curve)) return reader_.error(curve, "a boundary of an unknown kind");
  const auto attributes = reader_.attributes(curve, "COMPOSITE_CURVE", 1, 1);
  auto segments =
      attributes.empty() ? std::vector<std::uint32_t>() : reader_.references(attributes[0]);
  if (segments.empty()) return reader_.error(curve, "it has no segments");
  if (!forward) std::ranges::reverse(segments);
  for (const std::uint32_t segment : segments) {
    if (auto status = add_segment(segment, forward, on, depth, pieces); !status) return status;
  }
  return {};
}

/// COMPOSITE_CURVE_SEGMENT(transition, same_sense, parent_curve).
Expected<void> PieceReader::add_segment(std::uint32_t segment, bool forward, const Surface& on,
                                        int depth, std::vector<SurfacePiece>& pieces) {
  if (++pieces_ > free_edge_uses + edge_uses_per_record * reader_.file().instances().size())
    return reader_.error(segment, "boundaries are repeated too often",
                         "give every surface boundaries of its own");
  const auto attributes = reader_.attributes(segment, "COMPOSITE_CURVE_SEGMENT", 0, 3);
  const auto parent = attributes.empty() ? std::nullopt : reader_.reference(attributes[2]);
  if (!parent)
    return reader_.error(segment, "a COMPOSITE_CURVE_SEGMENT with a curve is needed here");
  const bool along = (reader_.enumeration(attributes[1]) != "F") == forward;
  if (is_composite(reader_, *parent)) return add_composite(*parent, along, on, depth + 1, pieces);
  auto made = piece(*parent, on);
  if (!made) return std::unexpected(std::move(made.error()));
  made->name = name_of(reader_, *parent);
  made->reversed = !along;
  made->source.segment = segment;
  made->source.parent = attributes[2];
  if (made->source.carrier == no_instance) made->source.value = attributes[2];
  if (made->from() == made->to() && made->at(0.5) == made->from() && made->at(0.25) == made->from())
    return {};  // a pole
  pieces.push_back(*std::move(made));
  return {};
}

Expected<SurfacePiece> PieceReader::piece(std::uint32_t curve, const Surface& on) const {
  if (is_parameter_curve(reader_, curve)) return lifted(curve, on);
  if (is_surface_curve(reader_, curve)) return on_surface(curve, on);
  const auto range = range_of(reader_, curve);
  if (!range) return std::unexpected(range.error());
  auto result = with_ends(reader_, curve, *range);
  if (!result) return result;
  // A limited SURFACE_CURVE gives its limits in the parameters of the curve that it has.
  const auto attributes = reader_.attributes(curve, "TRIMMED_CURVE", 1, 1);
  const auto basis = reader_.is(curve, "TRIMMED_CURVE") && !attributes.empty()
                         ? reader_.reference(attributes[0])
                         : std::nullopt;
  result->fixed = basis && is_surface_curve(reader_, *basis);
  result->in_space = !result->fixed;
  return result;
}

/// SURFACE_CURVE(curve in space, what it lies on, which of them is the master).
Expected<SurfacePiece> PieceReader::on_surface(std::uint32_t curve, const Surface& on) const {
  const auto attributes = reader_.attributes(curve, "SURFACE_CURVE", 1, 2);
  const auto inner = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
  if (!inner) return reader_.error(curve, "it has no curve in space");
  auto range = range_of(reader_, *inner);
  if (!range) return std::unexpected(std::move(range.error()));
  for (const std::uint32_t other : reader_.references(attributes[1])) {
    if (range->from && range->to) break;
    if (!is_parameter_curve(reader_, other)) continue;
    const auto flat = lifted(other, on);
    if (!flat) continue;
    range->from = range->curve->parameter(flat->at(0));
    range->to = range->curve->parameter(flat->at(1));
  }
  auto result = with_ends(reader_, *inner, *range);
  if (!result) return result;
  result->in_space = true;
  result->source.carrier = curve;
  result->source.value = attributes[0];
  return result;
}

/// PCURVE(basis surface, DEFINITIONAL_REPRESENTATION of one curve in its parameters).
Expected<SurfacePiece> PieceReader::lifted(std::uint32_t pcurve, const Surface& on) const {
  const auto attributes = reader_.attributes(pcurve, "PCURVE", 1, 2);
  const auto representation = attributes.empty() ? std::nullopt : reader_.reference(attributes[1]);
  const auto items = representation ? reader_.attributes(*representation, "REPRESENTATION", 0, 2)
                                    : std::vector<std::uint32_t>();
  const auto curves = items.empty() ? std::vector<std::uint32_t>() : reader_.references(items[1]);
  if (curves.empty()) return reader_.error(pcurve, "it has no curve in parameters");
  if (untrimmed(reader_, reader_.reference(attributes[0])) != on.basis)
    return reader_.error(pcurve, "it lies on another surface than the one that it bounds");
  if (on.support->spline == brep::none && !on.form)
    return reader_.error(pcurve,
                         "a boundary in parameters of a surface swept by an unbounded curve",
                         "give the boundary curves in space, too");
  const Reader flat = reader_.in_parameters();
  const auto range = range_of(flat, curves[0]);
  if (!range) return std::unexpected(range.error());
  if (!range->from || !range->to) return reader_.error(curves[0], "a boundary's curve has no ends");
  const double from = *range->from, to = *range->to;
  const auto at = [&](double t) { return on.at(model_, range->curve->at(std::lerp(from, to, t))); };
  std::vector<double> corners = range->curve->corners();
  for (double& t : corners) t = (t - from) / (to - from);
  // A curve in parameters has no curve in space: it is interpolated through the surface, to 1e-8 of
  // its size. Corners in parameters are corners in space unless the surface is singular there.
  auto fitted = brep::lifted_curve(at, std::move(corners));
  if (!fitted) return std::unexpected(std::move(fitted.error()));
  SurfacePiece piece;
  if (!*fitted) {  // a pole
    const auto place = at(0);
    if (!place) return std::unexpected(place.error());
    piece.at = [place = *place](double) { return place; };
    return piece;
  }
  piece.set(std::make_shared<const Curve>(**std::move(fitted)), {0, 1});
  return piece;
}

}  // namespace knead::step
