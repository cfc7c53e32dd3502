#pragma once

#include "knead/energy/domain_scaling.hpp"
#include "scene/scene.hpp"

namespace knead {

// Loads that keep their direction, as forces on the control points of a surface, one row each.

/// ∫ R_i ds · `per_length` along an edge of the rest surface, ds in its lengths: by p + 4 Gauss
/// points per span, p the degree along it. Exact up to rounding where the speed is constant.
/// Errors: a rational denominator that is not positive (numerical).
[[nodiscard]] Expected<Points> line_forces(const Surface& rest, SurfaceEdge edge,
                                           const Point& per_length);

/// ∫ R_i dA · `per_area`, dA the area of the rest surface in the units of the model: by p + 4 Gauss
/// points per span and direction. Errors: those of `load_forces`.
[[nodiscard]] Expected<Points> area_forces(const Surface& rest, const DomainScaling<2>& scaling,
                                           const Point& per_area);

/// One that `keeps_direction`, with its images under the mirror symmetries of its surface; `length`
/// is the unit that line forces count. Errors: those of `plane_of`, `parameters_at` and
/// `line_forces`.
[[nodiscard]] Expected<Points> dead_forces(const SceneSurface& surface, const SceneForce& force,
                                           double length);

}  // namespace knead
