#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "knead/sculpt/active_spline.hpp"

namespace knead {

// What a user can do, as values. Every command has a JSON form {"do": name, field: value, …} (see command_json.hpp);
// fields that are `optional` here, or have a default, may be left out.

/// Chooses the surface that the following commands act on. A document with one surface has it selected already.
struct SelectCommand {
  std::string surface;  ///< id of the entity, "#123"
};

/// Sets the stretch and bend coefficients of the selected surface.
struct MaterialCommand {
  Material material;
};

/// Makes the present shape of the selected surface its rest shape, and says what the energy acts on.
struct RestCommand {
  RestMode mode = RestMode::shape;
};

/// Holds the outer `rows` rows of control points on every side; 0 holds none. Replaces an earlier hold.
struct HoldCommand {
  int rows = 2;
};

/// Pins single control points (i, j), in addition to those pinned already.
struct PinCommand {
  std::vector<std::array<int, 2>> control_points;
};

/// Frees all pinned and held control points of the selected surface.
struct ReleaseCommand {};

/// Puts a tool into the scene, or replaces the one of that name.
struct ToolCommand {
  std::string name = "tool";
  std::string shape = "sphere";
  std::optional<double> radius;                   ///< default: a tenth of the surface's bounding-box diagonal
  std::optional<std::array<double, 3>> position;  ///< of the centre; or:
  std::optional<std::array<double, 2>> at;        ///< centre on the surface, at fractions of its domain
  ToolMode mode = ToolMode::collision;
  std::optional<double> stiffness;  ///< default: 1e4 for collision, 100 for proximity
  std::optional<double> range;      ///< default: half the radius
  bool relative = false;            ///< lengths and position are fractions of the bounding-box diagonal
};

/// Takes a tool out of the scene.
struct RemoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
};

/// Moves a tool.
struct MoveCommand {
  std::optional<std::string> tool;  ///< default: the only tool
  std::array<double, 3> by = {0, 0, 0};
  bool relative = false;  ///< `by` is in fractions of the bounding-box diagonal
};

/// Lets the selected surface evolve under the tools.
struct StepCommand {
  int count = 1;
  double lambda = 1;
  StepWeight weight = StepWeight::mass;
};

/// Takes back the last command that was not taken back yet.
struct UndoCommand {};

/// Does again what was taken back last.
struct RedoCommand {};

using Command = std::variant<SelectCommand, MaterialCommand, RestCommand, HoldCommand, PinCommand, ReleaseCommand,
                             ToolCommand, RemoveCommand, MoveCommand, StepCommand, UndoCommand, RedoCommand>;

}  // namespace knead
