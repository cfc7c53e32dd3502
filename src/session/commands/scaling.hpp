#pragma once

#include "../command_fields.hpp"

namespace knead {

struct ScalingCommand {
  ScalingMode mode = ScalingMode::normalised;
};

inline constexpr Choice<ScalingMode> scaling_modes[] = {{"normalised", ScalingMode::normalised},
                                                        {"raw", ScalingMode::raw}};

KNEAD_COMMAND(ScalingCommand, "scaling", "the units that the numbers are in") {
  v.choice("mode", c.mode, std::span<const Choice<ScalingMode>>(scaling_modes),
           "normalised: the same feel at every size; raw: those of the equations on the knots as they are");
}

}  // namespace knead
