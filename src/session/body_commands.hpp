#pragma once

#include "commands.hpp"

namespace knead {

/// What commands do to the selected curve or volume where that is not what they do to surfaces: fields that only
/// surfaces have are errors.
[[nodiscard]] Expected<void> on_body(Executor& executor, const MaterialCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const HoldCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const PinCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const EdgeCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const ReleaseCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const PointsCommand& c);
[[nodiscard]] Expected<void> on_body(Executor& executor, const RefineCommand& c);

/// Applies a command to what is selected.
template <class C>
[[nodiscard]] Expected<void> apply(Executor& executor, const C& command) {
  const SceneBody* const body = target_of<C>() == ActsOn::scene ? nullptr : executor.body();
  if (body == nullptr) return executor.execute(command);
  if constexpr (requires { on_body(executor, command); }) {
    return on_body(executor, command);
  } else if constexpr (target_of<C>() == ActsOn::shapes) {
    return executor.execute(command);
  } else {
    return input_error(
        "this command acts on surfaces, and the " + std::string(kind_of(*body)) + " " + body->id + " is selected",
        std::string(type_of<C>().name), "select a surface first");
  }
}

}  // namespace knead
