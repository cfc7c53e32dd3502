#include "knead/energy/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {

Expected<Material> validated(const Material& material) {
  static constexpr const char* suffix[] = {"11", "12", "22"};
  const auto& [a11, a12, a22] = material.alpha;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!std::isfinite(material.alpha[k])) {
      return input_error("the coefficient is not a finite number", fmt::format("alpha{}", suffix[k]));
    }
    if (!std::isfinite(material.beta[k])) {
      return input_error("the coefficient is not a finite number", fmt::format("beta{}", suffix[k]));
    }
    if (material.beta[k] < 0) {
      return input_error(fmt::format("{} is negative, so the energy has no minimum", material.beta[k]),
                         fmt::format("beta{}", suffix[k]), "use a value >= 0");
    }
    if (k != 1 && material.alpha[k] < 0) {
      return input_error(fmt::format("{} is negative, so the energy has no minimum", material.alpha[k]),
                         fmt::format("alpha{}", suffix[k]), "use a value >= 0");
    }
  }
  if (a12 * a12 > a11 * a22) {
    return input_error(fmt::format("{}² exceeds alpha11 alpha22 = {}, so the energy has no minimum", a12, a11 * a22),
                       "alpha12", "use |alpha12| <= sqrt(alpha11 alpha22)");
  }
  return material;
}

}  // namespace knead
