#pragma once

#include "../command_fields.hpp"
#include "scene/mask.hpp"

namespace knead {

std::span<const Choice> choices(MaskChange);

/// Changes the mask of the selected surfaces as a whole.
struct MaskCommand {
  MaskChange change = MaskChange::clear;
  std::optional<double> radius;  ///< default: a fiftieth of the diagonal
  bool relative = false;
};

template <>
Expected<void> Executor::execute(const MaskCommand& c);
void describe(MaskCommand& c, Fields& fields);

}  // namespace knead
