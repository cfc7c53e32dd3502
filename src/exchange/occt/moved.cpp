#include "moved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "gaps.hpp"

namespace knead::occt {
namespace {

using detail::digits_17;
using detail::shortest;
using detail::TextChanges;

const ReadModel::Source* find(const std::map<std::string, ReadModel::Source>& sources,
                              const std::string& id) {
  const auto found = sources.find(id);
  return found == sources.end() ? nullptr : &found->second;
}

/// Type 7, over these parameters: rational, periodic, degree, numbers of poles and knots, poles,
/// knots.
std::string print(const Curve& curve, const std::array<double, 2>& range,
                  const Eigen::Affine3d& back) {
  const auto knot_values = curve.knots(0).knots();
  std::string knots;
  int distinct = 0;
  for (std::size_t k = 0, next = 0; k < knot_values.size(); k = next) {
    while (next < knot_values.size() && knot_values[next] == knot_values[k]) ++next;
    const double share =
        (knot_values[k] - knot_values.front()) / (knot_values.back() - knot_values.front());
    const double t =
        next == knot_values.size() ? range[1] : range[0] + share * (range[1] - range[0]);
    knots += fmt::format(" {} {}", digits_17(t), next - k);
    ++distinct;
  }
  std::string text =
      fmt::format("7 0 0  {} {} {} ", curve.knots(0).degree(), curve.size(), distinct);
  for (Eigen::Index k = 0; k < curve.size(); ++k) {
    const Point p = back * Point(curve.control_points().row(k).transpose());
    text += fmt::format(" {} {} {} ", digits_17(p.x()), digits_17(p.y()), digits_17(p.z()));
  }
  return text + "\n" + knots;
}

}  // namespace

Expected<void> can_move(const BrepFile& file, const ReadModel::Sources& sources,
                        const std::string& edge) {
  const ReadModel::Source* edge_source = find(sources.edges, edge);
  if (edge_source == nullptr) return input_error("only edges of faces can follow", edge);
  const BrepShape& shape = file.shapes[edge_source->shape];
  if (!shape.same_parameter) {
    return input_error(
        "its curves are at the same points at different parameters, which Open CASCADE would find "
        "open",
        edge, "hold it, or write the file after BRepLib::SameParameter");
  }
  const auto unknown = [&](const BrepFlatCurve& flat) {
    const auto read = [&](int k) {
      return k == 0 || point_of(file.flat_curves[static_cast<std::size_t>(k) - 1], 2, flat.range[0])
                           .has_value();
    };
    return !read(flat.curve) || !read(flat.other);
  };
  if (std::ranges::any_of(shape.flat, unknown)) {
    return input_error("a curve in the parameters of a surface is periodic or an offset", edge,
                       "hold it");
  }
  const auto uses = std::ranges::count_if(
      sources.edges, [&](const auto& e) { return e.second.shape == edge_source->shape; });
  if (uses == 1) return {};
  return input_error("the edge stands in several places, and would move in all of them", edge,
                     "hold it");
}

// The curve of an edge that moved is put where the old one stands, over the same range, so that the
// edge's parameters still hold. A curve that several edges share is kept for the others: the new
// one goes to the end of the table, and the edge and the table's count are changed. The edge's
// polygons belong to the old course and are left out. What moved lies at the place of the model;
// the file has it before its location, hence the inverse.
Expected<TextChanges> edge_changes(const BrepFile& file, const ReadModel::Sources& sources,
                                   const brep::MovedEdges& moved) {
  TextChanges changes;
  std::size_t added = 0;
  std::string behind;
  for (const brep::MovedEdge& edge : moved.edges) {
    if (auto can = can_move(file, sources, edge.id); !can) return std::unexpected(can.error());
    const ReadModel::Source& source = *find(sources.edges, edge.id);
    const BrepShape& shape = file.shapes[source.shape];
    for (const TextRange& polygon : shape.polygons) changes.emplace_back(polygon, std::string());
    const std::string text = print(edge.curve, shape.range, source.move.inverse());
    const auto uses = std::ranges::count_if(file.shapes, [&](const BrepShape& other) {
      return other.kind == Shape::edge && other.geometry == shape.geometry;
    });
    if (uses == 1) {
      changes.emplace_back(file.curve_blocks[static_cast<std::size_t>(shape.geometry) - 1], text);
      continue;
    }
    behind += "\n" + text;
    changes.emplace_back(shape.curve_word, fmt::format("{}", file.curves.size() + ++added));
  }
  if (added > 0) {
    const std::size_t end = file.curve_blocks.back().end;
    changes.emplace_back(TextRange{end, end}, behind);
    changes.emplace_back(file.curve_count, fmt::format("{}", file.curves.size() + added));
  }
  for (const brep::MovedVertex& vertex : moved.vertices) {
    const ReadModel::Source* source = find(sources.vertices, vertex.id);
    if (source == nullptr) continue;
    const BrepShape& shape = file.shapes[source->shape];
    const Point p = source->move.inverse() * vertex.place;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto k = static_cast<Eigen::Index>(c);
      if (p[k] != shape.point[k]) changes.emplace_back(shape.coordinates[c], digits_17(p[k]));
    }
  }
  return changes;
}

// Open CASCADE finds a shape valid if the gaps at an edge and vertex are within their tolerances. A
// tolerance is raised only where the gap grew beyond both the tolerance and the gap before; then by
// the gap, as what used the tolerance up before may still be there.
TextChanges tolerance_changes(const BrepFile& file, const BrepFile& after,
                              const std::set<int>& changed, const brep::MovedEdges& moved,
                              const ReadModel::Sources& sources) {
  std::set<std::size_t> edges, vertices;
  for (const auto& edge : moved.edges) edges.insert(find(sources.edges, edge.id)->shape);
  for (const auto& vertex : moved.vertices) {
    if (const auto* source = find(sources.vertices, vertex.id)) vertices.insert(source->shape);
  }
  GapMeter was(file), is(after);
  std::map<std::size_t, double> wanted;  // by shape
  const auto want = [&](std::size_t shape, double before, double now, double rounding) {
    const double tolerance = file.shapes[shape].tolerance;
    // A held edge is measured beside a surface whose points differ by roundings: that is no reason
    // for the sum.
    if (now > std::max(tolerance, before) + rounding)
      wanted[shape] = std::max(wanted[shape], tolerance + now);
  };
  for (std::size_t k = 0; k < file.shapes.size(); ++k) {
    const BrepShape& edge = file.shapes[k];
    if (edge.kind != Shape::edge || edge.degenerated) continue;
    const bool moves =
        edges.contains(k) ||
        std::ranges::any_of(
            edge.flat, [&](const BrepFlatCurve& flat) { return changed.contains(flat.surface); }) ||
        std::ranges::any_of(edge.uses,
                            [&](const Use& use) { return vertices.contains(use.shape); });
    if (!moves) continue;
    const auto now = is.gap(after.shapes[k]), before = was.gap(edge);
    if (!now || !before) continue;
    want(k, before->along, now->along, now->rounding);
    for (std::size_t v = 0; v < edge.uses.size(); ++v) {
      want(edge.uses[v].shape, before->at_vertex[v], now->at_vertex[v], now->rounding);
      // A vertex is not known better than its edges.
      if (const auto found = wanted.find(k); found != wanted.end())
        want(edge.uses[v].shape, 0, found->second, 0);
    }
  }
  TextChanges changes;
  for (const auto& [index, tolerance] : wanted)
    changes.emplace_back(file.shapes[index].tolerance_word, shortest(tolerance));
  return changes;
}

}  // namespace knead::occt
