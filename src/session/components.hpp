#pragma once

#include <optional>
#include <string>

#include "scene/constraint.hpp"

namespace knead {

/// The coordinates that a text as "xz" names; all without one. Error (input): another letter, one
/// twice, or none.
[[nodiscard]] Expected<Components> components_of(const std::optional<std::string>& text);
/// The text for them; none where they are all.
[[nodiscard]] std::optional<std::string> components_text(const Components& components);

}  // namespace knead
