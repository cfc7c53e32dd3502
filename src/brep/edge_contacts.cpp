#include "edge_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "boundary_curve.hpp"
#include "brep/surfaces/face_surface.hpp"
#include "face_loops.hpp"
#include "face_region.hpp"

namespace knead {

using namespace brep;
namespace {

using Eigen::Vector2d;

/// Follows edges over the surfaces of the faces around them.
/// Feet of an edge's points on all faces at it, in parameters where the surface may be sculpted
/// (they are evaluated again later), else as points, which are final.
/// Searches of B-spline surfaces are made once for each, as they tabulate the surface.
class Follower {
 public:
  explicit Follower(const Model& model)
      : model_(model), edges_(model, {under_chord}), feet_(model.surfaces.size()) {}

  Expected<EdgeContactFace> follow(const Face& face, const std::vector<Point>& points) {
    EdgeContactFace result;
    result.id = face.id;
    if (points.empty()) return result;
    const SplineSurface* const on = model_.spline_under(face);
    if (on == nullptr) {
      if (auto status = along_other(face, points, result); !status)
        return std::unexpected(status.error());
      return result;
    }
    result.surface = on->id;
    if (auto status = along_spline(model_.supports[face.support].spline, points, result.feet);
        !status) {
      return std::unexpected(status.error());
    }
    return result;
  }

 private:
  Expected<void> along_spline(Index k, const std::vector<Point>& points,
                              std::vector<Vector2d>& feet) {
    if (!feet_[k]) {
      auto made = SurfaceFoot::create(model_.surfaces[k].surface);
      if (!made) return std::unexpected(made.error());
      feet_[k] = *std::move(made);
    }
    feet =
        feet_[k]
            ->along(points, on_surface * net_diagonal(model_.surfaces[k].surface.control_points()))
            .feet;
    return {};
  }

  Expected<void> along_other(const Face& face, const std::vector<Point>& points,
                             EdgeContactFace& result) {
    const auto surface = FaceSurface::under(model_, face, edges_);
    if (!surface) return std::unexpected(surface.error());
    for (const Point& p : points) {
      result.points.push_back(surface->at(surface->foot(p).parameters));
    }
    return {};
  }

  const Model& model_;
  EdgeSampler edges_;
  std::vector<std::optional<SurfaceFoot>> feet_;  // by the number of the surface
};

Expected<std::vector<Point>> points_along(const Model& model, Index edge, int samples) {
  const auto piece = edge_piece(model, edge);
  if (!piece) return std::unexpected(piece.error());
  std::vector<Point> result;
  for (int k = 0; k < samples; ++k) {
    result.push_back(
        piece->curve.at(std::lerp(piece->from, piece->to, static_cast<double>(k) / (samples - 1))));
  }
  return result;
}

/// The faces of a model around the edges of some of them.
struct EdgesOfFaces {
  std::vector<Index> edges;                      ///< of the faces on some surfaces, each once
  std::map<Index, std::vector<Index>> faces_at;  ///< of every edge, ascending
};

EdgesOfFaces edges_of_faces(const Model& model, const std::set<Index>& surfaces) {
  EdgesOfFaces result;
  std::set<Index> known;
  for (Index f = 0; f < model.faces.size(); ++f) {
    const Face& face = model.faces[f];
    const bool on = face.support != none && surfaces.contains(model.supports[face.support].spline);
    for (const Index edge : edges_around(face)) {
      result.faces_at[edge].push_back(f);
      if (on && known.insert(edge).second) result.edges.push_back(edge);
    }
  }
  return result;
}

}  // namespace

Expected<std::vector<EdgeContact>> edge_contacts(const Model& model,
                                                 std::span<const std::string> surfaces,
                                                 int samples) {
  std::set<Index> on;
  for (const std::string& surface : surfaces) {
    const Index index = model.surface_index(surface);
    if (index == none) return input_error("there is no such surface", surface);
    on.insert(index);
  }
  Follower follower(model);
  const auto found = edges_of_faces(model, on);
  std::vector<EdgeContact> result;
  for (const Index edge : found.edges) {
    EdgeContact& made = result.emplace_back();
    made.id = model.edges[edge].id;
    auto points = points_along(model, edge, std::max(2, samples));
    if (points)
      made.points = *std::move(points);
    else
      made.unknown = points.error().message();
    const auto& around = found.faces_at.at(edge);
    for (std::size_t k = 0; k < around.size(); ++k) {
      if (k > 0 && around[k] == around[k - 1]) {
        made.seam = true;
        continue;
      }
      auto face = follower.follow(model.faces[around[k]], made.points);
      if (!face) {
        made.unknown = face.error().message();
        continue;
      }
      if (const SplineSurface* spline = model.find_surface(face->surface)) {
        made.uncertainty = std::max(made.uncertainty, spline->uncertainty);
      }
      made.faces.push_back(*std::move(face));
    }
  }
  return result;
}

Expected<std::vector<EdgeContact>> edge_contacts(const Model& model, const std::string& surface,
                                                 int samples) {
  return edge_contacts(model, std::span(&surface, 1), samples);
}

}  // namespace knead
