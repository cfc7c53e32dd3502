#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Frees all that is held, pinned, frozen or kept of the selected surfaces.
struct ReleaseCommand {};

template <>
Expected<void> Executor::execute(const ReleaseCommand& c);
void describe(ReleaseCommand& c, Fields& fields);

}  // namespace knead
