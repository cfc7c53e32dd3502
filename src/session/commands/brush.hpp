#pragma once

#include "../command_fields.hpp"

namespace knead {

std::span<const Choice> choices(BrushKind);
std::span<const Choice> choices(PressureUse);

/// A point and a direction: of a plane its normal, of an axis its way.
using PointAndDirection = std::array<Vector3, 2>;

/// Leads a brush over the surface.
struct BrushCommand {
  BrushKind kind = BrushKind::push;
  std::vector<Fractions> path;
  std::optional<std::string> surface;  ///< on which the path lies; default: the first selected one
  std::vector<std::string>
      surfaces;  ///< of each point of the path, where it leads over several; empty: `surface`
  std::vector<double> pressure;  ///< of a pen at each point of the path; empty: 1
  std::vector<Vector3> tilt;     ///< its axis there; empty: the normal
  PressureUse presses = PressureUse::depth;
  std::optional<double> radius;    ///< default: a tenth of the diagonal
  std::optional<double> height;    ///< default: a quarter of the radius
  std::optional<double> strength;  ///< default: 1, of pinch 0.5
  std::optional<double> core;      ///< default: 0, of flatten, mask and unmask 0.5, of stamp 0.75
  std::optional<Vector3> by;       ///< of grab
  std::optional<double> angle;     ///< of twist and stamp, degrees
  std::optional<double> factor;    ///< of scale
  std::vector<std::vector<double>> pattern;  ///< of stamp: rows of heights
  std::optional<std::string> shape;          ///< of stamp: the name of a tool's shape
  double steady = 0;  ///< length of a rope by which the pointer draws the brush, in radii
  std::optional<PointAndDirection> mirror, axis;
  int radial = 1;  ///< copies of the stroke around the axis
  std::optional<bool> open;
  bool relative = false;
  std::optional<ThroughAllowance> allow = {};

  friend bool operator==(const BrushCommand&, const BrushCommand&) = default;
};

Expected<void> execute(const BrushCommand& c, Act& act);
void describe(BrushCommand& c, Fields& fields);

}  // namespace knead
