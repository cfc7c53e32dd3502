#pragma once

#include "../shape_fields.hpp"

namespace knead {

/// What a new curve or volume is, unless its control points are given.
enum class BodyForm { line, circle, helix, box, cylinder };

std::span<const Choice> choices(BodyForm);

/// Makes a surface, a curve or a volume in a document without a file, and selects it: a flat sheet,
/// a surface of revolution about z, a line, a box, and the like, or any control points.
struct NewCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::string shape = "plane";
  std::optional<BodyForm> form;  ///< of curves and volumes; default: line, box
  std::optional<std::vector<double>>
      size;  ///< of a plane, a line and a box; default: 1; one number stands for all
  std::optional<double> radius;    ///< of what is round; default: 0.5
  std::optional<double> height;    ///< of a cylinder; default: twice the radius; of a helix: 1
  std::optional<double> minor;     ///< tube radius of a torus; default: a quarter of the radius
  std::optional<double> turns;     ///< of a helix; default: 3
  std::vector<Fractions> profile;  ///< of a revolution: control points (r, z)
  /// In each direction; one number stands for all.
  std::vector<int> degree = {3}, net = {8};
  std::vector<double> knots_u, knots_v;        ///< empty: clamped, uniform on [0, 1]
  std::optional<std::vector<double>> knots_w;  ///< of a volume
  /// Instead of a shape: all control points, (i, j) at i n + j; the last direction is fastest.
  std::vector<Vector3> points;
  std::vector<double> weights;      ///< one for each; empty: none
  Vector3 position = {0, 0, 0};     ///< of the origin of the shape
  std::optional<std::string> unit;  ///< default: that of existing surfaces, else mm
  std::optional<std::string> name;  ///< default: its kind
};

/// The number of one direction in a list in which one number stands for all directions.
[[nodiscard]] inline int in_direction(const std::vector<int>& list, std::size_t d) {
  return list.size() == 1 ? list[0] : list[d];
}

Expected<void> execute(const NewCommand& c, Act& act);
void describe(NewCommand& c, Fields& fields);

}  // namespace knead
