#include "edge_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "brep/shared_edge.hpp"
#include "knead/spline/curvature.hpp"

namespace knead {
namespace {

/// A face along an edge: its points, its unit normals, zero where there is no tangent plane, and
/// its shape operators, empty where they are not known.
struct FaceSide {
  std::vector<Point> points, normals;
  std::vector<Eigen::Matrix3d> bending;
};

Expected<FaceSide> side_of(const EdgeContactFace& face, const Surface& surface) {
  Parameters<2> places(static_cast<Eigen::Index>(face.feet.size()), 2);
  for (std::size_t k = 0; k < face.feet.size(); ++k) {
    const auto at = parameters_at_foot(surface, face.feet[k]);
    places.row(static_cast<Eigen::Index>(k)) << at[0], at[1];
  }
  const auto jet = evaluate<2>(surface, places, 2);
  if (!jet) return std::unexpected(jet.error());
  FaceSide side;
  for (Eigen::Index k = 0; k < places.rows(); ++k) {
    const auto derivative = [&](int i, int j) { return Point(jet->at({i, j}).row(k).transpose()); };
    const Point u = derivative(1, 0), v = derivative(0, 1);
    const Point normal = (face.same_sense ? 1 : -1) * u.cross(v);
    side.points.emplace_back(jet->points().row(k).transpose());
    const bool regular = normal.norm() > 1e-9 * (u.squaredNorm() + v.squaredNorm());
    side.normals.emplace_back(regular ? Point(normal.normalized()) : Point(Point::Zero()));
    const FundamentalForms forms(u, v, derivative(2, 0), derivative(1, 1), derivative(0, 2),
                                 side.normals.back());
    side.bending.push_back(regular ? shape_operator(u, v, forms)
                                   : Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  }
  return side;
}

struct Meeting {
  double gap = 0;
  std::optional<double> angle, curvature;
};

// Position, tangent plane and curvature at pairs of feet (G0, G1, G2). Angles by atan2 of cross and
// dot product: acos loses half of the digits at small angles, the ones that matter here. Curvature
// only where tangent planes agree: elsewhere the difference of the maps is no difference of normal
// curvatures. λ_max of the difference is the largest over all directions.
Expected<void> meet(const FaceSide& a, const FaceSide& b, Meeting& meeting) {
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    meeting.gap = std::max(meeting.gap, (a.points[k] - b.points[k]).norm());
    if (a.normals[k].isZero() || b.normals[k].isZero()) continue;
    const double angle =
        std::atan2(a.normals[k].cross(b.normals[k]).norm(), a.normals[k].dot(b.normals[k]));
    meeting.angle = std::max(meeting.angle.value_or(0), angle);
    if (angle > tangent_angle || a.bending.empty() || b.bending.empty()) continue;
    const auto difference = detail::symmetric_eigenvalues(a.bending[k] - b.bending[k]);
    if (!difference) return std::unexpected(difference.error());
    meeting.curvature = std::max(meeting.curvature.value_or(0), difference->cwiseAbs().maxCoeff());
  }
  return {};
}

/// Either as it is or as it was opened.
Expected<Meeting> meeting_of(const Scene& scene, const EdgeContact& contact, bool opened) {
  std::vector<FaceSide> sides;
  for (const EdgeContactFace& face : contact.faces) {
    if (face.surface.empty()) {
      sides.push_back({face.points, face.normals, face.bending});
      continue;
    }
    const auto s = std::ranges::find(scene.surfaces, face.surface, &SceneSurface::id);
    if (s == scene.surfaces.end())
      return input_error("the surface is not in the scene", face.surface);
    auto side = side_of(face, opened ? *s->opened : *s->current);
    if (!side) return std::unexpected(side.error());
    sides.push_back(*std::move(side));
  }
  Meeting meeting;
  if (sides.size() == 1) {
    const FaceSide still{
        contact.points, std::vector<Point>(contact.points.size(), Point::Zero()), {}};
    if (auto met = meet(sides[0], still, meeting); !met) return std::unexpected(met.error());
  }
  for (std::size_t a = 0; a < sides.size(); ++a) {
    for (std::size_t b = a + 1; b < sides.size(); ++b) {
      if (auto met = meet(sides[a], sides[b], meeting); !met) return std::unexpected(met.error());
    }
  }
  return meeting;
}

}  // namespace

Expected<std::vector<EdgeCheck>> check_edges(const Scene& scene,
                                             const std::vector<EdgeContact>& contacts) {
  std::vector<EdgeCheck> result;
  for (const EdgeContact& contact : contacts) {
    EdgeCheck& check = result.emplace_back();
    check.id = contact.id;
    check.unknown = contact.unknown;
    for (const EdgeContactFace& face : contact.faces) check.faces.push_back(face.id);
    if (!check.unknown.empty()) continue;
    const auto now = meeting_of(scene, contact, false), then = meeting_of(scene, contact, true);
    if (!now) return std::unexpected(now.error());
    if (!then) return std::unexpected(then.error());
    check.gap = now->gap;
    check.opened_gap = then->gap;
    check.angle = now->angle;
    check.opened_angle = then->angle;
    check.curvature = now->curvature;
    check.opened_curvature = then->curvature;
  }
  return result;
}

}  // namespace knead
