#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"

namespace knead {

/// A new file of the faces of another one.
struct FacesFile {
  std::string bytes;
  std::size_t faces = 0;     ///< with their trims
  std::size_t solids = 0;    ///< that they bound
  std::size_t surfaces = 0;  ///< B-spline surfaces without faces, each written as one on its natural bounds
  std::size_t curves = 0;
  std::vector<LeftOut> left_out;  ///< everything else of the source, and why
};

/// Whether new files of this format hold faces with their trims.
[[nodiscard]] bool holds_faces(const Format& format);

/// The faces of a source as a new file: their surfaces, edges and vertices, shared as in the source; closed shells as
/// solids, with their hollows; B-spline surfaces without faces; curves; names and colours; parts in their places, with
/// the units of their own lengths where the format has several. Control points, knots and weights are the same bits;
/// edges and analytic surfaces the same numbers, to rounding.
///
/// \param convert planes, cylinders, cones, spheres, tori and swept surfaces become B-spline surfaces, exact but for
///   rounding (`brep::exact_spline`); one that cannot is written as it is, and named in `left_out`
/// `options`: unit (of lengths where the source has none), title and schema; `curves` and `faces` are not used.
/// Errors (input): a source without faces and curves, or of which nothing can be written; a unit that the format does
/// not have; a format that holds no faces. Cost: linear in the file, and a coarse mesh of closed shells.
[[nodiscard]] Expected<FacesFile> save_faces(const Source& source, const Format& format,
                                             const SaveOptions& options = {}, bool convert = false);

}  // namespace knead
