#include "conversion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "brep/face_loops.hpp"
#include "brep/surfaces/surface_foot.hpp"
#include "data.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/write/surgeon.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::step {
namespace {

/// Of a name that the file has.
std::uint32_t instance_of(const Part21File& records, const std::string& id) {
  return records.find(parse_instance_name(id).value_or(0)).value_or(no_instance);
}

/// Reads the result again: the new surfaces bit for bit, and all others as they were.
Expected<File> checked(std::string bytes, const File& before,
                       const std::map<std::string, Surface>& made) {
  auto after = File::parse(std::move(bytes), before.name());
  const auto broken = [&](const std::string& id) {
    return std::unexpected(Error{ErrorKind::numerical,
                                 "internal: the converted file does not read back as it should", id,
                                 "please report this file", before.name(), 0});
  };
  if (!after) return broken(after.error().message());
  const auto same = [&](const std::string& id, const Surface& surface) {
    const brep::SplineSurface* read = after->model().find_surface(id);
    return read != nullptr && read->surface.knots() == surface.knots() &&
           same_bits(read->surface.control_points(), surface.control_points()) &&
           same_bits(read->surface.weights(), surface.weights());
  };
  for (const auto& [id, surface] : made) {
    if (!same(id, surface)) return broken(id);
  }
  for (const brep::SplineSurface& s : before.surfaces()) {
    if (!same(s.id, s.surface)) return broken(s.id);
  }
  return after;
}

/// The rectangle of a surface's parameters whose sides these edges are: along each of them one is
/// constant, and a seam is both ends of a closed one.
Expected<std::array<Interval, 2>> rectangle_of(const brep::Model& model, const brep::Face& face,
                                               const Surface& surface) {
  constexpr double rounding = 1e-9;  // fractions of the domain
  const auto feet = brep::SurfaceFoot::create(surface);
  if (!feet) return std::unexpected(feet.error());
  std::array<Interval, 2> reached = {Interval{1, 0}, Interval{1, 0}};
  const auto edges = brep::edges_around(face);
  for (const brep::Index edge : edges) {
    const auto piece = brep::edge_piece(model, edge);
    if (!piece) return std::unexpected(piece.error());
    Eigen::AlignedBox2d box;
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point p = piece->curve.at(std::lerp(piece->from, piece->to, t));
      box.extend(feet->nearest(p, std::nullopt, 0).foot.parameters);
    }
    const bool seam = std::ranges::count(edges, edge) > 1;
    for (std::size_t d = 0; d < 2; ++d) {
      const auto k = static_cast<Eigen::Index>(d);
      if (box.sizes()[k] > rounding) continue;
      reached[d].lower = seam ? 0 : std::min(reached[d].lower, box.min()[k]);
      reached[d].upper = seam ? 1 : std::max(reached[d].upper, box.max()[k]);
    }
  }
  std::array<Interval, 2> result;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = surface.knots(static_cast<int>(d)).domain();
    const auto at = [&](double f) {
      return f <= rounding       ? domain.lower
             : f >= 1 - rounding ? domain.upper
                                 : domain.lower + f * domain.length();
    };
    // A side that is a point, as at a pole, is no edge: the surface ends there.
    if (reached[d].length() < 0) reached[d] = {0, 1};
    const bool one = !(reached[d].length() > rounding);
    result[d] = {at(one && reached[d].lower > 0.5 ? 0 : std::min(reached[d].lower, 1.0)),
                 at(one && reached[d].lower <= 0.5 ? 1 : std::max(reached[d].upper, 0.0))};
  }
  return result;
}

/// The curve in space of an edge that has none in the file; null if it is not known.
const Curve* spline_along(const brep::Edge& edge) {
  const auto* spline =
      edge.curve ? std::get_if<std::shared_ptr<const Curve>>(&edge.curve->form) : nullptr;
  return spline == nullptr ? nullptr : spline->get();
}

}  // namespace

Expected<File> with_splines(const File& file, std::span<const std::string> surfaces) {
  const Part21File& records = file.data().records;
  const brep::Model& model = file.model();
  const BoundarySources& boundaries = file.data().of.boundaries;
  const Reader reader(records);
  Surgeon surgeon(records);
  std::map<std::string, Surface> made;
  std::set<std::uint32_t> converted, edges;
  std::set<std::pair<brep::Index, std::uint32_t>> along;  // edges of boundaries, and surfaces
  for (const std::string& id : surfaces) {
    const auto faces = brep::faces_on_other(model, id);
    if (!faces) return std::unexpected(faces.error());
    const std::string& name = model.supports[faces->front()->support].id;
    const std::uint32_t instance = instance_of(records, name);
    if (!converted.insert(instance).second) continue;
    auto surface = brep::exact_spline(model, name);
    if (!surface) return std::unexpected(surface.error());
    std::set<std::uint32_t> bounded;
    for (const brep::Face* face : *faces) {
      const std::uint32_t record = instance_of(records, face->id);
      bounded.insert(record);
      surgeon.lie_on(record, instance);
      if (reader.is(record, "RECTANGULAR_TRIMMED_SURFACE")) {
        const auto limits = rectangle_of(model, *face, *surface);
        if (!limits) return std::unexpected(limits.error());
        surgeon.limit(record, *limits);
      }
      for (const brep::Index k : brep::edges_around(*face)) {
        const brep::Edge& edge = model.edges[k];
        const auto boundary = boundaries.find(edge.id);
        if (boundary == boundaries.end())
          edges.insert(instance_of(records, edge.id));
        else if (along.emplace(k, instance).second)
          surgeon.lie_along(boundary->second, instance, spline_along(edge));
      }
    }
    surgeon.become_spline(instance, *surface, bounded);
    made.emplace(name, *std::move(surface));
  }
  if (made.empty()) return file;
  for (const std::uint32_t edge : edges) surgeon.drop_parameter_curves(edge, converted);
  return checked(surgeon.result(), file, made);
}

}  // namespace knead::step
