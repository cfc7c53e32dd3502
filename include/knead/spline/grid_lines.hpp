#pragma once

#include <cstdint>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// Parameters of one direction of a grid that shows a surface: every span of positive length in equal pieces, so that
/// every knot line is a line of the grid.
struct GridLines {
  std::vector<double> parameters;         ///< ascending, ends of the domain included
  std::vector<std::uint32_t> knot_lines;  ///< which of them are knots, ends included
};

/// `detail` pieces over the domain, rounded up to as many in each span; two at least where the degree is above 1 and
/// one where it is 1, but no more than `most` in all where there are fewer spans than that.
/// Requires: detail >= 1 (asserted).
[[nodiscard]] GridLines grid_lines(const KnotVector& knots, int detail, int most = 400);

}  // namespace knead
