#pragma once

#include "../command_fields.hpp"

namespace knead {

struct ScalingCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  ScalingMode mode = ScalingMode::normalised;
};

std::span<const Choice> choices(ScalingMode);

template <>
Expected<void> Executor::execute(const ScalingCommand& c);
void describe(ScalingCommand& c, Fields& fields);

}  // namespace knead
