#pragma once

#include "../command_fields.hpp"

namespace knead {

enum class EdgeCondition { position, clamped, curvature, free };
/// Holds edges, with the first or the first two derivatives across them.
struct EdgeCommand {
  EdgeChoice which = EdgeChoice::all;
  EdgeCondition hold = EdgeCondition::position;
};

inline constexpr Choice<EdgeCondition> edge_conditions[] = {{"position", EdgeCondition::position},
                                                            {"clamped", EdgeCondition::clamped},
                                                            {"curvature", EdgeCondition::curvature},
                                                            {"free", EdgeCondition::free}};

KNEAD_COMMAND(EdgeCommand, "edge", "hold edges of the selected surfaces") {
  v.choice("which", c.which, std::span<const Choice<EdgeChoice>>(edge_choices), "");
  v.choice("hold", c.hold, std::span<const Choice<EdgeCondition>>(edge_conditions),
           "clamped: with tangent planes; curvature: with curvatures too; free: no longer");
}

}  // namespace knead
