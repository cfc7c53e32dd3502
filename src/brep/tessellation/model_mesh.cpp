#include "model_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "brep/boundary_curve.hpp"
#include "face_tessellator.hpp"
#include "grid_mesh.hpp"
#include "knead/brep/model.hpp"
#include "spline/grid_lines.hpp"

namespace knead {

using namespace brep;

namespace {

constexpr double default_tolerance = 1.0 / 2000;  // of the diagonal of the model's box
constexpr double least_tolerance_share = 1e-7;
constexpr double half_radian = 0.031;  // of radii: chords turn by 0.5 radians
// Triangles are measured at their centres and those of their sides alone.
constexpr double safety = 0.65;

/// Where the faces of a file, and its B-spline surfaces without faces, stand in the model.
class Standing {
 public:
  explicit Standing(const Assembly& assembly) {
    for (const Part& part : assembly.parts) {
      for (const std::vector<std::string>* ids : {&part.faces, &part.surfaces}) {
        for (const std::string& id : *ids) parts_[id].push_back(&part);
      }
    }
  }

  /// The largest factor by which it is scaled; rotations are within the rounding of single
  /// precision.
  [[nodiscard]] float scale(const std::string& id) const {
    double result = 0;
    for_each(id, [&](const Eigen::Affine3d& move) {
      result = std::max(result, move.linear().colwise().norm().maxCoeff());
    });
    return static_cast<float>(result > 0 ? result : 1);
  }

  void add(const FaceMesh& mesh, const std::string& id, std::vector<FaceMesh>& to) const {
    for_each(id, [&](const Eigen::Affine3d& move) { to.push_back(moved(mesh, move)); });
  }

