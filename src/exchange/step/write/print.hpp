#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "knead/spline/spline.hpp"

namespace knead::step {

/// A knot vector as STEP lists it: distinct values and their multiplicities.
struct PrintedKnots {
  std::string multiplicities;  ///< "(4,1,4)"
  std::string values;          ///< "(0.,0.5,1.)"
};

/// \param number the text of a knot
[[nodiscard]] PrintedKnots print_knots(const KnotVector& knots,
                                       const std::function<std::string(double)>& number);

/// "((a,b),(c,d))": entry k = i · columns + j is item(k); every row after the first on its own line
/// if the file has line breaks.
[[nodiscard]] std::string print_net(int rows, int columns,
                                    const std::function<std::string(int)>& item,
                                    std::string_view line_break);

/// A CARTESIAN_POINT record, without a line break.
[[nodiscard]] std::string print_point(std::string_view name, const double* coordinates);

/// The record of a B_SPLINE_SURFACE_WITH_KNOTS without its name, complex if it has weights; the
/// form is .UNSPECIFIED., the closed flags are those of `closed_directions`. \param label a string
/// literal with its quotes \param point the name of the record of control point k
[[nodiscard]] std::string print_surface(const Surface& surface, std::string_view label,
                                        const std::function<std::string(int)>& point,
                                        std::string_view line_break);

/// The record of a B_SPLINE_CURVE_WITH_KNOTS without its name, likewise; it is closed if it is
/// clamped and its first and last control points are the same.
[[nodiscard]] std::string print_curve(const Curve& curve, std::string_view label,
                                      const std::function<std::string(int)>& point);

/// Adds a record and returns its name.
using AddRecord = std::function<std::string(const std::string&)>;

}  // namespace knead::step
