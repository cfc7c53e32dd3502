#pragma once

#include "knead/image/surface_snake.hpp"

namespace knead {

/// Errors (input): a setting outside its range, by its name.
[[nodiscard]] Expected<void> check_surface_settings(const SurfaceSnakeSettings& settings);

}  // namespace knead
