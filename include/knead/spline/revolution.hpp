#pragma once

#include <array>

#include "knead/spline/spline.hpp"

namespace knead {

/// Quarters of a circle in the half plane of (r, z), as a rational quadratic (Piegl & Tiller, The
/// NURBS Book, 7.3): the points centre + radius (cos φ, sin φ) for φ from `first` · 90° over
/// `quarters` · 90°, exact except for the rounding of √½ and of the sums. Control points (r, 0, z),
/// knots 0 to 1, double where quarters meet. Requires: quarters >= 1 (asserted). Error: numbers
/// that are not finite.
[[nodiscard]] Expected<Curve> circle_quarters(std::array<double, 2> centre, double radius,
                                              int first, int quarters);

/// The surface that a profile sweeps in one turn about the z axis (The NURBS Book, 8.5): u runs
/// counterclockwise seen from above, from the half plane of x through that of y, degree 2, on four
/// quarters with the knots 0, ¼, ½, ¾, 1; v is the profile's parameter. Control points of the
/// profile are (r, 0, z); control point (i, j) is r_j times the i-th corner of the square of half
/// side 1, at the height z_j, and its weight that of the profile times 1 or √½. Every circle is
/// exact up to rounding. S_u × S_v points away from the axis where the profile rises. Error
/// (input): a control point off the plane y = 0.
[[nodiscard]] Expected<Surface> revolve(const Curve& profile);

}  // namespace knead
