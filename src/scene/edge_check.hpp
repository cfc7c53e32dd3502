#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "brep/edge_contacts.hpp"
#include "scene.hpp"

namespace knead {

/// How the faces at an edge meet, now and as the surfaces were opened. The largest values along the
/// edge.
struct EdgeCheck {
  std::string id;
  std::vector<std::string> faces;  ///< that meet there
  double gap = 0;         ///< between them; of an edge of one face: from its curve. File units
  double opened_gap = 0;  ///< as it was
  std::optional<double>
      angle;  ///< between the faces, radians from 0, smooth, to π; none: of one face only
  std::optional<double> opened_angle;
  std::optional<double>
      curvature;  ///< by which the faces differ, 1/length; none: they are nowhere tangent there
  std::optional<double> opened_curvature;
  std::string unknown;  ///< why nothing is known; empty: it is
};

/// Faces that meet at no larger angle have a difference in curvature: half a degree.
inline constexpr double tangent_angle = 0.5 * std::numbers::pi / 180;

/// Measures edges at the points of their contacts.
///
/// With S_a and S_b two faces at an edge and a_k, b_k the feet of its points, the gap is max
/// |S_a(a_k) − S_b(b_k)| and the angle max ∠(n_a, n_b) between the normals of the faces (of
/// surfaces against their sense where the faces are), by atan2(|n_a × n_b|, n_a · n_b), so that
/// small angles are exact too. Where more than two faces meet it is the largest of any pair. Points
/// without a tangent plane, as at poles, do not count for the angle.
///
/// The difference in curvature is the largest over all directions, max |κ_a(t) − κ_b(t)| of the
/// normal curvatures, i.e. the largest eigenvalue in magnitude of W_a − W_b, where W = J I⁻¹ II I⁻¹
/// Jᵀ with J = (S_u, S_v) is the shape operator as a symmetric 3 × 3 matrix, its sign by the normal
/// of the face. Faces with a common tangent plane along an edge differ only across it, and that is
/// where it is taken. Only points count at which the faces meet to `tangent_angle`. 0 is continuity
/// of curvature (G2). At knots along the edge the limit from above is taken.
///
/// Feet are those of the surfaces as opened; they are as good where the surface has moved, as
/// displacement is a function of the parameters. Surfaces that the scene does not have stay as the
/// file has them. Errors: those of evaluation.
[[nodiscard]] Expected<std::vector<EdgeCheck>> check_edges(
    const Scene& scene, const std::vector<EdgeContact>& contacts);

}  // namespace knead
