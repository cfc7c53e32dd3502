#include "scene/mask.hpp"

#include "all.hpp"

namespace knead {
namespace {

/// Σ R m of the weights m of the control points; 0 without a mask.
Expected<std::vector<double>> mask_values(const DisplayInput& input) {
  const SceneSurface& s = input.scene.surfaces[static_cast<std::size_t>(input.surface)];
  const auto count = static_cast<std::size_t>(input.normals.rows());
  if (s.mask.empty()) return std::vector<double>(count, 0);
  const auto field = mask_field(s);
  if (!field) return std::unexpected(field.error());
  const auto& [us, vs] = input.parameters;
  const auto values =
      evaluate_grid<2>(*field, {std::span<const double>(us), std::span<const double>(vs)}, 0);
  if (!values) return std::unexpected(values.error());
  const Points& m = values->points();
  std::vector<double> result(count);
  for (std::size_t k = 0; k < count; ++k) result[k] = m(static_cast<Eigen::Index>(k), 0);
  return result;
}

}  // namespace

Display mask_display() {
  return {.name = "mask",
          .title = "Mask",
          .unit = "share",
          .palette = DisplayPalette::rising,
          .help = "What brushes and strokes leave alone: nothing moves where it is 1.",
          .limits = {{0, 1}},
          .values = mask_values};
}

}  // namespace knead
