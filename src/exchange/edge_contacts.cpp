#include "knead/exchange/edge_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "face_loops.hpp"
#include "face_region.hpp"
#include "face_surface.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_surfaces.hpp"
#include "step_units.hpp"

namespace knead {

using namespace step;
namespace {

using Eigen::Vector2d;

/// Follows edges over the surfaces of the faces around them.
class Follower {
 public:
  explicit Follower(const step::File::Data& data)
      : data_(data),
        reader_(data.records),
        loops_(reader_, {under_chord}),
        angle_units_(plane_angle_units(reader_)),
        feet_(data.surfaces->size()) {}

  const Reader& reader() const { return reader_; }

  Expected<EdgeContactFace> follow(const Face& face, const std::vector<Point>& points) {
    EdgeContactFace result;
    result.id = name_of(reader_, face.instance);
    result.same_sense = face.same_sense;
    if (points.empty()) return result;
    const auto& drawn = data_.surface_instances;
    const auto on = std::ranges::find(drawn, face.surface);
    if (on == drawn.end()) {
      if (auto done = along_other(face, points, result); !done) return std::unexpected(done.error());
      return result;
    }
    const auto k = static_cast<std::size_t>(on - drawn.begin());
    result.surface = (*data_.surfaces)[k].id;
    if (auto done = along_spline(k, points, result.feet); !done) return std::unexpected(done.error());
    return result;
  }

 private:
  Expected<void> along_spline(std::size_t k, const std::vector<Point>& points, std::vector<Vector2d>& feet) {
    if (!feet_[k]) {
      auto made = SurfaceFoot::create((*data_.surfaces)[k].surface);
      if (!made) return std::unexpected(made.error());
      feet_[k] = *std::move(made);
    }
    feet = feet_[k]->along(points, on_surface * net_diagonal((*data_.surfaces)[k].surface.control_points())).feet;
    return {};
  }

  Expected<void> along_other(const Face& face, const std::vector<Point>& points, EdgeContactFace& result) {
    const auto surface = FaceSurface::under(reader_, face, loops_, angle_units_);
    if (!surface) return std::unexpected(surface.error());
    for (const Point& p : points) {
      const Vector2d at = surface->foot(p).parameters;
      result.points.push_back(surface->at(at));
      result.normals.push_back((face.same_sense ? 1 : -1) * surface->normal(at));
      result.bending.emplace_back(Eigen::Matrix3d::Zero());
      const auto curvature = surface->curvature(at);
      for (std::size_t k = 0; curvature && k < 2; ++k) {
        const Point& along = curvature->directions[k];
        result.bending.back() += (face.same_sense ? 1 : -1) * curvature->principal[k] * along * along.transpose();
      }
    }
    return {};
  }

  const step::File::Data& data_;
  const Reader reader_;
  EdgeSampler loops_;
  std::vector<double> angle_units_;
  std::vector<std::optional<SurfaceFoot>> feet_;  // by the number of the surface
};

Expected<std::vector<Point>> points_along(const Reader& reader, std::uint32_t edge, int samples) {
  const auto piece = edge_piece(reader, edge);
  if (!piece) return std::unexpected(piece.error());
  std::vector<Point> result;
  for (int k = 0; k < samples; ++k) {
    result.push_back(piece->curve.at(std::lerp(piece->from, piece->to, static_cast<double>(k) / (samples - 1))));
  }
  return result;
}

/// The faces of a file around the edges of some of them.
struct EdgesOfFaces {
  std::vector<std::uint32_t> edges;                              ///< of the faces on some surfaces, each once
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces_at;  ///< of every edge, by their numbers, ascending
};

EdgesOfFaces edges_of_faces(const Reader& reader, const std::vector<Face>& faces,
                            const std::set<std::uint32_t>& surfaces) {
  EdgesOfFaces result;
  std::set<std::uint32_t> known;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (const auto edge : edges_around(reader, faces[f])) {
      result.faces_at[edge].push_back(f);
      if (surfaces.contains(faces[f].surface) && known.insert(edge).second) result.edges.push_back(edge);
    }
  }
  return result;
}

}  // namespace

Expected<std::vector<EdgeContact>> edge_contacts(const step::File& file, std::span<const std::string> surfaces,
                                                 int samples) {
  const step::File::Data& data = file.data();
  std::set<std::uint32_t> on;
  for (const std::string& surface : surfaces) {
    const auto index = data.surface_index.find(surface);
    if (index == data.surface_index.end()) return input_error("there is no such surface", surface);
    on.insert(data.surface_instances[index->second]);
  }
  Follower follower(data);
  const Reader& reader = follower.reader();
  const auto faces = read_faces(reader);
  const auto found = edges_of_faces(reader, faces, on);
  const auto uncertainties = uncertainties_of(reader, data.surface_instances);
  std::vector<EdgeContact> result;
  for (const auto edge : found.edges) {
    EdgeContact& made = result.emplace_back();
    made.id = name_of(reader, edge);
    auto points = points_along(reader, edge, std::max(2, samples));
    if (points)
      made.points = *std::move(points);
    else
      made.unknown = points.error().message();
    const auto& around = found.faces_at.at(edge);
    for (std::size_t k = 0; k < around.size(); ++k) {
      const Face& at = faces[around[k]];
      if (k > 0 && around[k] == around[k - 1]) {
        made.seam = true;
        continue;
      }
      auto face = follower.follow(at, made.points);
      if (!face) {
        made.unknown = face.error().message();
        continue;
      }
      if (!face->surface.empty()) {
        made.uncertainty = std::max(made.uncertainty, uncertainties[data.surface_index.at(face->surface)]);
      }
      made.faces.push_back(*std::move(face));
    }
  }
  return result;
}

Expected<std::vector<EdgeContact>> edge_contacts(const step::File& file, const std::string& surface, int samples) {
  return edge_contacts(file, std::span(&surface, 1), samples);
}

}  // namespace knead
