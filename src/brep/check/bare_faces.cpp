#include "bare_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <tuple>

#include "brep/boundary_curve.hpp"

namespace knead::brep {
namespace {

constexpr double point_like = 1e-9;  // of the net's size: a side so small is a point
constexpr double rounding = 1e-13;   // of the coordinates

/// What is so near is at the same place.
double same_place(const Points& net) {
  return std::max(point_like * net_diagonal(net), rounding * net.cwiseAbs().maxCoeff());
}

/// Whether all control points are on a line: the surface has no area.
bool is_line(const Points& points) {
  Eigen::Index far = 0;
  (points.rowwise() - points.row(0)).rowwise().squaredNorm().maxCoeff(&far);
  const Point along = (points.row(far) - points.row(0)).transpose().normalized();
  double off = 0;
  for (const auto& row : points.rowwise())
    off = std::max(off, along.cross(Point((row - points.row(0)).transpose())).norm());
  return off <= same_place(points);
}

/// Whether all rows across a direction are the same: the surface is a curve.
bool is_collapsed(const Surface& surface, int direction) {
  const auto [m, n] = surface.net();
  const Points& p = surface.control_points();
  const double near = same_place(p);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const int first = direction == 0 ? j : i * n;
      if (!((p.row(i * n + j) - p.row(first)).norm() <= near)) return false;
    }
  }
  return true;
}

void add_face(FacedModel& faced, Index s) {
  Model& model = faced.model;
  const SplineSurface& surface = model.surfaces[s];
  const double near = same_place(surface.surface.control_points());
  if (!has_area(surface.surface)) return;
  Bound bound{.kind = Bound::Kind::edges};
  // Counterclockwise: v at its start along u, u at its end along v, and back.
  for (const auto& [direction, end, forward] :
       {std::tuple(1, 0, true), {0, 1, true}, {1, 1, false}, {0, 0, false}}) {
    auto curve = boundary_curve(surface.surface, direction, end);
    if (!curve || !(net_diagonal(curve->control_points()) > near)) continue;
    auto geometry = std::make_shared<CurveGeometry>();
    geometry->form = std::make_shared<const Curve>(*std::move(curve));
    bound.edges.push_back({static_cast<Index>(model.edges.size()), forward});
    model.edges.push_back(
        {.id = surface.id + (direction == 0 ? ".u" : ".v") + (end == 0 ? "0" : "1"),
         .curve = std::move(geometry)});
    faced.sides.push_back(CheckedFace::Side{direction, end});
  }
  if (bound.edges.empty()) return;
  Support support;
  support.id = surface.id;
  support.spline = s;
  support.uncertainty = surface.uncertainty;
  Face face;
  face.id = surface.id;
  face.support = static_cast<Index>(model.supports.size());
  face.bounds = {std::move(bound)};
  model.supports.push_back(std::move(support));
  model.faces.push_back(std::move(face));
}

}  // namespace

std::array<bool, 2> collapsed_directions(const Surface& surface) {
  return {is_collapsed(surface, 0), is_collapsed(surface, 1)};
}

bool has_area(const Surface& surface) {
  const auto collapsed = collapsed_directions(surface);
  return !collapsed[0] && !collapsed[1] && !is_line(surface.control_points());
}

std::optional<FacedModel> with_bare_faces(const Model& model) {
  std::vector<bool> faced(model.surfaces.size(), false);
  for (const Face& face : model.faces) {
    if (face.support == none || model.supports[face.support].spline == none) continue;
    faced[model.supports[face.support].spline] = true;
  }
  if (std::ranges::find(faced, false) == faced.end()) return std::nullopt;
  FacedModel result{model, std::vector<std::optional<CheckedFace::Side>>(model.edges.size())};
  for (Index s = 0; s < faced.size(); ++s) {
    if (!faced[s]) add_face(result, s);
  }
  return result;
}

}  // namespace knead::brep
