#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::fields {

/// Where points should go: `vectors[k]` from `points[k]`.
struct Displacements {
  std::vector<Point> points, vectors;
};

/// What of a file is the displacement.
struct DisplacementColumns {
  /// Names of the columns of a CSV file: point, then displacement.
  std::array<std::string, 6> columns = {"x", "y", "z", "dx", "dy", "dz"};
  std::string field = {};  ///< name of the field of a VTK file; empty: its only vector field
};

/// Displacements from a file of VTK (legacy, VTU, VTP: a vector field at points), or a text: lines
/// of six numbers `x y z dx dy dz` separated by white space, commas or semicolons, with comments
/// from "#" on; or CSV, whose first line names the columns and whose separator is the one of
/// semicolon, comma and white space that stands in that line. Errors (input), with the line: a
/// number that is missing or not finite; a column or field that is not there, where those that are
/// get listed; those of the readers of VTK. Cost: linear in the bytes.
[[nodiscard]] Expected<Displacements> read_displacements(std::string_view bytes,
                                                         std::string_view file,
                                                         const DisplacementColumns& which = {});

/// The displacements from one mesh to another with the same points in the same order, of the
/// formats of `read_mesh_points`. Of two STL files the corners of the triangles are the points, and
/// those that agree in both are taken once; where one of them is STL its equal points are joined
/// before. Errors (input): those of the readers; different counts, with both.
[[nodiscard]] Expected<Displacements> mesh_pair(std::string_view from, std::string_view from_file,
                                                std::string_view to, std::string_view to_file);

}  // namespace knead::fields
