#pragma once

#include <concepts>

#include "commands.hpp"

namespace knead {

/// What commands do to the selected curve or volume, each as far as it applies: fields that only surfaces have are
/// errors.
[[nodiscard]] Expected<void> on_body(Executor& executor, const MaterialCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const RestCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const HoldCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const PinCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const EdgeCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const ReleaseCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const ForceCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const StepCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const PointsCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const RefineCommand& c);

template <class C>
concept ActsOnBodies = requires(Executor& executor, const C& c) {
  on_body(executor, c);
};

template <class C, class... Cs>
concept OneOf = (std::same_as<C, Cs> || ...);

/// Commands that concern the scene, whatever is selected.
template <class C>
concept ConcernsScene = OneOf<C, NewCommand, SelectCommand, ConvertCommand, ScalingCommand, SeamsCommand, ToolCommand,
                              EditToolCommand, RemoveCommand, MoveCommand, TurnCommand, ScaleCommand, LoadCommand,
                              LimitCommand, EvolveCommand, UndoCommand, RedoCommand>;

/// Applies a command to what is selected.
template <class C>
[[nodiscard]] Expected<void> apply(Executor& executor, const C& command) {
  if constexpr (ConcernsScene<C>) {
    return executor.execute(command);
  } else {
    const SceneBody* const body = executor.body();
    if (body == nullptr) return executor.execute(command);
    if constexpr (ActsOnBodies<C>) {
      return on_body(executor, command);
    } else {
      return input_error(
          "this command acts on surfaces, and the " + std::string(kind_of(*body)) + " " + body->id + " is selected",
          std::string(type_of<C>().name), "select a surface first");
    }
  }
}

}  // namespace knead
