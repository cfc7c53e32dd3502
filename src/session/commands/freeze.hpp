#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Freezes a region of the parameter domain, rounded outward to whole spans.
struct FreezeCommand {
  Freeze freeze;
};

template <>
Expected<void> Executor::execute(const FreezeCommand& c);
void describe(FreezeCommand& c, Fields& fields);

}  // namespace knead
