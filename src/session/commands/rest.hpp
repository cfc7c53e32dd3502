#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Makes the present shape of the selected surfaces their rest shape, and says what the energy acts on.
struct RestCommand {
  RestMode mode = RestMode::shape;
};

inline constexpr Choice<RestMode> rest_modes[] = {{"shape", RestMode::shape}, {"none", RestMode::none}};

KNEAD_COMMAND(RestCommand, "rest", "make the present shape the rest shape; what the energy acts on") {
  v.choice("mode", c.mode, std::span<const Choice<RestMode>>(rest_modes),
           "shape: displacement from it; none: the shape itself");
}

}  // namespace knead
