#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>

#include "knead/spline/spline.hpp"
#include "knead/tool/tool.hpp"

namespace knead::examples {

using Colour = std::array<double, 3>;  ///< red, green, blue from 0 to 255

/// How surfaces are drawn.
struct DrawStyle {
  /// Of the surface of this number at its parameters; none: clay.
  std::function<Colour(std::size_t surface, const std::array<double, 2>& u)> colour = {};
  int facets_per_span = 4;
};

/// A picture of surfaces and tools as SVG text: parallel projection from the front, the right and
/// above, far facets first, shaded by their slope, with every span line of the surfaces. Tools that
/// are spheres, tori or bowls are drawn as glass, others left out.
[[nodiscard]] Expected<std::string> draw(std::span<const Surface> surfaces,
                                         std::span<const Tool> tools = {},
                                         const DrawStyle& style = {});

}  // namespace knead::examples
