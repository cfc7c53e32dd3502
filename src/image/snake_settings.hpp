#pragma once

#include "knead/image/snake.hpp"

namespace knead {

/// Errors (input): a setting outside its range, by its name.
template <int D>
[[nodiscard]] Expected<void> check_settings(const SnakeSettingsOf<D>& settings);

}  // namespace knead
