#include <algorithm>
#include <limits>

#include "all.hpp"
#include "model_facets.hpp"

namespace knead {
namespace {

constexpr double from_the_edge = 1e-3;  // of the distance to the next grid line

/// Where the ray from a grid point starts: there, but on the outermost grid lines a little inside,
/// since what is behind an edge often ends at the ray.
Point start(const DisplayInput& input, Eigen::Index k) {
  const Points& points = input.evaluation.points();
  const auto rows = static_cast<Eigen::Index>(input.parameters[0].size()),
             columns = static_cast<Eigen::Index>(input.parameters[1].size());
  const Eigen::Index i = k / columns, j = k % columns;
  const auto inside = [](Eigen::Index line, Eigen::Index count) {
    if (line == 0) return std::min<Eigen::Index>(1, count - 1);
    return line == count - 1 ? line - 1 : line;
  };
  const Eigen::Index next = inside(i, rows) * columns + inside(j, columns);
  return ((1 - from_the_edge) * points.row(k) + from_the_edge * points.row(next)).transpose();
}

/// `ModelFacets::thickness` from every grid point against the outward normal; not a number where
/// that meets nothing.
Expected<std::vector<double>> thicknesses(const DisplayInput& input) {
  auto& facets = input.memory.facets;
  if (!facets) facets = std::make_shared<ModelFacets>();
  if (auto status = facets->refresh(input.scene, input.opened, input.around); !status) {
    return std::unexpected(status.error());
  }
  const double inwards = -facets->outward(input.surface);
  std::vector<double> result;
  for (Eigen::Index k = 0; k < input.normals.rows(); ++k) {
    result.push_back(
        facets
            ->thickness(input.surface, start(input, k), inwards * input.normals.row(k).transpose())
            .value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return result;
}

}  // namespace

/// Accuracy: triangles are within 2.5e-4 of the diagonal of the model of their surfaces, on grey
/// faces within 5e-4 of their radii, measured along the normal of the face that is met; the start
/// and its normal are exact, but at a pole the normal is that of the next grid point inside.
Display thickness_display() {
  return {.name = "thickness",
          .title = "Thickness",
          .unit = "length",
          .palette = DisplayPalette::rising,
          .help =
              "Distance to the next face of the model along the normal into the material: pale is "
              "thin. No colour where nothing is behind.",
          .sees_model = true,
          .values = thicknesses};
}

}  // namespace knead
