#pragma once

#include <cstdint>
#include <vector>

#include "knead/spline/knot_vector.hpp"

namespace knead {

/// Parameters of one direction of a display grid of a surface: every span of positive length in equal pieces, so that
/// every knot line is a grid line.
struct GridLines {
  std::vector<double> parameters;         ///< ascending, ends of the domain included
  std::vector<std::uint32_t> knot_lines;  ///< which of them are knots, ends included
};

/// `detail` pieces over the domain, rounded up to the same number in each span; at least two where the degree is above
/// 1 and one where it is 1, but no more than `most` in all where there are fewer spans than that.
/// Requires: detail >= 1 (asserted).
[[nodiscard]] GridLines grid_lines(const KnotVector& knots, int detail, int most = 400);

}  // namespace knead
