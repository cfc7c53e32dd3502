#pragma once

#include <variant>

#include "commands/brush.hpp"
#include "commands/buckling.hpp"
#include "commands/coarsen.hpp"
#include "commands/convert.hpp"
#include "commands/drag.hpp"
#include "commands/edge.hpp"
#include "commands/edit_tool.hpp"
#include "commands/elevate.hpp"
#include "commands/evolve.hpp"
#include "commands/force.hpp"
#include "commands/freeze.hpp"
#include "commands/history.hpp"
#include "commands/hold.hpp"
#include "commands/keep.hpp"
#include "commands/knots.hpp"
#include "commands/lattice.hpp"
#include "commands/limit.hpp"
#include "commands/load.hpp"
#include "commands/lock.hpp"
#include "commands/mask.hpp"
#include "commands/material.hpp"
#include "commands/measure.hpp"
#include "commands/modes.hpp"
#include "commands/morph.hpp"
#include "commands/move.hpp"
#include "commands/new.hpp"
#include "commands/pin.hpp"
#include "commands/points.hpp"
#include "commands/refine.hpp"
#include "commands/relax.hpp"
#include "commands/release.hpp"
#include "commands/remove.hpp"
#include "commands/rest.hpp"
#include "commands/scale.hpp"
#include "commands/scaling.hpp"
#include "commands/seams.hpp"
#include "commands/select.hpp"
#include "commands/smooth.hpp"
#include "commands/step.hpp"
#include "commands/stroke.hpp"
#include "commands/symmetry.hpp"
#include "commands/tool.hpp"
#include "commands/turn.hpp"
#include "commands/weights.hpp"
#include "knead/session/command.hpp"

namespace knead {

/// All commands, in the order of the help. Lengths are in file units unless a command says
/// `relative`; (s, t) are fractions 0 to 1 of the parameter domain.
using CommandVariant =
    std::variant<NewCommand, SelectCommand, LockCommand, ConvertCommand, MaterialCommand,
                 RestCommand, ScalingCommand, HoldCommand, PinCommand, EdgeCommand, FreezeCommand,
                 KeepCommand, SymmetryCommand, SmoothCommand, SeamsCommand, ReleaseCommand,
                 ToolCommand, EditToolCommand, RemoveCommand, MoveCommand, TurnCommand,
                 ScaleCommand, ForceCommand, LoadCommand, LimitCommand, EvolveCommand, StepCommand,
                 StrokeCommand, BrushCommand, MaskCommand, DragCommand, RelaxCommand,
                 LatticeCommand, MorphCommand, PointsCommand, WeightsCommand, KnotsCommand,
                 RefineCommand, ElevateCommand, CoarsenCommand, MeasureCommand, ModesCommand,
                 BucklingCommand, UndoCommand, RedoCommand>;

template <>
const Type& type_of<CommandVariant>();

struct Json;
/// A command from its JSON form, as `parse_command`.
[[nodiscard]] Expected<Command> read_command(const Json& json);

struct AnyCommand {
  CommandVariant fields;
};

enum class Through;

/// What a command may do where surfaces come to other faces; none: it moves no surface. `stops`:
/// what it does where it does not say, instead of noting it.
[[nodiscard]] std::optional<Through> through_of(const Command& command, bool stops);
/// The same command, which stops at other faces whoever carries it out.
[[nodiscard]] Command that_stops(const Command& command);

/// A command with these fields.
[[nodiscard]] inline Command make_command(CommandVariant fields) {
  return Command(AnyCommand{std::move(fields)});
}

/// The fields of a command of this kind; null if it is of another.
template <class C>
[[nodiscard]] const C* fields_of(const Command& command) {
  return std::get_if<C>(&command.any().fields);
}

}  // namespace knead
