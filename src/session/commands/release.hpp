#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Frees all that is held, pinned, frozen or kept of the selected surfaces.
struct ReleaseCommand {};

KNEAD_COMMAND(ReleaseCommand, "release", "free all that is held, pinned, frozen or kept") {}

}  // namespace knead
