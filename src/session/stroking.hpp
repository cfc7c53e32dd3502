#pragma once

#include <span>
#include <string>
#include <vector>

#include "act.hpp"
#include "sculpt/travelled.hpp"

namespace knead {

inline constexpr std::size_t pure_terms[] = {0, 2};  // α11 and α22, β11 and β22

// Strokes of a tool that leave their groove as they go.

/// Puts a tool down to leave `share` of what the material lets stay, all along the way.
[[nodiscard]] Expected<void> begin_stroke(Act& act, const std::string& name, double share);
/// Leads the tool of the open stroke on, and shows the shapes under it.
[[nodiscard]] Expected<void> stroke_to(Act& act, const std::vector<Point>& points);
/// Ends the open stroke, where there is one: the tool goes home, and what stays is the shape and the rest shape.
[[nodiscard]] Expected<void> lift(Act& act);
/// Shows the open stroke with edges that follow closed, and as smooth as asked.
[[nodiscard]] Expected<void> show_stroke(Act& act, bool down);

/// Makes the model that the open stroke presses, unless it is there.
[[nodiscard]] Expected<void> prepare_stroke_model(Act& act);
/// What these tools ask, which are there after these travels, of the shapes from before the stroke: a displacement.
[[nodiscard]] Expected<ActiveStep> press(Act& act, std::vector<Tool> tools, std::span<const Travel> travels);

}  // namespace knead
