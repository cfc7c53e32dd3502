#pragma once

#include <cstdint>
#include <vector>

#include "knead/session/session.hpp"

namespace knead {

/// What holds each control point of a surface, all ways of holding taken together (`hold`, `pin`, `edge`, `freeze`,
/// `keep`; not symmetries and seams): 0 nothing, 1 it does not move, 2 it is bound to others by a condition, as near a
/// pinned surface point or a kept curve. Row i n + j. Cost: that of the constraints; for kept curves see `keep_curve`.
[[nodiscard]] Expected<std::vector<std::uint8_t>> held_points(const SurfaceState& surface);

}  // namespace knead
