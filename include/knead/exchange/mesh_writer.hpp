#pragma once

#include <span>
#include <string>
#include <string_view>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead {

enum class MeshFormat {
  stl,  ///< binary STL: triangles, single precision
  obj,  ///< Wavefront OBJ: text, one object per surface, with normals
  ply,  ///< binary PLY, little endian: positions in double, normals in single precision
};

/// The format that a file name's ending asks for: ".stl", ".obj", ".ply", in any case. Error (input): another one.
[[nodiscard]] Expected<MeshFormat> mesh_format(std::string_view file_name);

struct MeshSurface {
  std::string name;  ///< of the object, UTF-8
  Surface surface;
};

struct MeshOptions {
  int detail = 96;        ///< grid lines wanted per direction and surface, 1 to 2000
  std::string unit = {};  ///< for comments: coordinates are written as they are
};

/// The bytes of a file with all surfaces as one triangle mesh: a picture of the exact surfaces, not a model.
///
/// Each surface, whole and untrimmed, is a grid with every knot line on it (`grid_lines`); the points lie on the
/// surface to rounding, and in STL to single precision. Triangles run counterclockwise seen from where S_u × S_v
/// points. Those that are no triangles, at poles, are left out. Vertices are not shared between surfaces, nor across
/// the seam of a closed one: equal control points along a seam give equal coordinates, but nothing promises a
/// watertight mesh. Normals are S_u × S_v / |S_u × S_v|, and where that vanishes the mean of those of the triangles
/// around. Errors: no surface, a detail out of range, more than 2³¹ triangles (input); a denominator that is not
/// positive, a coordinate too large for STL (numerical).
[[nodiscard]] Expected<std::string> mesh_file(std::span<const MeshSurface> surfaces, MeshFormat format,
                                              const MeshOptions& options = {});

}  // namespace knead
