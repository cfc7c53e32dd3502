#pragma once

#include <optional>
#include <vector>

#include "moving_snake.hpp"

namespace knead {

/// What the region term compares the grey values along each snake with: nothing for snakes that
/// have ended, are open or enclose less than a pixel, and for all where the image has no such term.
/// Cost: O(Gauss points · band + pixels where a snake has a band).
[[nodiscard]] std::vector<std::optional<Sides>> sides_of(const ImagePotential& image,
                                                         const std::vector<MovingSnake>& snakes,
                                                         const std::vector<Inside>& insides);

/// The pressure outwards of the region term, without its weight, at a Gauss point where the image
/// has that grey value.
[[nodiscard]] double region_pressure(const Sides& sides, std::size_t point, double grey,
                                     bool relative);
/// The same of two means: (I − μ_out)² − (I − μ_in)². Relative: in units of (μ_in − μ_out)², within
/// ±1, and 0 where the means are equal.
[[nodiscard]] double region_pressure(double inside, double outside, double grey, bool relative);

}  // namespace knead
