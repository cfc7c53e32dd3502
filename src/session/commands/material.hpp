#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Sets the stretch and bend coefficients of the selected surfaces, everywhere or in a region.
struct MaterialCommand {
  Material material;
  std::optional<double> mass, damping;
  std::optional<std::array<Fractions, 2>> region;  ///< [[s0, s1], [t0, t1]]
  double falloff = 0.1;                            ///< width of the way from old to new, in fractions
  /// One coefficient alone ("alpha11" … "beta22", "mass", "damping") by samples on a grid over the domain.
  std::optional<std::string> coefficient;
  std::array<int, 2> counts = {0, 0};
  std::vector<double> samples;  ///< last direction fastest, linear in between
};

KNEAD_COMMAND(MaterialCommand, "material", "resistance to stretch and bend, in the order 11, 12, 22") {
  v.field("alpha", Presence::optional, c.material.alpha, "stretch; alpha12² <= alpha11 alpha22");
  v.field("beta", Presence::optional, c.material.beta, "bend; none negative");
  v.field("mass", Presence::optional, c.mass, "per area, for `evolve` dynamic; default: as it was, at first 1");
  v.field("damping", Presence::optional, c.damping, "force per velocity and area; default: as it was, at first 0.5");
  v.field("region", Presence::optional, c.region, "[[s0, s1], [t0, t1]]: only there, in fractions of the domain");
  v.field("falloff", Presence::optional, c.falloff, "width of the border of the region, in fractions");
  v.field("coefficient", Presence::optional, c.coefficient,
          "alpha11, alpha12, alpha22, beta11, beta12, beta22, mass or damping: that one alone, by samples");
  v.field("counts", Presence::optional, c.counts, "[m, n] samples over the domain, at least 2 each");
  v.field("samples", Presence::optional, c.samples, "m n numbers, along v first; linear in between");
}

}  // namespace knead
