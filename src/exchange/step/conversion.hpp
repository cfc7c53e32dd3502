#pragma once

#include <span>
#include <string>

#include "file.hpp"

namespace knead::step {

/// The file with these surfaces, each given by its id or that of a face on it, replaced by their
/// `exact_spline`, and every other byte as it was.
///
/// The record of the surface is rewritten under its name, and its control points follow it; all
/// faces on it refer to it as they did. What else describes geometry on it (PCURVE,
/// RECTANGULAR_TRIMMED_SURFACE, CURVE_BOUNDED_SURFACE, OFFSET_SURFACE, SURFACE_REPLICA) refers to a
/// copy of the old record under a new name. Edges of these faces lose their PCURVEs on it, since
/// the parameters have changed: a SURFACE_CURVE or INTERSECTION_CURVE keeps the others, and where
/// none is left, or on a seam, the edge refers to the curve in space. A surface that stands for
/// itself, bounded by curves or parameters, is a face here: its SURFACE_CURVEs refer to the spline
/// in place of their PCURVEs, boundaries that are PCURVEs alone get a SURFACE_CURVE, and a
/// RECTANGULAR_TRIMMED_SURFACE the limits that are the same on the spline. Errors: those of
/// `exact_spline`; the result does not read back to the same bits (numerical).
[[nodiscard]] Expected<File> with_splines(const File& file, std::span<const std::string> surfaces);

}  // namespace knead::step
