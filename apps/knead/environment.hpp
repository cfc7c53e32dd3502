#pragma once

#include "knead/base/error.hpp"

namespace knead::cli {

/// A usage error where KNEAD_INSTRUCTION_SET or KNEAD_THREADS says what the library would silently
/// leave out.
[[nodiscard]] Expected<void> check_environment();

/// That memory ran out at `place`, and how much is not enough: what the process may have, or the
/// machine has.
[[nodiscard]] Error out_of_memory(const std::string& place);

}  // namespace knead::cli
