#include <cmath>
#include <limits>

#include "all.hpp"

namespace knead {
namespace {

Expected<std::vector<double>> gaps(const DisplayInput& input) {
  const Points& points = input.evaluation.points();
  std::vector<double> result;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (const Tool& tool : input.scene.tools) {
      least = std::min(least, tool.shape.nearest(points.row(k).transpose()).distance);
    }
    result.push_back(std::isfinite(least) ? least : 0);
  }
  return result;
}

}  // namespace

Display gap_display() {
  return {.name = "gap",
          .title = "Distance to tools",
          .unit = "length",
          .is_signed = true,
          .help = "Distance to the nearest tool; blue is inside it.",
          .percentiles = {0, 1},
          .share = 0.1,  // the relevant values are near the tools
          .values = gaps};
}

}  // namespace knead
