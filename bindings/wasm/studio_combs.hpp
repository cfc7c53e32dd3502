#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "knead/brep/visible_region.hpp"
#include "knead/spline/curvature_comb.hpp"
#include "knead/spline/section_comb.hpp"

namespace knead::studio {

/// Curvature combs to draw, those teeth that are visible.
struct CombPicture {
  std::vector<float> places, vectors;  ///< 3 per tooth; places relative to the requested origin
  std::vector<std::uint8_t> joined;    ///< per tooth: 1 if it continues the comb of the tooth before it
  double largest = 0;                  ///< curvature of any visible tooth, 1/length
  Point at = Point::Zero();            ///< where that is, relative to the origin
};

/// Errors: those of `curvature_combs`. \param visible null: all of the surface
[[nodiscard]] Expected<CombPicture> comb_picture(const Surface& surface, const CurvatureCombOptions& options,
                                                 const Point& origin, const VisibleRegion* visible);

/// Of the curves in which a plane, in file units, cuts a surface; teeth as dense as chords that are within 1e-3 of the
/// extent of its control points. Errors: those of `section_combs`. \param visible null: all of the surface
[[nodiscard]] Expected<CombPicture> section_comb_picture(const Surface& surface, const SectionPlane& plane,
                                                         const Point& origin, const VisibleRegion* visible);

/// {"largest", "at": [x, y, z], "buffers": …}
[[nodiscard]] std::string comb_json(const CombPicture& picture);

}  // namespace knead::studio
