#include <algorithm>

#include "all.hpp"

namespace knead {
namespace {

Expected<DomainScaling<2>> scaling_of(const DisplayInput& input) {
  auto& kept = input.memory.scalings;
  const EnergyScalingInput by = energy_scaling_input(input.scene, input.surface);
  for (const auto& [known, scaling] : kept) {
    if (known == by) return scaling;
  }
  constexpr std::size_t most_kept = 64;
  if (kept.size() == most_kept) kept.erase(kept.begin());
  kept.emplace_back(by, energy_scaling(by));
  return kept.back().second;
}

/// `energy_density`; 0 for the shape as opened, which is at rest, and for a surface without area.
Expected<std::vector<double>> energy_densities(const DisplayInput& input) {
  const auto none = [&] {
    return std::vector<double>(static_cast<std::size_t>(input.normals.rows()), 0.0);
  };
  if (input.opened) return none();
  const auto scaling = scaling_of(input);
  if (!scaling) return none();
  return energy_density(input.scene.surfaces[static_cast<std::size_t>(input.surface)], *scaling,
                        {input.parameters[0], input.parameters[1]}, input.tables);
}

}  // namespace

Display energy_display() {
  return {
      .name = "energy",
      .title = "Energy density",
      .unit = "normalised",
      .palette = DisplayPalette::rising,
      .help = "Where stretch and bend store the energy of the displacement from the rest shape.",
      .percentiles = {0, 1},
      .values = energy_densities};
}

}  // namespace knead
