#pragma once

#include <optional>
#include <string_view>

#include "knead/base/error.hpp"

namespace knead::detail {

/// An IGES file: the first record has 80 columns and ends in "S      1", the start section
/// (IGES 5.3, § 2.2.4.2); in compressed or binary form in C or B and a number.
[[nodiscard]] bool is_iges(std::string_view bytes);

/// What a file that is not STEP is, told by its first bytes, as an error that says so and what to
/// do; nothing if it is none of those known. The name of the file is not part of it.
[[nodiscard]] std::optional<Error> foreign_format(std::string_view bytes);

}  // namespace knead::detail
