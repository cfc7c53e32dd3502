#pragma once

#include <optional>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead::detail {

/// What a file that is not STEP is, told by its first bytes, as an error that says so and what to do; nothing if it is
/// none of those known. The name of the file is not part of it.
[[nodiscard]] std::optional<Error> foreign_format(std::string_view bytes);

}  // namespace knead::detail
