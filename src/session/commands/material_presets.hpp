#pragma once

#include "material.hpp"

namespace knead {

/// What a material that has a name is.
struct Preset {
  Material material;
  double lambda;
  PlasticPolicy plastic;
};

[[nodiscard]] const Preset& preset_named(MaterialPreset name);

}  // namespace knead
