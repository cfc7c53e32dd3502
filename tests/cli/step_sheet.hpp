#pragma once

#include <string>

#include "knead/spline/spline.hpp"

namespace knead::testing {

/// Id of the surface in `step_sheet`.
inline constexpr const char* sheet_id = "#10";

/// A STEP file with this one surface, coordinates to 17 significant digits, polynomial or as the
/// rational complex instance. Every control point has a point of its own.
[[nodiscard]] std::string step_sheet(const Surface& surface,
                                     const std::string& unit_prefix = ".MILLI.");

}  // namespace knead::testing
