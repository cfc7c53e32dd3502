#include "turn.hpp"

#include <numbers>

#include "session/acts/selection.hpp"

namespace knead {

void describe(TurnCommand& c, Fields& fields) {
  fields.name("turn", "turn a tool about its centre");
  fields.add("tool", c.tool, {.help = "its name", .fallback = "the only tool"});
  fields.add("axis", c.axis, {.help = "direction of the axis, in space"});
  fields.add("angle", c.angle,
             {.help = "in degrees, counterclockwise when the axis points at the viewer",
              .unit = Unit::angle,
              .presence = Presence::required});
}

Expected<void> execute(const TurnCommand& c, Act& act) {
  auto tool = find_tool(act, c.tool);
  if (!tool) return std::unexpected(tool.error());
  const Point axis(c.axis[0], c.axis[1], c.axis[2]);
  if (!(axis.norm() > 0))
    return input_error("the axis has no direction", "axis", "use a vector that is not zero");
  const Placement& at = (*tool)->shape.placement();
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(c.angle * std::numbers::pi / 180, axis.normalized()));
  auto turned = (*tool)->shape.moved((turn * at.rotation).normalized(), at.position);
  if (!turned) return std::unexpected(turned.error());
  (*tool)->shape = std::move(*turned);
  return {};
}

}  // namespace knead
