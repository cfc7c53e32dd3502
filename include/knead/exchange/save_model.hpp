#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "knead/brep/face_mesh.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

/// A written mesh of a model.
struct ModelFile {
  std::string bytes;
  std::size_t faces = 0, triangles = 0, open_sides = 0;
  std::size_t tessellated = 0;  ///< of the faces: tessellated items of the file
  std::vector<SkippedFace> skipped;
  std::vector<std::string> warnings;  ///< of the assembly
};

/// All faces of a model as triangles that meet, within a tolerance (`model_faces`,
/// src/brep/tessellation/model_mesh.hpp), as a file of a format that holds triangles, one mesh per face: named by its
/// B-spline surface or tessellated item, or, if that has no name, by its id. The unit is the model's; `options.unit`
/// and `options.detail` are not used. Errors: those of `model_faces`; a file without faces (input); a format of
/// surfaces (usage); no face could be made triangles (input); a coordinate too large for the format (numerical).
[[nodiscard]] Expected<ModelFile> save_model(const Source& source, const Format& format, double tolerance = 0,
                                             SaveOptions options = {});

}  // namespace knead
