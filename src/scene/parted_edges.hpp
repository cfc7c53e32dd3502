#pragma once

#include <string>
#include <vector>

#include "brep/edge_contacts.hpp"
#include "scene.hpp"

namespace knead {

/// An edge of faces that does not meet its faces any more.
struct PartedEdge {
  std::string id;
  std::vector<std::string> faces;     ///< that met there
  std::vector<std::string> surfaces;  ///< of the scene, on which they lie
  /// Of the faces from each other, or from the curve that stays behind; file units.
  double distance = 0;
  double opened = 0;            ///< the same of the surfaces as opened
  double allowed = 0;           ///< up to this distance an edge is closed
  Point place = Point::Zero();  ///< of the curve, where the distance is largest
  bool freed = false;           ///< a surface at it lets it open (`may_open`)
};

/// The edges that would be written farther from their faces than they may be.
///
/// With C(t_k) the points of a contact and a_k, b_k its feet on two faces, the distance is max
/// |S_a(a_k) − S_b(b_k)| over all pairs of faces, and where the edge has not followed them, so that
/// its curve stays, also max |S_a(a_k) − C(t_k)|; the two sides of a closed face at its seam count
/// as two faces. An edge is closed up to the largest of 1.01 of this distance as opened, the
/// uncertainty of the file and 1e-6 of the size of the largest surface; one that follows, up to the
/// distance as opened and the larger of the other two, by which its faces may part
/// (`parting`). Faces that are not known at an edge do not count. Errors: those of evaluation.
[[nodiscard]] Expected<std::vector<PartedEdge>> parted_edges(
    const Scene& scene, const std::vector<EdgeContact>& contacts);

/// Error (numerical): an edge among these that was not freed; the one that is farthest beyond what
/// is allowed, with what to do.
[[nodiscard]] Expected<void> check_parted(const std::vector<PartedEdge>& edges);

/// What a report says of an edge that was freed and has opened.
[[nodiscard]] std::string note_on(const PartedEdge& edge);

}  // namespace knead
