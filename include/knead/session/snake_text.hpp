#pragma once

#include <span>
#include <string>
#include <string_view>

#include "knead/image/snake.hpp"

namespace knead {

/// Contours as files, places in pixels; numbers with all their digits.
///
/// JSON: the image's name and size, and per snake whether it is closed and came to rest, degree, iterations, how often
/// it crosses itself, the area inside of a closed one, knots and control points. Cost: O(points²) for the crossings.
[[nodiscard]] std::string snakes_json(std::span<const SnakeResult> snakes, std::string_view name, int width,
                                      int height);

/// CSV: `snake,x,y`, 16 points per span.
[[nodiscard]] std::string snakes_csv(std::span<const SnakeResult> snakes);

/// SVG: lines through the same points, in pixels, so that it lies on the image.
[[nodiscard]] std::string snakes_svg(std::span<const SnakeResult> snakes, int width, int height);

/// 1 at pixels that are inside of any of the closed contours (`mask_of`), else 0.
[[nodiscard]] Image snakes_mask(std::span<const SnakeResult> snakes, int width, int height);

}  // namespace knead
