#include "studio_context.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "buffers.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/left_out.hpp"

namespace knead::studio {

Point middle_of(const brep::Model& model) {
  constexpr double rough = 0.1;
  const double none = std::numeric_limits<double>::infinity();
  Point lower = Point::Constant(none), upper = -lower;
  if (const auto context = context_faces(model, rough)) {
    for (const FaceMesh& mesh : context->faces) {
      for (const Point& p : mesh.points) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
  }
  return lower.x() <= upper.x() ? Point((lower + upper) / 2) : Point::Zero();
}

Point middle_of(const Document& document) {
  Point lower = Point::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const DocumentSurface& s : document.surfaces()) {
    lower = lower.cwiseMin(s.surface->control_points().colwise().minCoeff().transpose());
    upper = upper.cwiseMax(s.surface->control_points().colwise().maxCoeff().transpose());
  }
  if (!document.surfaces().empty()) return (lower + upper) / 2;
  return document.model() != nullptr ? middle_of(*document.model()) : Point::Zero();
}

Point origin_near(const SessionState& now, const Point& otherwise) {
  constexpr double far = 100;
  if (now.surfaces.empty() && now.bodies.empty()) return otherwise;
  const Points& points =
      now.surfaces.empty() ? control_points_of(now.bodies.front()) : now.surfaces.front().current->control_points();
  const Point lower = points.colwise().minCoeff().transpose(), upper = points.colwise().maxCoeff().transpose();
  const Point centre = (lower + upper) / 2;
  return centre.norm() > far * (upper - lower).norm() ? centre : Point(Point::Zero());
}

ContextPicture context_picture(const brep::Model& model, const Point& origin) {
  ContextPicture picture;
  FaceMeshes context;
  if (auto faces = context_faces(model, drawn_chord)) context = *std::move(faces);
  std::map<std::string, const brep::OtherSurface*> below;  // of every face
  const auto others = brep::other_surfaces(model);
  for (const brep::OtherSurface& s : others) {
    for (const std::string& face : s.faces) below[face] = &s;
  }
  for (const FaceMesh& mesh : context.faces) {
    const auto on = below.find(mesh.id);
    const brep::OtherSurface none, &surface = on == below.end() ? none : *on->second;
    picture.faces.push_back(
        {mesh.id, surface.id, mesh.tessellated ? "TRIANGLES" : surface.form, mesh.triangles.size()});
    const auto first = static_cast<std::uint32_t>(picture.positions.size() / 3);
    for (std::size_t k = 0; k < mesh.points.size(); ++k) {
      for (int d = 0; d < 3; ++d) {
        picture.positions.push_back(static_cast<float>(mesh.points[k][d] - origin[d]));
        picture.normals.push_back(static_cast<float>(mesh.normals[k][d]));
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const auto k : triangle) picture.indices.push_back(first + k);
    }
  }
  picture.skipped = std::move(context.skipped);
  return picture;
}

std::string context_json(const ContextPicture& context, const Source& source) {
  auto faces = nlohmann::json::array(), skipped = nlohmann::json::array(), left_out = nlohmann::json::array();
  for (const auto& [id, surface, form, triangles] : context.faces) {
    faces.push_back({{"id", id}, {"surface", surface}, {"form", form}, {"triangles", triangles}});
  }
  for (const SkippedFace& face : context.skipped) skipped.push_back({{"id", face.id}, {"reason", face.reason.what}});
  for (const LeftOut& left : left_out_of_picture(source, context.skipped)) left_out.push_back(sentence(left));
  return "{\"buffers\":" +
         buffers_json({{"positions", context.positions}, {"normals", context.normals}, {"indices", context.indices}}) +
         ",\"faces\":" + faces.dump() +
         ",\"skipped\":" + skipped.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
         ",\"left_out\":" + left_out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "}";
}

namespace {

/// A billionth of the domain is less than a pixel of a picture from a hundred thousand times as near as all of it.
void add_fractions(nlohmann::json& numbers, const Eigen::Vector2d& p) {
  numbers.push_back(std::round(p.x() * 1e9) / 1e9);
  numbers.push_back(std::round(p.y() * 1e9) / 1e9);
}

}  // namespace

std::string trim_json(const SurfaceTrim& trim) {
  if (trim.whole) return "null";
  auto faces = nlohmann::json::array();
  for (const TrimFace& face : trim.faces) {
    auto loops = nlohmann::json::array();
    for (const TrimLoop& loop : face) {
      auto numbers = nlohmann::json::array();
      for (const auto& p : loop) add_fractions(numbers, {p.x(), p.y()});
      loops.push_back(std::move(numbers));
    }
    faces.push_back(std::move(loops));
  }
  return nlohmann::json{{"faces", std::move(faces)}}.dump();
}

std::string face_edges_json(const VisibleRegion& region) {
  auto edges = nlohmann::json::array();
  for (const TrimEdge& edge : region.edges) {
    auto course = nlohmann::json::array();
    for (const Eigen::Vector2d& p : edge.course) add_fractions(course, p);
    auto meets = nlohmann::json::array();
    for (std::size_t k = 0; k < edge.neighbours.size(); ++k) {
      const std::string& on = edge.supports[k];  // "#30 PLANE"
      const auto space = on.find(' ');
      meets.push_back({{"face", edge.neighbours[k]},
                       {"surface", on.substr(0, space)},
                       {"form", space == std::string::npos ? "" : on.substr(space + 1)}});
    }
    edges.push_back({{"id", edge.id}, {"course", std::move(course)}, {"meets", std::move(meets)}, {"seam", edge.seam}});
  }
  return edges.dump();
}

}  // namespace knead::studio
