#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Makes a surface in a document without a file, and selects it: a flat sheet, a surface of revolution about z, or any
/// control points.
struct NewCommand {
  std::string shape = "plane";
  std::array<double, 2> size = {1, 1};
  std::optional<double> radius;    ///< of cylinder, sphere and torus; default: 0.5
  std::optional<double> height;    ///< of a cylinder; default: twice the radius
  std::optional<double> minor;     ///< tube radius of a torus; default: a quarter of the radius
  std::vector<Fractions> profile;  ///< of a revolution: control points (r, z)
  std::array<int, 2> degree = {3, 3};
  std::array<int, 2> net = {8, 8};
  std::vector<double> knots_u, knots_v;  ///< empty: clamped, uniform on [0, 1]
  std::vector<Vector3> points;           ///< instead of a shape: all control points, (i, j) at i n + j
  std::vector<double> weights;           ///< one for each; empty: none
  Vector3 position = {0, 0, 0};          ///< where the origin of the shape goes
  std::optional<std::string> unit;       ///< default: that of the surfaces there are, at first mm
  std::optional<std::string> name;       ///< default: what it is
};

KNEAD_COMMAND(NewCommand, "new", "make a surface, in a document without a file, and select it") {
  v.field("shape", Presence::optional, c.shape, "plane, cylinder, sphere, torus or revolution; about z");
  v.field("size", Presence::optional, c.size, "of a plane: [width, height]");
  v.field("radius", Presence::optional, c.radius, "of cylinder, sphere and torus; default: 0.5");
  v.field("height", Presence::optional, c.height, "of a cylinder; default: twice the radius");
  v.field("minor", Presence::optional, c.minor, "tube radius of a torus; default: a quarter of the radius");
  v.field("profile", Presence::optional, c.profile, "of a revolution: [[r, z], …], control points of degree q");
  v.field("degree", Presence::optional, c.degree, "[p, q]");
  v.field("net", Presence::optional, c.net, "control points [m, n]; with knots they follow from those");
  v.field("knots_u", Presence::optional, c.knots_u, "knot vector of u; default: clamped, uniform on [0, 1]");
  v.field("knots_v", Presence::optional, c.knots_v, "knot vector of v");
  v.field("points", Presence::optional, c.points, "instead of a shape: all control points [x, y, z], along v first");
  v.field("weights", Presence::optional, c.weights, "one > 0 for each control point (of a revolution: of the profile)");
  v.field("position", Presence::optional, c.position, "[x, y, z] where the shape's origin goes");
  v.field("unit", Presence::optional, c.unit, "um, mm, cm, m, km, inch or foot; default: as before, at first mm");
  v.field("name", Presence::optional, c.name, "its label in the file; default: what it is");
}

}  // namespace knead