  /// Extends by the corners of a box round it.
  void extend(Eigen::AlignedBox3d& box, const std::string& id,
              const Eigen::AlignedBox3d& own_box) const {
    for_each(id, [&](const Eigen::Affine3d& move) {
      for (int k = 0; k < 8; ++k)
        box.extend(move * own_box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
    });
  }

 private:
  template <class Visit>
  void for_each(const std::string& id, const Visit& visit) const {
    const auto found = parts_.find(id);
    if (found == parts_.end()) return;
    for (const Part* part : found->second) {
      for (const PartPlace& place : part->places) visit(place.to_model);
    }
  }

  static FaceMesh moved(FaceMesh mesh, const Eigen::Affine3d& move) {
    if (move.matrix().isIdentity(0)) return mesh;
    const Eigen::Matrix3d linear = move.linear(), normals = linear.inverse().transpose();
    for (Point& p : mesh.points) p = move * p;
    for (Point& n : mesh.normals) n = (normals * n).stableNormalized();
    if (linear.determinant() < 0) {
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
  }

  std::unordered_map<std::string, std::vector<const Part*>> parts_;  // by id
};

/// How far across the whole surface of a face is where that is closed, of which its edges may say
/// nothing; else 0.
double closed_extent(const Model& model, const Face& face, std::span<const brep::Loop> loops) {
  if (const SplineSurface* spline = model.spline_under(face)) {
    return spline->closed[0] || spline->closed[1] ? net_diagonal(spline->surface.control_points())
                                                  : 0;
  }
  if (face.support == none) return 0;
  using Kind = ElementarySurface::Kind;
  const auto* form = std::get_if<ElementarySurface>(&model.supports[face.support].form);
  if (form == nullptr || (form->kind != Kind::sphere && form->kind != Kind::torus)) return 0;
  const auto surface = FaceSurface::under(model, face, loops);
  return surface ? 2 * surface->reach() : 0;
}

/// Round the triangles of a face; empty where there are none.
Eigen::AlignedBox3d box_of(FaceTessellator& coarse, const Face& face) {
  Eigen::AlignedBox3d box;
  const auto on = coarse.face_on_surface(face);
  const auto mesh = on ? coarse.mesh(*on) : std::unexpected(on.error());
  if (!mesh) return box;
  for (const Point& p : mesh->points) box.extend(p);
  return box;
}

/// Of the model's box: round the points of the edges of its faces or, without faces, its control
/// points. Where the edges of a closed surface bound next to nothing, such as a vertex or a small
/// hole, round the face.
double diagonal_of(const Model& model, const Standing& standing) {
  constexpr double bulging = 10;  // as wide as its edges
  Eigen::AlignedBox3d box;
  EdgeSampler edges(model, {half_radian});
  FaceTessellator coarse(model, {half_radian});
  for (const Face& face : model.faces) {
    const auto loops = edges.loops(face);
    if (!loops) continue;
    Eigen::AlignedBox3d own_box;
    for (const brep::Loop& loop : *loops) {
      for (const Point& p : loop) own_box.extend(p);
    }
    const double width = own_box.isEmpty() ? 0 : own_box.diagonal().norm();
    if (closed_extent(model, face, *loops) > bulging * width) own_box.extend(box_of(coarse, face));
    if (!own_box.isEmpty()) standing.extend(box, face.id, own_box);
  }
  for (const TessellatedItem& item : model.tessellated.items) {
    Eigen::AlignedBox3d own_box;
    for (const Point& p : item.mesh.points) own_box.extend(p);
    if (!own_box.isEmpty()) standing.extend(box, item.mesh.id, own_box);
  }
  if (box.isEmpty()) {
    for (const SplineSurface& s : model.surfaces) {
      const Points& points = s.surface.control_points();
      standing.extend(
          box, s.id,
          {points.colwise().minCoeff().transpose(), points.colwise().maxCoeff().transpose()});
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// A surface that no face cuts.
Expected<FaceMesh> whole(const SplineSurface& entity, double tolerance) {
  ChordOptions options;
  options.detail = 1;
  options.tolerance = tolerance / 3;  // both directions, and the twist between them
  options.most_points = 10'000'000;
  options.most = 100'000;
  const auto lines = grid_lines(entity.surface, options);
  if (!lines) return std::unexpected(lines.error());
  const auto mesh = grid_mesh(entity.surface, *lines);
  if (!mesh) return std::unexpected(mesh.error().within(entity.id));
  FaceMesh result{entity.id, entity.id, {}, {}, mesh->triangles};
  for (Eigen::Index k = 0; k < mesh->points.rows(); ++k) {
    result.points.push_back(mesh->points.row(k).transpose());
    result.normals.push_back(mesh->normals.row(k).transpose());
  }
  return result;
}

/// Faces of parts of one scale.
void add_faces(const Model& model, std::span<const Face* const> faces, double tolerance,
               const Standing& standing, FaceMeshes& result) {
  FaceTessellator tessellator(model, {half_radian, safety * tolerance});
  std::vector<FaceOnSurface> ready;
  const auto skip = [&](const Face& face, Error reason) {
    result.skipped.push_back({face.id, std::move(reason)});
  };
  for (const Face* face : faces) {
    auto on = tessellator.face_on_surface(*face);
    if (!on)
      skip(*face, std::move(on.error()));
    else if (auto divided = tessellator.divide_edges(*on); !divided)
      skip(*face, std::move(divided.error()));
    else
      ready.push_back(*std::move(on));
  }
  auto meshes = tessellator.meshes(ready);
  for (std::size_t k = 0; k < ready.size(); ++k) {
    if (meshes[k])
      standing.add(*meshes[k], meshes[k]->id, result.faces);
    else
      skip(*ready[k].face, std::move(meshes[k].error()));
  }
}

}  // namespace

Expected<FaceMeshes> model_faces(const Model& model, double tolerance) {
  if (!model.assembly) return std::unexpected(model.assembly.error());
  const Standing standing(*model.assembly);
  const double diagonal = diagonal_of(model, standing);
  if (model.faces.empty() && model.surfaces.empty() && model.tessellated.items.empty() &&
      model.tessellated.skipped.empty())
    return input_error("the file has no faces", {}, "open a file with faces");
  if (!std::isfinite(diagonal)) {
    return numerical_error(
        "the extent of the model leaves the range of double precision", {},
        "correct its coordinates and placements, or use a larger unit of length");
  }
  // Without any extent nothing can be read or drawn: the faces say why.
  if (tolerance == 0) tolerance = diagonal > 0 ? default_tolerance * diagonal : 1;
  if (!std::isfinite(tolerance) || tolerance < least_tolerance_share * diagonal ||
      !(tolerance > 0)) {
    return std::unexpected(Error{ErrorKind::usage,
                                 fmt::format("{} is not a tolerance for this model", tolerance),
                                 "tolerance",
                                 fmt::format("use a length above {:.2g}, in the units of the file",
                                             least_tolerance_share * diagonal)});
  }
  FaceMeshes result;
  // Faces of parts that are placed smaller or larger need another tolerance in their own units;
  // those of one scale are made together, as neighbours must share their edges' points.
  std::map<float, std::vector<const Face*>> by_scale;
  for (const Face& face : model.faces) by_scale[standing.scale(face.id)].push_back(&face);
  for (const auto& [scale, faces] : by_scale)
    add_faces(model, faces, tolerance / scale, standing, result);
  for (const SplineSurface& entity : model.surfaces) {
    if (entity.faces > 0) continue;
    auto mesh = whole(entity, tolerance / standing.scale(entity.id));
    if (mesh)
      standing.add(*mesh, entity.id, result.faces);
    else
      result.skipped.push_back({entity.id, std::move(mesh.error())});
  }
  for (const TessellatedItem& item : model.tessellated.items)
    standing.add(item.mesh, item.mesh.id, result.faces);
  const std::vector<SkippedFace>& torn = model.tessellated.skipped;
  result.skipped.insert(result.skipped.end(), torn.begin(), torn.end());
  return result;
}

// Every side must be met by its opposite, compared by the bits of both ends: a closed shell has
// none left. O(n log n).
std::size_t open_sides(std::span<const FaceMesh> faces) {
  using Ends = std::array<double, 6>;
  std::vector<Ends> forth, back;
  const auto add = [](std::vector<Ends>& to, const Point& a, const Point& b) {
    to.push_back({a.x(), a.y(), a.z(), b.x(), b.y(), b.z()});
  };
  for (const FaceMesh& mesh : faces) {
    for (const auto& t : mesh.triangles) {
      const std::array<Point, 3> p = {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
      if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        add(forth, p[k], p[(k + 1) % 3]);
        add(back, p[(k + 1) % 3], p[k]);
      }
    }
  }
  std::ranges::sort(forth);
  std::ranges::sort(back);
  std::vector<Ends> open;
  std::ranges::set_difference(forth, back, std::back_inserter(open));
  return open.size();
}

}  // namespace knead
