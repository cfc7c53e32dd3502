#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "entity.hpp"
#include "knead/brep/model.hpp"

namespace knead::step {

/// None if the axis has zero length, or the reference direction is along it.
[[nodiscard]] std::optional<brep::Frame> frame_of(const brep::AxisPlacement& placement);

/// A SURFACE_CURVE or one of its subtypes; a PCURVE, bounded or not.
[[nodiscard]] bool is_surface_curve(const Reader& reader, std::uint32_t instance);
[[nodiscard]] bool is_parameter_curve(const Reader& reader, std::uint32_t instance);

/// A curve in space: LINE, CIRCLE, ELLIPSE, HYPERBOLA, PARABOLA, POLYLINE and B-spline curves;
/// TRIMMED_CURVE, and SURFACE_CURVE with its subtypes, by their underlying curve. Errors (input):
/// the entity is of another type, or incomplete.
[[nodiscard]] Expected<brep::CurveGeometry> read_curve(const Reader& reader,
                                                       std::uint32_t instance);

/// Fills the form of a surface that is no B-spline: PLANE, CYLINDRICAL_, CONICAL_, SPHERICAL_,
/// TOROIDAL_ and DEGENERATE_TOROIDAL_SURFACE, SURFACE_OF_REVOLUTION, SURFACE_OF_LINEAR_EXTRUSION.
/// Others stay without one; `wrong` says what cannot be read.
void read_form(const Reader& reader, std::uint32_t instance, brep::Support& support);

/// The radians of every plane angle unit that a file assigns; 1 (radians) if it assigns none.
[[nodiscard]] std::vector<double> plane_angle_units(const Reader& reader);

}  // namespace knead::step
