#pragma once

#include "knead/spline/spline.hpp"

namespace knead {

/// A shape on the net of another one, whose degrees are these or more, as are its knots then. By
/// degree elevation and knot insertion, which are exact: control points of both can be compared one
/// by one. Errors: those of `elevate_degree` and `insert_knots`.
[[nodiscard]] Expected<Surface> onto_net(Surface shape, const Surface& like);

}  // namespace knead
