#include "moved.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "brep/boundary_curve.hpp"
#include "exchange/part21/part21_text.hpp"
#include "geometry.hpp"
#include "text.hpp"

namespace knead::iges {
namespace {

/// The surfaces of revolution, ruled and tabulated surfaces that this curve makes.
int surface_made_of(const File& file, int curve) {
  for (std::size_t k = 0; k < file.entities().size(); ++k) {
    const int type = file.entities()[k].type;
    if (type != 118 && type != 120 && type != 122) continue;
    const auto parameters = file.parameters(File::number(k));
    for (std::size_t at = 1; parameters && at < std::min<std::size_t>(3, parameters->values.size());
         ++at) {
      if (integer(parameters->values[at]) == curve) return File::number(k);
    }
  }
  return 0;
}

/// One after the last parameter that describes a curve.
Expected<std::size_t> end_of(const File& file, int number, const Parameters& parameters) {
  constexpr std::size_t normal = 3;  // of the plane of a B-spline curve
  switch (file.find(number)->type) {
    case 100:
      return std::size_t{8};
    case 110:
      return std::size_t{7};
    case 126: {
      const auto at = curve_layout(file, number, parameters);
      if (!at) return std::unexpected(at.error());
      return at->end + normal;
    }
    default: {  // 106: kind of tuples, their number, and of pairs their common z
      const auto head = numbers(file, number, parameters, 1, 2);
      if (!head) return std::unexpected(head.error());
      const auto count = static_cast<std::size_t>((*head)[1]);
      return (*head)[0] == 1 ? 4 + 2 * count : 3 + ((*head)[0] == 2 ? 3 : 6) * count;
    }
  }
}

}  // namespace

Expected<void> can_move(const File& file, const EdgeSources& sources, const std::string& edge) {
  const auto found = sources.edges.find(edge);
  if (found == sources.edges.end()) return input_error("only edges of faces can follow", edge);
  for (const EdgeCurve& curve : found->second) {
    if (const int surface = surface_made_of(file, curve.number); surface != 0) {
      return input_error(fmt::format("its curve D{} makes the surface {} too, which would move",
                                     curve.number, file.label(surface)),
                         edge, "hold the edge");
    }
    for (const auto& [other, curves] : sources.edges) {
      if (other == found->first || !std::ranges::any_of(curves, [&](const EdgeCurve& c) {
            return c.number == curve.number;
          }))
        continue;
      return input_error(fmt::format("its curve D{} is that of the edge {} too, which would move",
                                     curve.number, other),
                         edge, "hold the edge");
    }
  }
  return {};
}

Expected<MovedEntities> moved_entities(const EdgeSources& sources, const brep::MovedEdges& moved) {
  MovedEntities result;
  for (const brep::MovedEdge& edge : moved.edges) {
    const auto found = sources.edges.find(edge.id);
    if (found == sources.edges.end())
      return input_error("no curve of the file is this edge", edge.id);
    for (const EdgeCurve& curve : found->second) {
      result.curves.push_back(
          {curve.number, curve.turned ? brep::turned(edge.curve) : edge.curve, curve.move});
    }
  }
  for (const brep::MovedVertex& vertex : moved.vertices) {
    const auto found = sources.vertices.find(vertex.id);
    if (found != sources.vertices.end()) result.vertices.push_back({found->second, vertex.place});
  }
  return result;
}

Expected<std::vector<std::string>> curve_values(const File& file,
                                                const CurveReplacement& replacement,
                                                const Parameters& parameters) {
  const auto end = end_of(file, replacement.number, parameters);
  if (!end) return std::unexpected(end.error());
  Points points = replacement.curve.control_points();
  if (!replacement.move.matrix().isIdentity(0)) {
    const Eigen::Affine3d back = replacement.move.inverse();
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      points.row(k) = (back * Point(points.row(k).transpose())).transpose();
  }
  const auto curve = replacement.curve.with_control_points(std::move(points));
  if (!curve) return std::unexpected(curve.error());
  std::vector<std::string> values = curve_values(*curve);
  values.insert(values.begin(), "126");
  for (std::size_t k = *end; k < parameters.values.size(); ++k)
    values.push_back(parameters.values[k]);
  return values;
}

Expected<std::map<int, std::vector<std::string>>> vertex_values(
    const File& file, std::span<const VertexReplacement> vertices) {
  std::map<int, std::vector<std::string>> result;
  for (const auto& [vertex, place] : vertices) {
    const auto [list, fresh] = result.try_emplace(vertex.list);
    if (fresh) {
      auto parameters = file.parameters(vertex.list);
      if (!parameters) return std::unexpected(parameters.error());
      list->second = std::move(parameters->values);
    }
    const std::size_t at = 2 + 3 * static_cast<std::size_t>(vertex.index - 1);
    if (at + 3 > list->second.size())
      return file.error(vertex.list, fmt::format("it has no vertex {}", vertex.index));
    const bool still = vertex.move.matrix().isIdentity(0);
    const Point p = still ? place : Point(vertex.move.inverse() * place);
    for (std::size_t c = 0; c < 3; ++c) {
      std::string& text = list->second[at + c];
      if (real(text) != p[static_cast<Eigen::Index>(c)])
        text = format_real(p[static_cast<Eigen::Index>(c)]);
    }
  }
  return result;
}

bool reads_back(const File& after, const CurveReplacement& replacement) {
  const auto transform = transform_of(after, replacement.number);
  if (!transform) return false;
  const auto curve = read_curve(after, replacement.number, replacement.move * transform->inverse());
  if (!curve || curve->knots() != replacement.curve.knots()) return false;
  const Points &p = curve->control_points(), &q = replacement.curve.control_points();
  return p.rows() == q.rows() &&
         (p - q).cwiseAbs().maxCoeff() <= 1e-13 * (1 + q.cwiseAbs().maxCoeff());
}

}  // namespace knead::iges
