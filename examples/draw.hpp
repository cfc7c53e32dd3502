#pragma once

#include <span>
#include <string>

#include "knead/sculpt/tool.hpp"
#include "knead/spline/spline.hpp"

namespace knead::examples {

/// A picture of surfaces and tools as SVG text: parallel projection from the front, the right and above, far facets
/// first, shaded by their slope, with every span line of the surfaces. Tools that are spheres, tori or bowls are drawn
/// as glass, others left out.
[[nodiscard]] Expected<std::string> draw(std::span<const Surface> surfaces, std::span<const Tool> tools = {});

}  // namespace knead::examples
