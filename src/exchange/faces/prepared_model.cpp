#include "prepared_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "brep/geometry_forms.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::detail {
namespace {

using brep::Index;
using Kind = brep::ElementarySurface::Kind;

brep::ElementarySurface* cone_of(brep::Support& support) {
  auto* form = std::get_if<brep::ElementarySurface>(&support.form);
  return form != nullptr && form->kind == Kind::cone ? form : nullptr;
}

std::vector<Point> corners_on(const brep::Model& model, Index support) {
  std::vector<Point> result;
  for (const brep::Face& face : model.faces) {
    if (face.support != support) continue;
    for (const Index k : brep::edges_around(face)) {
      const brep::Edge& edge = model.edges[k];
      for (const Index end : {edge.start, edge.end}) {
        if (end != brep::none && !model.vertices[end].wrong)
          result.push_back(model.vertices[end].place);
      }
    }
  }
  return result;
}

/// The unit in which the half angle of a cone brings it to the corners of its faces.
/// A STEP file may name several units of plane angle, and cones rarely tell theirs. The corners of
/// the faces on a cone lie on it only if its angle has the right unit: the one whose tangent comes
/// nearest to the slope that FaceSurface found.
double angle_unit(const brep::Model& model, Index support) {
  const brep::Support& stored = model.supports[support];
  if (model.angle_units.size() < 2) return model.angle_units.front();
  const auto surface = brep::FaceSurface::create(model, stored, corners_on(model, support));
  if (!surface) return model.angle_units.front();
  const auto& cone = std::get<brep::ElementarySurface>(stored.form);
  const auto radius = [&](double v) {
    return (surface->at({0, v}) - cone.frame.origin).dot(cone.frame.x);
  };
  const double slope = radius(1) - radius(0);
  return *std::ranges::min_element(model.angle_units, {}, [&](double unit) {
    return std::abs(std::tan(unit * cone.second) - slope);
  });
}

void use_radians(brep::Model& model, const brep::Model& from) {
  for (std::size_t k = 0; k < model.supports.size(); ++k) {
    if (auto* cone = cone_of(model.supports[k]))
      cone->second *= angle_unit(from, static_cast<Index>(k));
  }
  model.angle_units = {1};
}

/// Makes edges of polygons.
/// Corners are the same if their coordinates are equal exactly, as a file with poly loops
/// repeats them; edges are the same between the same two corners, and run from the lower to the
/// higher index, so that neighbours share them.
class PolygonEdges {
 public:
  explicit PolygonEdges(brep::Model& model) : model_(model) {}

  void replace(brep::Face& face) {
    if (face.support == brep::none) lie_on_plane(face);
    for (brep::Bound& bound : face.bounds) {
      if (bound.kind != brep::Bound::Kind::polygon || bound.wrong) continue;
      bound.kind = brep::Bound::Kind::edges;
      const std::vector<Point> polygon = std::move(bound.polygon);
      bound.polygon.clear();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Index from = vertex(polygon[k]), to = vertex(polygon[(k + 1) % polygon.size()]);
        if (from != to) bound.edges.push_back(use(from, to));
      }
    }
  }

 private:
  void lie_on_plane(brep::Face& face) {
    if (face.bounds.empty() || face.bounds.front().polygon.empty()) return;
    const std::vector<Point>& polygon = face.bounds.front().polygon;
    const Point normal = brep::newell_normal(polygon);
    if (!(normal.norm() > 0)) return;
    brep::Support& support = model_.supports.emplace_back();
    support.id = face.id;
    support.kind = "PLANE";
    // Newell's normal follows the polygon; the outer bound runs counter-clockwise about the face's
    // normal.
    const bool counterclockwise = face.bounds.front().forward == face.same_sense;
    support.form = brep::ElementarySurface{
        Kind::plane, brep::frame_about(polygon[0], counterclockwise ? normal : Point(-normal))};
    face.support = static_cast<Index>(model_.supports.size() - 1);
  }

