#pragma once

#include <string>
#include <vector>

#include "brep/tessellation/context_faces.hpp"
#include "knead/base/error.hpp"
#include "knead/brep/model.hpp"

namespace knead {

/// A closed polygon in fractions of a surface's parameter domain: (0, 0) and (1, 1) are the corners
/// of the domain. The first corner is not repeated at the end. Polygons of closed surfaces may
/// reach beyond 0 … 1 by up to one turn.
using TrimLoop = std::vector<Eigen::Vector2d>;

/// The part of its surface that a face shows: the points enclosed by an odd number of the loops.
using TrimFace = std::vector<TrimLoop>;

/// The part of a surface that its faces show together.
struct SurfaceTrim {
  /// Nothing is trimmed away: the surface is untrimmed, or no face lies on it, or one of its faces
  /// is in `skipped`.
  bool whole = true;
  /// Otherwise: the union of these. Faces over the seam of a closed surface appear once for each
  /// turn that overlaps 0 … 1.
  std::vector<TrimFace> faces;
};

struct TrimLoops {
  std::vector<SurfaceTrim> surfaces;  ///< in the order of `brep::File::surfaces()`
  std::vector<SkippedFace> skipped;   ///< faces whose bounds could not be followed, and why
};

/// The bounds of the faces on the B-spline surfaces of a STEP file, in the surfaces' parameters.
///
/// The edges are sampled as for `context_faces`, and every point is projected onto the surface:
/// from the foot of the one before it, or from a grid where that fails, by Levenberg–Marquardt
/// iteration for the nearest point. So a file's own parameter curves (PCURVE), which are often
/// missing and sometimes wrong, are not needed. Where the surface closes on itself or has a pole
/// the loops are cut open as for `context_faces`.
///
/// \param chord as in `context_faces`
/// Errors (usage): chord out of range.
/// Cost: O((p + 1)²) per point and iteration, and a grid of about 4 points per span and direction
/// per trimmed surface.
[[nodiscard]] Expected<TrimLoops> trim_loops(const brep::Model& model, double chord = 1e-3);

}  // namespace knead
