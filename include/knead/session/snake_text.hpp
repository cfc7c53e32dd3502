#pragma once

#include <span>
#include <string>
#include <string_view>

#include "knead/image/snake.hpp"
#include "knead/image/surface_snake.hpp"

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

/// JSON of surfaces in a volume: the volume's name and per snake form, degree, iterations, whether it came to rest, how
/// many pairs of its triangles cross, area and volume inside, knots, net and control points.
[[nodiscard]] std::string volume_snakes_json(std::span<const SurfaceSnakeResult> snakes, std::string_view name);

/// 1 at voxels that are inside of any of the surfaces, else 0, on the grid of `volume`.
[[nodiscard]] VolumeImage volume_snakes_mask(std::span<const SurfaceSnakeResult> snakes, const VolumeImage& volume);

}  // namespace knead
