#pragma once

#include <string>

#include "knead/spline/spline.hpp"

namespace knead {

/// A sphere: the shape of a tool.
struct Sphere {
  Point centre = Point::Zero();
  double radius = 1;

  friend bool operator==(const Sphere&, const Sphere&) = default;
};

/// How a tool acts on the surface (thesis 4.3 and 6.4).
enum class ToolMode {
  proximity,  ///< the surface is drawn to the tool's surface from either side, within `range`
  collision,  ///< what has entered the tool is pushed out; nothing else is touched
};

/// A shaped tool: Hookean springs between the surface and the tool (thesis Eq. 4.25).
struct Tool {
  std::string name = "tool";
  Sphere shape;
  ToolMode mode = ToolMode::collision;
  double stiffness = 1e4;  ///< k: force per length and parameter area
  double range = 0.5;      ///< proximity: no force at this distance and beyond; unused by collision

  friend bool operator==(const Tool&, const Tool&) = default;
};

/// Beyond this, the rounding of positions alone makes forces larger than those of the material: the entry into a tool
/// is then less than 1e-9 of the surface's size anyway.
inline constexpr double max_tool_stiffness = 1e10;

/// Checks radius > 0, stiffness from 0 to the maximum, range > 0 where it is used, all finite; the error names the
/// field.
[[nodiscard]] Expected<Tool> validated(const Tool& tool);

/// What a tool does to one point x: a potential ψ(x), the force −∇ψ of its springs, and the Hessian
/// ∂²ψ = normal · n nᵀ + tangential · (I − n nᵀ), which need not be positive: a surface pressed against a ball is
/// pushed sideways off its top.
///
/// With φ the signed distance of x to the tool (negative inside) and n its gradient:
/// collision  ψ = k/2 min(φ, 0)², force −k φ n inside;
/// proximity  ψ = −k r²/6 (1 − φ²/r²)³ within the range r, force −k φ (1 − φ²/r²)² n, which is k φ near the tool and
///            falls to zero with two derivatives at the range's end.
/// At the very centre of a sphere no direction is nearest and the force is zero.
struct ToolAction {
  double potential = 0;
  Point force = Point::Zero();
  double normal = 0, tangential = 0;  ///< ψ''(φ) and ψ'(φ) / |x − centre|
  Point direction = Point::Zero();    ///< n; zero where the tool does not act

  [[nodiscard]] bool active() const { return normal != 0 || tangential != 0; }
};

[[nodiscard]] ToolAction tool_action(const Tool& tool, const Point& x);

}  // namespace knead
