#pragma once

#include <array>
#include <vector>

#include "boundary_edges.hpp"

namespace knead::brep {

/// The sides of a rectangle of a surface's parameters, those of ISO 10303-42 with angles in
/// radians, counterclockwise about its normal, as exact curves: isocurves of B-spline surfaces and
/// of the exact splines of other forms. Sides that are points are left out. `u` and `v` may go up
/// to a turn past the domain of a closed direction of another form. Errors (input): a form that is
/// not known, a rectangle beyond the surface; those of `FaceSurface::create` and `patch`.
[[nodiscard]] Expected<std::vector<BoundaryPiece>> rectangle_sides(const Model& model,
                                                                   const Support& support,
                                                                   const Interval& u,
                                                                   const Interval& v);

/// The parameters of a whole surface. Errors (input): it is unbounded.
[[nodiscard]] Expected<std::array<Interval, 2>> whole_rectangle(const Model& model,
                                                                const Support& support);

}  // namespace knead::brep
