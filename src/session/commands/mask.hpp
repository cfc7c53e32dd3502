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

Expected<void> execute(const MaskCommand& c, Act& act);
void describe(MaskCommand& c, Fields& fields);

}  // namespace knead
