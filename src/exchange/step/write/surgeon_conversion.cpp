#include <algorithm>

#include "brep/boundary_curve.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/faces.hpp"
#include "exchange/step/geometry.hpp"
#include "print.hpp"
#include "surgeon.hpp"

namespace knead::step {
namespace {

/// What gives the parameters of a surface a meaning, or makes another surface of it.
bool depends_on_form(const Reader& reader, std::uint32_t instance) {
  constexpr std::array<std::string_view, 5> dependent = {"PCURVE", "RECTANGULAR_TRIMMED_SURFACE",
                                                         "CURVE_BOUNDED_SURFACE", "OFFSET_SURFACE",
                                                         "SURFACE_REPLICA"};
  return std::ranges::any_of(dependent,
                             [&](std::string_view form) { return reader.is(instance, form); });
}

/// The surface in whose parameters a PCURVE is; none: it is another entity.
std::optional<std::uint32_t> surface_under(const Reader& reader, std::uint32_t pcurve) {
  if (!is_parameter_curve(reader, pcurve)) return std::nullopt;
  const auto basis = reader.attributes(pcurve, "PCURVE", 1, 1);
  return basis.empty() ? std::nullopt : untrimmed(reader, reader.reference(basis[0]));
}

}  // namespace

// The record keeps its name, so that faces find the new surface; whatever speaks of the parameters
// of the old one (curves in them, limits, offsets) is led to a copy of the old record, as its
// numbers mean something else on the new one.
void Surgeon::become_spline(std::uint32_t instance, const Surface& surface,
                            const std::set<std::uint32_t>& bounded) {
  const Part21Instance& record = file_.instance(instance);
  std::string copy, inserted;
  for (std::uint32_t k = 0; k < file_.instances().size(); ++k) {
    if (k == instance || bounded.contains(k) || !depends_on_form(reader_, k)) continue;
    const Part21Instance& user = file_.instance(k);
    for (std::uint32_t value = user.first; value < user.last; ++value) {
      if (file_.value(value).kind != Part21Kind::reference || file_.value(value).target != instance)
        continue;
      if (copy.empty()) {
        copy = "#" + std::to_string(names_.next());
        inserted += line_break() + copy_of(instance, copy, {});
      }
      change(value, copy);
    }
  }
  std::unordered_map<std::string, std::string>
      names;  // of control points by their text: equal ones share a record
  std::vector<std::string> points;
  for (Eigen::Index k = 0; k < surface.size(); ++k) {
    const std::array<double, 3> place = {surface.control_points()(k, 0),
                                         surface.control_points()(k, 1),
                                         surface.control_points()(k, 2)};
    std::string& name = names[print_point("", place.data())];
    if (name.empty()) {
      name = "#" + std::to_string(names_.next());
      inserted += line_break() + print_point(name, place.data());
    }
    points.push_back(name);
  }
  changes_.push_back({record.record, print_surface(
                                         surface, encode_string(reader_.item_name(instance)),
                                         [&](int k) { return points[static_cast<std::size_t>(k)]; },
                                         line_break())});
  insert(record.bytes.end, std::move(inserted));
}

void Surgeon::lie_on(std::uint32_t face, std::uint32_t surface) {
  const auto attributes = reader_.attributes(face, "FACE_SURFACE", 2, 1);
  const auto value = is_bounded_surface(reader_, face) ? basis_value(reader_, face)
                     : attributes.empty()              ? std::nullopt
                                                       : std::optional(attributes[0]);
  if (value && reader_.reference(*value) != surface) change(*value, name_of(reader_, surface));
}

void Surgeon::limit(std::uint32_t bounded, const std::array<Interval, 2>& limits) {
  const auto attributes = reader_.attributes(bounded, "RECTANGULAR_TRIMMED_SURFACE", 1, 7);
  for (std::size_t d = 0; d < 2 && !attributes.empty(); ++d) {
    // Down only where the parameters run so: over the end of a closed direction they went up from
    // the larger one.
    const bool ascending = reader_.enumeration(attributes[5 + d]) != "F" ||
                           reader_.real(attributes[1 + 2 * d]).value_or(0) <
                               reader_.real(attributes[2 + 2 * d]).value_or(0);
    change(attributes[1 + 2 * d], format_real(ascending ? limits[d].lower : limits[d].upper));
    change(attributes[2 + 2 * d], format_real(ascending ? limits[d].upper : limits[d].lower));
  }
}

// SEAM_CURVE and INTERSECTION_CURVE demand two PCURVEs (ISO 10303-42, clause 4.5); without them
// only the supertype is valid, and its master is the curve in space.
void Surgeon::lie_on_these(std::uint32_t curve, const std::vector<std::uint32_t>& parts,
                           const std::string& list) {
  change(parts[1], "(" + list + ")");
  if (reader_.enumeration(parts[2]) != "CURVE_3D") change(parts[2], ".CURVE_3D.");
  const Part21Instance& record = file_.instance(curve);
  if (reader_.is(curve, "SURFACE_CURVE") || record.complex) return;
  const auto begin = file_.range(record.first).begin;
  changes_.push_back(
      {{begin, begin + static_cast<std::uint32_t>(file_.keyword(record.first).size())},
       "SURFACE_CURVE"});
}

void Surgeon::lie_along(const BoundaryEdge& edge, std::uint32_t surface, const Curve* curve) {
  const std::string on = name_of(reader_, surface);
  for (const BoundarySource& source : edge.sources) {
    if (source.carrier == no_instance) continue;
    const auto parts = reader_.attributes(source.carrier, "SURFACE_CURVE", 1, 3);
    std::string kept;
    bool left = false;
    for (const std::uint32_t value :
         parts.empty() ? std::vector<std::uint32_t>() : file_.children(parts[1])) {
      const auto target = reader_.reference(value);
      const bool leaves = target && surface_under(reader_, *target) == surface;
      const std::string text = leaves ? on : std::string(file_.text(value));
      if (!(leaves && left)) kept += (kept.empty() ? "" : ",") + text;
      left = left || leaves;
    }
    if (!left || !laid_.insert(source.carrier).second) continue;
    lie_on_these(source.carrier, parts, kept);
  }
  for (const BoundarySource& source : edge.in_parameters) {
    const auto target = reader_.reference(source.parent);
    if (curve == nullptr || !target || surface_under(reader_, *target) != surface) continue;
    const std::string name = "#" + std::to_string(names_.next()),
                      carrier = "#" + std::to_string(names_.next());
    insert(file_.instance(source.segment).bytes.end,
           curve_records(source.turned ? brep::turned(*curve) : *curve, name) + line_break() +
               carrier + "=SURFACE_CURVE(''," + name + ",(" + on + "),.CURVE_3D.);");
    change(source.parent, carrier);
  }
}

void Surgeon::drop_parameter_curves(std::uint32_t edge, const std::set<std::uint32_t>& surfaces) {
  const auto attributes = reader_.attributes(edge, "EDGE_CURVE", 3, 1);
  const auto curve = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
  // SURFACE_CURVE(curve in space, what it lies on, which of them is the master)
  const auto parts =
      curve ? reader_.attributes(*curve, "SURFACE_CURVE", 1, 3) : std::vector<std::uint32_t>();
  const bool seam = curve && reader_.is(*curve, "SEAM_CURVE"),
             plain = curve && reader_.is(*curve, "SURFACE_CURVE");
  const bool intersection = curve && reader_.is(*curve, "INTERSECTION_CURVE");
  if (parts.empty() || !(seam || plain || intersection)) return;
  std::string kept;
  bool dropped = false;
  for (const std::uint32_t value : file_.children(parts[1])) {
    const auto target = reader_.reference(value);
    const auto on = target ? surface_under(reader_, *target) : std::nullopt;
    if (on && surfaces.contains(*on)) {
      dropped = true;
    } else {
      kept += (kept.empty() ? "" : ",") + std::string(file_.text(value));
    }
  }
  if (!dropped) return;
  const Part21Instance& record = file_.instance(*curve);
  // Another edge on the same curve would change it twice.
  if (kept.empty() || seam || record.complex || record.uses > 1) {
    change(attributes[0], std::string(file_.text(parts[0])));
    return;
  }
  lie_on_these(*curve, parts, kept);
}

}  // namespace knead::step
