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

template <>
Expected<void> Executor::execute(const MaterialCommand& c);
void describe(MaterialCommand& c, Fields& fields);

}  // namespace knead