  Index vertex(const Point& p) {
    const auto [at, fresh] =
        vertices_.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(model_.vertices.size()));
    if (fresh) model_.vertices.push_back({.id = {}, .place = p});
    return at->second;
  }

  brep::EdgeUse use(Index from, Index to) {
    const bool forward = from < to;
    const auto [at, fresh] =
        edges_.try_emplace(std::minmax({from, to}), static_cast<Index>(model_.edges.size()));
    if (fresh) {
      const Point a = model_.vertices[std::min(from, to)].place,
                  b = model_.vertices[std::max(from, to)].place;
      brep::Edge& edge = model_.edges.emplace_back();
      edge.start = std::min(from, to);
      edge.end = std::max(from, to);
      auto line = brep::line_of(a, b - a);
      if (line)
        edge.curve = std::make_shared<const brep::CurveGeometry>(*std::move(line));
      else
        edge.wrong = brep::fault(std::move(line.error()));
    }
    return {at->second, forward};
  }

  brep::Model& model_;
  std::map<std::array<double, 3>, Index> vertices_;
  std::map<std::pair<Index, Index>, Index> edges_;
};

bool has_polygon(const brep::Face& face) {
  return std::ranges::any_of(face.bounds, [](const brep::Bound& b) {
    return b.kind == brep::Bound::Kind::polygon && !b.wrong;
  });
}

std::vector<SkippedFace> use_splines(brep::Model& model, const brep::Model& from,
                                     Conversion conversion) {
  std::vector<SkippedFace> left;
  const auto others = brep::other_surfaces(from);
  auto made = brep::exact_splines(from);
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (conversion == Conversion::all_but_whole_spheres && is_whole_sphere(from, others[k].id)) {
      left.push_back(
          {others[k].id,
           input_error("readers of the format know whole spheres as such alone", {}, "write STEP")
               .error()});
      continue;
    }
    if (!made[k]) {
      left.push_back({others[k].id, std::move(made[k].error())});
      continue;
    }
    const auto support = std::ranges::find_if(model.supports, [&](const brep::Support& s) {
      return s.id == others[k].id && s.spline == brep::none;
    });
    support->spline = static_cast<Index>(model.surfaces.size());
    support->form = std::monostate();
    const auto closed = brep::closed_directions(*made[k]);
    model.surfaces.push_back({.id = support->id,
                              .name = {},
                              .unit = {},
                              .surface = *std::move(made[k]),
                              .closed = closed,
                              .trimmed = true,
                              .faces = static_cast<int>(others[k].faces.size()),
                              .uncertainty = support->uncertainty});
  }
  model.index_surfaces();
  return left;
}

}  // namespace

bool is_whole_sphere(const brep::Model& model, const std::string& id) {
  return std::ranges::any_of(model.faces, [&](const brep::Face& face) {
    if (face.support == brep::none || model.supports[face.support].id != id) return false;
    const auto* form = std::get_if<brep::ElementarySurface>(&model.supports[face.support].form);
    if (form == nullptr || form->kind != Kind::sphere) return false;
    return std::ranges::all_of(face.bounds, [](const brep::Bound& bound) {
      const auto& uses = bound.edges;
      return uses.empty() || (uses.size() == 2 && uses[0].edge == uses[1].edge);
    });
  });
}

PreparedModel prepared(std::shared_ptr<const brep::Model> model, Conversion conversion) {
  const bool convert = conversion != Conversion::none;
  PreparedModel result{std::move(model), {}};
  const brep::Model& read = *result.model;
  const bool angles = read.angle_units != std::vector<double>{1};
  const bool polygons = std::ranges::any_of(read.faces, has_polygon);
  if (!angles && !polygons && !(convert && !brep::other_surfaces(read).empty())) return result;
  auto made = std::make_shared<brep::Model>(read);
  if (angles) use_radians(*made, read);
  if (polygons) {
    PolygonEdges edges(*made);
    for (brep::Face& face : made->faces) {
      if (has_polygon(face)) edges.replace(face);
    }
  }
  if (convert) {
    const brep::Model before = *made;
    result.analytic = use_splines(*made, before, conversion);
  }
  result.model = std::move(made);
  return result;
}

}  // namespace knead::detail
