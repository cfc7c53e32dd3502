#include "model_builder.hpp"

#include <algorithm>

#include "base/parallel_for.hpp"
#include "trimming.hpp"

namespace knead::brep {

Index add_vertex(Model& model, std::string id, const Point& place) {
  model.vertices.push_back({.id = std::move(id), .place = place});
  return static_cast<Index>(model.vertices.size() - 1);
}

Index add_edge(Model& model, std::string id, Index start, Index end,
               Expected<CurveGeometry> curve) {
  Edge& edge = model.edges.emplace_back(std::move(id), start, end);
  if (!curve) {
    edge.wrong = fault(std::move(curve.error()));
  } else {
    edge.curve = std::make_shared<const CurveGeometry>(*std::move(curve));
  }
  return static_cast<Index>(model.edges.size() - 1);
}

Index ModelBuilder::add_support(Support support) {
  model_.supports.push_back(std::move(support));
  return static_cast<Index>(model_.supports.size() - 1);
}

Index ModelBuilder::add_surface(int number, std::string label, Surface surface,
                                const std::string& unit, double uncertainty) {
  Support support;
  support.id = name(number);
  support.kind = surface.rational() ? "BOUNDED_SURFACE" : "B_SPLINE_SURFACE_WITH_KNOTS";
  support.spline = static_cast<Index>(model_.surfaces.size());
  support.uncertainty = uncertainty;
  model_.surfaces.push_back({.id = support.id,
                             .name = std::move(label),
                             .unit = unit,
                             .surface = std::move(surface),
                             .uncertainty = uncertainty});
  return add_support(std::move(support));
}

Model ModelBuilder::complete(const std::string& unit, double metres) && {
  std::vector<int> uses(model_.vertices.size(), 0);
  for (const Edge& edge : model_.edges) {
    for (const Index vertex : {edge.start, edge.end}) ++uses[vertex];
  }
  for (const Face& face : model_.faces) {
    for (const Bound& bound : face.bounds) {
      if (bound.vertex != none) ++uses[bound.vertex];
    }
  }
  for (std::size_t k = 0; k < uses.size(); ++k) model_.vertices[k].of_one_use = uses[k] == 1;
  if (unit != "unknown") model_.units.push_back({.context = {}, .name = unit, .metres = metres});
  brep::complete(model_);
  return std::move(model_);
}

void settle_kind(Bound& bound) {
  if (!bound.edges.empty()) {
    bound.kind = Bound::Kind::edges;
    bound.vertex = none;
  } else if (bound.vertex != none) {
    bound.kind = Bound::Kind::vertex;
  }
}

void complete(Model& model) {
  constexpr double work_per_point = 20;  // multiplications, about
  model.index_surfaces();
  std::size_t points = 0;
  for (const SplineSurface& surface : model.surfaces)
    points += static_cast<std::size_t>(surface.surface.size());
  const auto count = static_cast<std::ptrdiff_t>(model.surfaces.size());
  const double work = work_per_point * static_cast<double>(points) /
                      static_cast<double>(std::max<std::ptrdiff_t>(count, 1));
  detail::parallel_for(
      count, detail::block_size(count, work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          model.surfaces[k].closed = closed_directions(model.surfaces[k].surface);
        }
      });
  find_trimming(model);
  if (model.assembly && model.assembly->parts.empty()) model.assembly = single_part(model);
}

}  // namespace knead::brep
