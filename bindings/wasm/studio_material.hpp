#pragma once

#include <array>
#include <string>
#include <vector>

#include "knead/energy/material_field.hpp"
#include "knead/spline/spline.hpp"

namespace knead::studio {

/// The coefficients of a material as values on a grid over the domain, v fastest.
struct MaterialSamples {
  std::array<std::vector<double>, 3> alpha, beta;  ///< 11, 12, 22
};

/// counts[0] × counts[1] values of each coefficient, ends of the domain included.
/// Errors (usage): a count below 2 or above 1000.
[[nodiscard]] Expected<MaterialSamples> material_samples(const MaterialFieldOf<2>& material, const Surface& domain_of,
                                                         std::array<int, 2> counts);

/// {"buffers": {"alpha11": …, "alpha12", …, "beta22"}}
[[nodiscard]] std::string material_json(const MaterialSamples& samples);

}  // namespace knead::studio
