#pragma once

#include <array>
#include <vector>

#include "knead/energy/domain_scaling.hpp"
#include "knead/spline/basis.hpp"
#include "scene.hpp"

namespace knead {

/// What the energy units of a surface depend on: equal inputs give equal units.
struct EnergyScalingInput {
  std::shared_ptr<const Surface> reference;
  std::shared_ptr<const Surface>
      first;  ///< of the first selected surface, if selected with others; else null
  ScalingMode mode = ScalingMode::normalised;

  friend bool operator==(const EnergyScalingInput&, const EnergyScalingInput&) = default;
};

[[nodiscard]] EnergyScalingInput energy_scaling_input(const Scene& scene, int surface);

/// The units in which the energy of one surface is computed in this scene: raw ones, or the
/// normalised ones of its reference shape, with the length of the first selected surface if
/// selected with others. Errors (numerical): a shape without area.
[[nodiscard]] Expected<DomainScaling<2>> energy_scaling(const EnergyScalingInput& input);

/// The integrand of the energy (thesis Eq. 4.8) on a grid of parameters, v fastest:
///
///   α11 |X_û|² + 2 α12 X_û·X_v̂ + α22 |X_v̂|² + β11 |X_ûû|² + 2 β12 |X_ûv̂|² + β22 |X_v̂v̂|²,
///
/// X = (S − S_rest) / length, or S / length where the energy acts on the shape itself, and (û, v̂)
/// the parameters times the factors of the scaling: the integrand over dû dv̂ = factors[0]
/// factors[1] du dv. Its integral over the domain is the energy that `Session::energy` and a step
/// report for a surface selected alone. Units: of that energy, per area of the scaled parameter
/// domain, whose area is near 1. Non-negative up to rounding. `tables` tabulate the basis of the
/// surface at `parameters` to order 2. Cost: two grid evaluations. Errors: a rational denominator
/// that is not positive (numerical).
[[nodiscard]] Expected<std::vector<double>> energy_density(
    const SceneSurface& surface, const DomainScaling<2>& scaling,
    const std::array<std::span<const double>, 2>& parameters,
    const std::array<const BasisTable*, 2>& tables);

}  // namespace knead
