#pragma once

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
};

/// The points of a file of STL (ASCII or binary), OBJ, PLY (ASCII or binary, both byte orders), VTK
/// (legacy, VTU, VTP), or of lines of 3 or 6 numbers (XYZ). Formats are told by their first bytes,
/// binary STL by its size, unless the ending of `file` says it. Normals are those of PLY
/// (nx, ny, nz) and of six columns. Errors (input): it violates its format, is cut off, or a
/// coordinate is not finite, with the line, or in binary files the number of the item. Cost: linear
/// in the bytes, whatever counts they announce.
[[nodiscard]] Expected<MeshPoints> read_mesh_points(std::string_view bytes, std::string_view file);

/// Each point once, at its first place, with its normal: points are one if their coordinates are
/// equal.
[[nodiscard]] MeshPoints joined(MeshPoints mesh);

[[nodiscard]] Expected<MeshPoints> read_stl(std::string_view bytes, std::string_view file);
[[nodiscard]] Expected<MeshPoints> read_ply(std::string_view bytes, std::string_view file);

}  // namespace knead::fields
