#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "knead/spline/knot_vector.hpp"

namespace knead::step {

/// A knot vector as STEP lists it: distinct values and their multiplicities.
struct PrintedKnots {
  std::string multiplicities;  ///< "(4,1,4)"
  std::string values;          ///< "(0.,0.5,1.)"
};

/// \param number the text of a knot
[[nodiscard]] PrintedKnots print_knots(const KnotVector& knots, const std::function<std::string(double)>& number);

/// "((a,b),(c,d))": entry k = i · columns + j is item(k); every row after the first on its own line if the file has
/// line breaks.
[[nodiscard]] std::string print_net(int rows, int columns, const std::function<std::string(int)>& item,
                                    std::string_view line_break);

/// A CARTESIAN_POINT record, without a line break.
[[nodiscard]] std::string print_point(std::string_view name, const double* coordinates);

}  // namespace knead::step
