#pragma once

#include "../command_fields.hpp"

namespace knead {

struct ScalingCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  ScalingMode mode = ScalingMode::normalised;
};

std::span<const Choice> choices(ScalingMode);

Expected<void> execute(const ScalingCommand& c, Act& act);
void describe(ScalingCommand& c, Fields& fields);

}  // namespace knead
