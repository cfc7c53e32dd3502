#include "energy_density.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"

namespace knead {

EnergyScalingInput energy_scaling_input(const Scene& scene, int surface) {
  EnergyScalingInput input{scene.surfaces[static_cast<std::size_t>(surface)].reference, nullptr,
                           scene.scaling};
  if (std::ranges::find(scene.together, surface) != scene.together.end()) {
    input.first = scene.surfaces[static_cast<std::size_t>(*scene.selected)].reference;
  }
  return input;
}

Expected<DomainScaling<2>> energy_scaling(const EnergyScalingInput& input) {
  if (input.mode == ScalingMode::raw) return DomainScaling<2>{};
  auto scaling = normalised_scaling<2>(*input.reference);
  if (!scaling || !input.first) return scaling;
  const auto first = normalised_scaling<2>(*input.first);
  if (!first) return first;
  return in_unit<2>(*scaling, first->length);
}

Expected<std::vector<double>> energy_density(
    const SceneSurface& surface, const DomainScaling<2>& scaling,
    const std::array<std::span<const double>, 2>& parameters,
    const std::array<const BasisTable*, 2>& tables) {
  // The displacement is a spline on the same basis.
  auto field = surface.mode == RestMode::none
                   ? Expected<Surface>(*surface.current)
                   : surface.current->with_control_points(surface.current->control_points() -
                                                          surface.rest->control_points());
  if (!field) return std::unexpected(field.error());
  const auto jet = evaluate_grid<2>(*field, tables, 2);
  if (!jet) return std::unexpected(jet.error());
  std::vector<double> density(static_cast<std::size_t>(jet->points().rows()), 0.0);
  const double unit = 1 / (scaling.length * scaling.length);
  FieldEnergy<2> terms = stretch_energy(surface.material);
  const FieldEnergy<2> bend = bend_energy(surface.material);
  terms.insert(terms.end(), bend.begin(), bend.end());
  for (const FieldTerm<2>& term : terms) {
    double factor = term.factor * unit;
    for (std::size_t d = 0; d < 2; ++d)
      factor *= std::pow(scaling.factors[d], -(term.a[d] + term.b[d]));
    const Points &a = jet->at(term.a), &b = jet->at(term.b);
    if (const double* constant = std::get_if<double>(&term.coefficient)) {
      for (std::size_t k = 0; k < density.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        density[k] += factor * *constant * a.row(row).dot(b.row(row));
      }
      continue;
    }
    const auto values = std::get<SplineField<2>>(term.coefficient).on_grid(parameters);
    if (!values) return std::unexpected(values.error());
    for (std::size_t k = 0; k < density.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      density[k] += factor * (*values)[k] * a.row(row).dot(b.row(row));
    }
  }
  return density;
}

}  // namespace knead
