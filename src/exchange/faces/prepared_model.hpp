#pragma once

#include <memory>
#include <string>
#include <vector>

#include "brep/tessellation/context_faces.hpp"
#include "knead/brep/model.hpp"

namespace knead::detail {

/// Which surfaces become B-spline surfaces.
enum class Conversion {
  none,
  all_but_whole_spheres,  ///< for formats whose readers cannot follow a loop along the seam from
                          ///< pole to pole
  all,
};

/// Whether a face covers all of this sphere: its bounds are vertices, or its seam there and back.
/// \param id of the surface
[[nodiscard]] bool is_whole_sphere(const brep::Model& model, const std::string& id);

/// A model in the terms in which new files are written.
struct PreparedModel {
  std::shared_ptr<const brep::Model> model;
  std::vector<SkippedFace>
      analytic;  ///< surfaces of other forms that could not be made B-splines, and why
};

/// Half angles of cones in radians; polygons round faces as edges on lines, shared by points that
/// are the same bit for bit, on planes by Newell's normal where the faces have no surface.
/// Elementary and swept surfaces as the B-spline surfaces that `brep::exact_spline` makes of them,
/// if they are to be converted. The same model where there is nothing to do.
[[nodiscard]] PreparedModel prepared(std::shared_ptr<const brep::Model> model,
                                     Conversion conversion);

}  // namespace knead::detail
