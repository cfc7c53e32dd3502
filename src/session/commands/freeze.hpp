#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Freezes a region of the parameter domain, rounded outward to whole spans.
struct FreezeCommand {
  Freeze freeze;
};

Expected<void> execute(const FreezeCommand& c, Act& act);
void describe(FreezeCommand& c, Fields& fields);

}  // namespace knead
