#include "knead/sculpt/tool.hpp"

#include <fmt/format.h>

#include <cmath>

namespace knead {

Expected<Tool> validated(const Tool& tool) {
  if (!tool.shape.centre.allFinite()) return input_error("a coordinate is not a finite number", "position");
  if (!std::isfinite(tool.shape.radius) || tool.shape.radius <= 0) {
    return input_error(fmt::format("{} is not a radius", tool.shape.radius), "radius", "use a number > 0");
  }
  if (!(tool.stiffness >= 0 && tool.stiffness <= max_tool_stiffness)) {
    return input_error(fmt::format("{} is not a stiffness", tool.stiffness), "stiffness",
                       fmt::format("use a number from 0 to {}", max_tool_stiffness));
  }
  if (!std::isfinite(tool.range) || (!tool.collides() && tool.range <= 0)) {
    return input_error(fmt::format("{} is not a range", tool.range), "range", "use a number > 0");
  }
  if (!std::isfinite(tool.friction) || tool.friction < 0) {
    return input_error(fmt::format("{} is not a friction coefficient", tool.friction), "friction",
                       "use a number >= 0");
  }
  if (!(tool.plasticity >= 0 && tool.plasticity <= 1)) {
    return input_error(fmt::format("{} is not a plasticity", tool.plasticity), "plasticity",
                       "use a number from 0 (springs back) to 1 (keeps its shape)");
  }
  return tool;
}

ToolAction tool_action(const Tool& tool, const Point& x) {
  ToolAction action;
  const Point offset = x - tool.shape.centre;
  const double distance = offset.norm(), phi = distance - tool.shape.radius, k = tool.stiffness;
  double slope = 0, curvature = 0;  // ψ'(φ) / φ and ψ''(φ)
  if (tool.collides()) {
    if (phi >= 0) return action;
    action.potential = 0.5 * k * phi * phi;
    action.entry = -phi;
    slope = curvature = k;
  } else {
    const double r2 = tool.range * tool.range, s = 1 - phi * phi / r2;
    if (s <= 0) return action;
    const double sign = tool.direction == ToolDirection::pull ? 1 : -1;
    action.potential = -sign * k * r2 / 6 * s * s * s;
    slope = sign * k * s * s;
    curvature = sign * k * s * (5 * s - 4);
  }
  if (distance == 0) return action;
  const Point n = offset / distance;
  action.active = true;
  action.normal = n;
  action.force = -slope * phi * n;
  action.hessian = (curvature - slope * phi / distance) * n * n.transpose();
  action.hessian.diagonal().array() += slope * phi / distance;
  return action;
}

Tool in_units(const Tool& tool, const Point& centre, double length) {
  Tool result = tool;
  result.shape.centre = (tool.shape.centre - centre) / length;
  result.shape.radius /= length;
  result.range /= length;
  return result;
}

}  // namespace knead
