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
/// src/brep/tessellation/model_mesh.hpp), as a file of a format that holds triangles, one mesh per
/// face: named by its B-spline surface or tessellated item, or, if that has no name, by its id. The
/// unit is the model's; `options.unit` and `options.detail` are not used. Errors: those of
/// `model_faces`; a file without faces (input); a format of surfaces (usage); no face could be made
/// triangles (input); a coordinate too large for the format (numerical).
[[nodiscard]] Expected<ModelFile> save_model(const Source& source, const Format& format,
                                             double tolerance = 0, SaveOptions options = {});

/// A new file of the faces of another one.
struct FacesFile {
  std::string bytes;
  std::size_t faces = 0;   ///< with their trims
  std::size_t solids = 0;  ///< that they bound
  /// B-spline surfaces without faces, each written as one on its natural bounds.
  std::size_t surfaces = 0;
  std::size_t curves = 0;
  std::vector<LeftOut> left_out;  ///< everything else of the source, and why
};

/// Whether new files of this format hold faces with their trims.
[[nodiscard]] bool holds_faces(const Format& format);

/// The faces of a source as a new file: their surfaces, edges and vertices, shared as in the
/// source; closed shells as solids, with their hollows; B-spline surfaces without faces; curves;
/// names and colours; parts in their places, with the units of their own lengths where the format
/// has several. Control points, knots and weights are the same bits; edges and analytic surfaces
/// the same numbers, to rounding.
///
/// \param convert planes, cylinders, cones, spheres, tori and swept surfaces become B-spline
/// surfaces, exact but for
///   rounding (`brep::exact_spline`); one that cannot is written as it is, and named in `left_out`
/// `options`: unit (of lengths where the source has none), title and schema; `curves` and `faces`
/// are not used. Errors (input): a source without faces and curves, or of which nothing can be
/// written; a unit that the format does not have; a format that holds no faces. Cost: linear in the
/// file, and a coarse mesh of closed shells.
[[nodiscard]] Expected<FacesFile> save_faces(const Source& source, const Format& format,
                                             const SaveOptions& options = {}, bool convert = false);

}  // namespace knead
