#pragma once

#include "../shape_fields.hpp"

namespace knead {

/// Makes a surface in a document without a file, and selects it: a flat sheet, a surface of revolution about z, or any
/// control points.
struct NewCommand {
  std::string shape = "plane";
  std::optional<std::array<double, 2>> size;  ///< of a plane; default: [1, 1]
  std::optional<double> radius;               ///< of cylinder, sphere and torus; default: 0.5
  std::optional<double> height;               ///< of a cylinder; default: twice the radius
  std::optional<double> minor;                ///< tube radius of a torus; default: a quarter of the radius
  std::vector<Fractions> profile;             ///< of a revolution: control points (r, z)
  std::array<int, 2> degree = {3, 3};
  std::array<int, 2> net = {8, 8};
  std::vector<double> knots_u, knots_v;  ///< empty: clamped, uniform on [0, 1]
  std::vector<Vector3> points;           ///< instead of a shape: all control points, (i, j) at i n + j
  std::vector<double> weights;           ///< one for each; empty: none
  Vector3 position = {0, 0, 0};          ///< of the origin of the shape
  std::optional<std::string> unit;       ///< default: that of existing surfaces, else mm
  std::optional<std::string> name;       ///< default: its kind
};

template <>
Expected<void> Executor::execute(const NewCommand& c);
void describe(NewCommand& c, Fields& fields);

/// Version 1: programs wrote the size of a plane for every shape; elsewhere it is ignored.
void read_as_version_1(NewCommand& c);

/// The error for a measure that the shape of the command does not have; nothing for other fields.
[[nodiscard]] std::optional<Error> inapplicable(const NewCommand& c, std::string_view field);

}  // namespace knead
