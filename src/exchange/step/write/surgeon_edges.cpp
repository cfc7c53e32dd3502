#include <algorithm>
#include <map>

#include "brep/boundary_curve.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/geometry.hpp"
#include "print.hpp"
#include "surgeon.hpp"

namespace knead::step {

namespace {

/// The value of a SURFACE_CURVE that refers to its curve in space; none for other curves.
std::optional<std::uint32_t> curve_3d_of(const Reader& reader, std::uint32_t curve) {
  if (!is_surface_curve(reader, curve)) return std::nullopt;
  const auto attributes = reader.attributes(curve, "SURFACE_CURVE", 1, 1);
  return attributes.empty() ? std::nullopt : std::optional(attributes[0]);
}

}  // namespace

std::string Surgeon::curve_records(const Curve& curve, const std::string& name) {
  std::string points;
  std::vector<std::string> names;
  const Points& net = curve.control_points();
  for (Eigen::Index k = 0; k < net.rows(); ++k) {
    const std::string point = "#" + std::to_string(names_.next());
    const std::array<double, 3> place = {net(k, 0), net(k, 1), net(k, 2)};
    points += line_break() + print_point(point, place.data());
    names.push_back(point);
  }
  return points + line_break() + name + "=" +
         print_curve(curve, "''", [&](int k) { return names[static_cast<std::size_t>(k)]; }) + ";";
}

// The old curve stays in the file, since others may refer to it; the edge, or its SURFACE_CURVE if
// no other edge has that, refers to the new one.
Expected<void> Surgeon::replace_curve(std::uint32_t edge, const Curve& curve) {
  const auto attributes = reader_.attributes(edge, "EDGE_CURVE", 3, 2);
  const std::uint32_t geometry =
      attributes.empty() ? no_instance : reader_.reference(attributes[0]).value_or(no_instance);
  if (!reader_.is(edge, "EDGE_CURVE") || geometry == no_instance)
    return reader_.error(edge, "an EDGE_CURVE is needed here");
  const std::string name = "#" + std::to_string(names_.next());
  std::string records = curve_records(curve, name);
  const auto inner = curve_3d_of(reader_, geometry);
  if (!inner) {
    change(attributes[0], name);
  } else if (file_.instance(geometry).uses == 1) {
    change(*inner, name);
  } else {
    const std::string copy = "#" + std::to_string(names_.next());
    records += line_break() + copy_of(geometry, copy, {{file_.range(*inner), name}});
    change(attributes[0], copy);
  }
  insert(file_.instance(edge).bytes.end, std::move(records));
  return {};
}

void Surgeon::replace_boundary(const std::vector<BoundarySource>& sources, const Curve& curve) {
  std::array<std::string, 2> names;             // of the curve, and of the same turned
  std::map<std::uint32_t, std::string> copies;  // of the SURFACE_CURVEs that have one of these
  for (const BoundarySource& source : sources) {
    std::string& name = names[source.turned ? 1 : 0];
    std::string records;
    if (name.empty()) {
      name = "#" + std::to_string(names_.next());
      records = curve_records(source.turned ? brep::turned(curve) : curve, name);
    }
    const bool shared = source.carrier != no_instance && copies.contains(source.carrier);
    if (source.carrier == no_instance) {
      change(source.value, name);
    } else if (shared) {
      if (!copies.at(source.carrier).empty()) change(source.parent, copies.at(source.carrier));
    } else {
      const auto same = [&](const BoundarySource& other) {
        return other.carrier == source.carrier;
      };
      std::string& copy = copies[source.carrier];
      if (file_.instance(source.carrier).uses ==
          static_cast<std::uint32_t>(std::ranges::count_if(sources, same))) {
        change(source.value, name);
      } else {
        copy = "#" + std::to_string(names_.next());
        records +=
            line_break() + copy_of(source.carrier, copy, {{file_.range(source.value), name}});
        change(source.parent, copy);
      }
    }
    if (!records.empty()) insert(file_.instance(source.segment).bytes.end, std::move(records));
  }
}

Expected<void> Surgeon::replace_net(std::uint32_t instance, const std::vector<std::uint32_t>& refs,
                                    const Curve& before, const Curve& after) {
  const auto label = reader_.attributes(instance, "REPRESENTATION_ITEM", 0, 1);
  const auto values =
      file_.instance(instance).complex ? label : file_.children(file_.instance(instance).first);
  if (values.empty()) return reader_.error(instance, "it has no label");
  std::string inserted;
  const auto names = point_names(refs, before.control_points(), after.control_points(), inserted);
  if (!names) return std::unexpected(names.error());
  changes_.push_back({file_.instance(instance).record,
                      print_curve(after, file_.text(values[0]),
                                  [&](int k) { return (*names)[static_cast<std::size_t>(k)]; })});
  if (!inserted.empty()) insert(file_.instance(instance).bytes.end, std::move(inserted));
  return {};
}

Expected<void> Surgeon::move_vertex(std::uint32_t vertex, const Point& place) {
  const auto attributes = reader_.attributes(vertex, "VERTEX_POINT", 1, 1);
  const std::uint32_t geometry =
      attributes.empty() ? no_instance : reader_.reference(attributes[0]).value_or(no_instance);
  if (!reader_.is(vertex, "VERTEX_POINT") || geometry == no_instance)
    return reader_.error(vertex, "a VERTEX_POINT is needed here");
  const auto point = reader_.point(geometry);
  if (!point) return std::unexpected(point.error());
  Points before(1, 3), after(1, 3);
  before.row(0) = point->transpose();
  after.row(0) = place.transpose();
  return move_points(vertex, {attributes[0]}, before, after);
}

}  // namespace knead::step
