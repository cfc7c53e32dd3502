#pragma once

#include "knead/energy/domain_scaling.hpp"

namespace knead {

/// ∫ R_i (pressure n + (n·(wind − V)) n) dû over a surface, n = S_u × S_v normalised (zero where
/// undefined), by p + 1 Gauss points per span. `points` and `velocity` (may be empty) are control
/// points in normalised units.
[[nodiscard]] Expected<Points> normal_forces(const Surface& surface,
                                             const DomainScaling<2>& scaling, const Points& points,
                                             const Points& velocity, double pressure,
                                             const Point& wind);

}  // namespace knead
