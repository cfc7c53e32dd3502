#include <cmath>

#include "all.hpp"

namespace knead {
namespace {

/// |S − S_opened| with the sign of (S − S_opened)·n.
Expected<std::vector<double>> deviations(const DisplayInput& input) {
  const SceneSurface& surface = input.scene.surfaces[static_cast<std::size_t>(input.surface)];
  const Surface& opened = *surface.opened;
  const Surface& drawn = input.opened ? opened : *surface.current;
  // If its knots have been edited since: its own basis at the same parameters.
  const auto before = opened.knots() == drawn.knots()
                          ? evaluate_grid<2>(opened, input.tables)
                          : evaluate_grid<2>(opened, {input.parameters[0], input.parameters[1]});
  if (!before) return std::unexpected(before.error());
  const Points moved = input.evaluation.points() - before->points();
  std::vector<double> result;
  for (Eigen::Index k = 0; k < moved.rows(); ++k) {
    result.push_back(std::copysign(moved.row(k).norm(), moved.row(k).dot(input.normals.row(k))));
  }
  return result;
}

}  // namespace

Display deviation_display() {
  return {.name = "deviation",
          .title = "Deviation",
          .unit = "length",
          .is_signed = true,
          .help =
              "How far each point is from where it was when opened: red along the normal, blue "
              "against it. Hold C to see it as opened.",
          .percentiles = {0, 1},  // what moved may be a small part
          .tolerance = "tolerance",
          .compares = true,
          .settings = {{.name = "tolerance",
                        .title = "Tolerance",
                        .unit = "length",
                        .value = {0},
                        .help = "Deviations up to this have the neutral colour"}},
          .values = deviations};
}

}  // namespace knead
