#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "knead/energy/shell_energy.hpp"

namespace knead {
namespace {

Expected<double> positive(double value, const char* name) {
  if (std::isfinite(value) && value > 0) return value;
  return input_error(fmt::format("{} is not a {}", value, name), name, "use a finite number > 0");
}

}  // namespace

Expected<ShellMaterial> validated(const ShellMaterial& material) {
  if (auto ok = positive(material.young, "young"); !ok) return std::unexpected(ok.error());
  if (auto ok = positive(material.thickness, "thickness"); !ok) return std::unexpected(ok.error());
  if (!(material.poisson > -1 && material.poisson <= 0.5)) {
    return input_error(fmt::format("{} is not a Poisson's ratio", material.poisson), "poisson",
                       "use a number > -1 and <= 0.5");
  }
  if (!std::isfinite(material.density) || material.density < 0) {
    return input_error(fmt::format("{} is not a density", material.density), "density", "use a finite number >= 0");
  }
  return material;
}

Expected<FundamentalMaterial> validated_weights(const FundamentalMaterial& material) {
  for (const auto& [weights, name] : {std::pair(material.w1, "w1"), std::pair(material.w2, "w2")}) {
    for (const double w : weights) {
      if (!std::isfinite(w) || w < 0) {
        return input_error(fmt::format("{} is not a weight of a fundamental form", w), name, "use finite numbers >= 0");
      }
    }
  }
  return material;
}

}  // namespace knead
