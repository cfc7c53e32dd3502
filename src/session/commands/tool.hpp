#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Puts a tool into the scene, or replaces the one of that name.
struct ToolCommand {
  std::string name = "tool";
  std::string shape = "sphere";
  std::optional<double> radius;  ///< default: a tenth of the surface's bounding-box diagonal
  std::optional<double> minor, height, rounding, thickness, top_radius;
  std::optional<Vector3> sizes;  ///< semi-axes or half sizes
  std::optional<std::array<double, 2>> exponents;
  std::optional<std::string> surface;  ///< of shape "surface": its id
  std::optional<Vector3> axis;         ///< where the tool's own z points
  std::optional<Vector3> scale;        ///< along its own axes
  std::optional<Vector3> position;     ///< of the centre; or:
  std::optional<Fractions> at;         ///< centre on the surface
  ToolMode mode = ToolMode::collision;
  std::optional<double> stiffness;  ///< default: 1e4 for collision, 100 for proximity
  std::optional<double> range;      ///< default: half the size
  ToolDirection direction = ToolDirection::pull;
  bool rigid = false;
  double friction = 0;
  double plasticity = 0;
  bool relative = false;  ///< lengths and position are fractions of the bounding-box diagonal
};

inline constexpr Choice<ToolMode> tool_modes[] = {
    {"collision", ToolMode::collision}, {"proximity", ToolMode::proximity}, {"imprint", ToolMode::imprint}};

inline constexpr Choice<ToolDirection> tool_directions[] = {{"pull", ToolDirection::pull},
                                                            {"push", ToolDirection::push}};

KNEAD_COMMAND(ToolCommand, "tool", "put a tool into the scene, or replace the one of that name") {
  v.field("name", Presence::optional, c.name, "what `move` and `remove` call it");
  v.field("shape", Presence::optional, c.shape,
          "sphere, ellipsoid, box, cylinder, cone, capsule, torus, plane, bowl, superellipsoid, supertoroid, surface");
  v.field("radius", Presence::optional, c.radius, "length; default: 0.1 of the surface's bounding-box diagonal");
  v.field("minor", Presence::optional, c.minor, "tube radius of torus and supertoroid; default: a quarter of radius");
  v.field("height", Presence::optional, c.height, "of cylinder, cone and capsule; default: twice the radius");
  v.field("top_radius", Presence::optional, c.top_radius, "of a cone; default: 0");
  v.field("thickness", Presence::optional, c.thickness, "wall of a bowl; default: a tenth of the radius");
  v.field("rounding", Presence::optional, c.rounding, "edge radius of a box; default: 0");
  v.field("sizes", Presence::optional, c.sizes, "[a, b, c] semi-axes or half sizes; default: radius each");
  v.field("exponents", Presence::optional, c.exponents, "[e1, e2] of superellipsoid and supertoroid; default: [1, 1]");
  v.field("surface", Presence::optional, c.surface, "id of the surface that is the tool");
  v.field("axis", Presence::optional, c.axis, "[x, y, z] where its own z axis points; default: [0, 0, 1]");
  v.field("scale", Presence::optional, c.scale, "[a, b, c] factors along its own axes; default: 1 each");
  v.field("position", Presence::optional, c.position, "[x, y, z] of the centre; this or `at` is needed");
  v.field("at", Presence::optional, c.at, "[s, t]: centre on the surface, at fractions 0 to 1 of its domain");
  v.choice("mode", c.mode, std::span<const Choice<ToolMode>>(tool_modes),
           "collision pushes out what has entered; proximity draws near; imprint presses for good");
  v.field("stiffness", Presence::optional, c.stiffness,
          "spring constant k >= 0; default: 1e4 for collision, 100 for proximity");
  v.field("range", Presence::optional, c.range, "reach of proximity, a length; default: half the size");
  v.choice("direction", c.direction, std::span<const Choice<ToolDirection>>(tool_directions), "of proximity");
  v.field("rigid", Presence::optional, c.rigid, "raise k until nothing enters by more than 1e-4 of the tool's size");
  v.field("friction", Presence::optional, c.friction, "Coulomb's coefficient");
  v.field("plasticity", Presence::optional, c.plasticity, "0 springs back on `remove`, 1 keeps the shape");
  v.field("relative", Presence::optional, c.relative,
          "lengths and position are fractions of the surface's bounding-box diagonal");
}

}  // namespace knead
