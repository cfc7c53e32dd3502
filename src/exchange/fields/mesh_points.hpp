#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::fields {

/// The points of a mesh or a point cloud, in the order of the file.
struct MeshPoints {
  std::string_view format = {};     ///< "STL"
  std::vector<Point> points = {};   ///< of STL three for every triangle, as they stand there
  std::vector<Point> normals = {};  ///< one per point, as the file has them; or none
  /// Positions of corners: of STL, OBJ and PLY, larger faces as fans of triangles.
  std::vector<std::array<std::uint32_t, 3>> triangles = {};
};

/// The points of a file of STL (ASCII or binary), OBJ, PLY (ASCII or binary, both byte orders), VTK
/// (legacy, VTU, VTP), or of lines of 3 or 6 numbers (XYZ). Formats are told by their first bytes,
/// binary STL by its size, unless the ending of `file` says it. Normals are those of PLY
/// (nx, ny, nz) and of six columns; triangles those of STL, OBJ and PLY. Errors (input): it
/// violates its format, is cut off, or a coordinate is not finite, with the line, or in binary
/// files the number of the item. Cost: linear in the bytes, whatever counts they announce.
[[nodiscard]] Expected<MeshPoints> read_mesh_points(std::string_view bytes, std::string_view file);

/// Each point once, at its first place, with its normal: points are one if their coordinates are
/// equal. Triangles with two equal corners are left out.
[[nodiscard]] MeshPoints joined(MeshPoints mesh);

/// A face as a fan of triangles. \param numbers of its corners, the first point having the number
/// `first`; if that is 1, negative ones count from the last point. Errors (input): there is no such
/// point.
[[nodiscard]] Expected<void> add_face(const std::vector<double>& numbers, double first,
                                      std::string_view file, int line, MeshPoints& mesh);

[[nodiscard]] Expected<MeshPoints> read_stl(std::string_view bytes, std::string_view file);
[[nodiscard]] Expected<MeshPoints> read_ply(std::string_view bytes, std::string_view file);

}  // namespace knead::fields
