#include "knead/spline/grid_lines.hpp"

#include <algorithm>
#include <cassert>

namespace knead {

GridLines grid_lines(const KnotVector& knots, int detail, int most) {
  assert(detail >= 1);
  const std::vector<int> spans = knots.spans();
  const int count = static_cast<int>(spans.size()), least = knots.degree() == 1 ? 1 : 2;
  const int wanted = knots.degree() == 1 ? 1 : (detail - 1) / count + 1;
  const int pieces = std::clamp(wanted, least, std::max(least, most / count));
  GridLines lines;
  for (int s : spans) {
    lines.knot_lines.push_back(static_cast<std::uint32_t>(lines.parameters.size()));
    for (int k = 0; k < pieces; ++k) lines.parameters.push_back(knots[s] + (knots[s + 1] - knots[s]) * k / pieces);
  }
  lines.knot_lines.push_back(static_cast<std::uint32_t>(lines.parameters.size()));
  lines.parameters.push_back(knots.domain().upper);
  return lines;
}

}  // namespace knead
