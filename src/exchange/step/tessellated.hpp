#pragma once

#include <Eigen/Geometry>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "entity.hpp"
#include "knead/brep/face_mesh.hpp"

namespace knead::step {

/// A TRIANGULATED_FACE or another item made of triangles, and where the sets that hold it put it.
struct TessellatedRecord {
  std::uint32_t instance = no_instance;
  std::uint32_t named = no_instance;  ///< it, or what holds it, with a label; none: nothing has one
  std::vector<Eigen::Affine3d> places;
};

/// The tessellated items of a file (ISO 10303-42, edition 4 and later), by what becomes of them.
///
/// TRIANGULATED_FACE, COMPLEX_TRIANGULATED_FACE, TRIANGULATED_SURFACE_SET and
/// COMPLEX_TRIANGULATED_SURFACE_SET, alone or in TESSELLATED_SOLIDs, TESSELLATED_SHELLs and
/// TESSELLATED_GEOMETRIC_SETs, where REPOSITIONED_TESSELLATED_ITEM puts them. Those linked to exact
/// faces that the file has are not shown, alone or by their solid or shell; neither are those of
/// annotations.
struct TessellatedRecords {
  std::vector<TessellatedRecord> shown;           ///< in the order of the file
  std::vector<std::uint32_t> pictures;            ///< of exact faces that the file has
  std::unordered_set<std::uint32_t> annotations;  ///< with the sets that hold them
  bool too_many = false;  ///< sets hold each other more often than is followed
};

/// Cost: linear in the items and the sets that hold them, in a file of exact faces also in those.
[[nodiscard]] TessellatedRecords tessellated_records(const Reader& reader);

/// Reads the triangles of items. Coordinates, which many faces may share, are read once.
///
/// Indices, from 1, are those of `pnindex`, which leads to the coordinates, or where that is empty
/// those of the coordinates. A strip a, b, c, d, … is the triangles abc, cbd, cde, …; a fan the
/// triangles abc, acd, …; those with a repeated index are left out. Normals are those of the file,
/// one for all or one per point; without any, each triangle has its own, and points of its own.
/// Where normals are given and more of an item's area is seen from behind, its triangles are
/// turned: normals say which side is outside.
class TessellatedReader {
 public:
  explicit TessellatedReader(const Reader& reader) : reader_(reader) {}
  /// Errors (input): an index that is none of its points; numbers that are none; a count of normals
  /// other than 0, 1 or that of the points; a strip or fan of fewer than three points; no triangle;
  /// more than five million triangles that sets repeat elsewhere, in this and the items before it.
  /// Cost: linear in the triangles of every place.
  [[nodiscard]] Expected<FaceMesh> mesh(const TessellatedRecord& record);

 private:
  [[nodiscard]] Expected<const std::vector<Point>*> coordinates(std::uint32_t list);

  const Reader& reader_;
  std::unordered_map<std::uint32_t, std::vector<Point>> lists_;
  double copied_ = 0;  // triangles that repeat others
};

}  // namespace knead::step
