#pragma once

#include <cstdint>
#include <vector>

#include "knead/scene/scene.hpp"

namespace knead {

/// What decides which control points of a surface are held: equal inputs, equal answers.
struct HeldInput {
  std::array<int, 2> net = {0, 0};
  int hold_rows = 0;
  std::set<std::array<int, 2>> pins;
  std::vector<KeptConstraint> constraints;
  std::shared_ptr<const VisibleRegion> visible;  ///< where edges of faces are held, else null

  friend bool operator==(const HeldInput&, const HeldInput&) = default;
};

[[nodiscard]] HeldInput held_input(const SceneSurface& surface);

/// What holds each control point of a surface, all ways of holding taken together (`hold`, `pin`, `edge`, `freeze`,
/// `keep`; not symmetries and seams): 0 nothing, 1 it does not move, 2 it is bound to others by a condition, as near a
/// pinned surface point or a kept curve. Row i n + j. Cost: that of the constraints; for kept curves see `keep_curve`.
[[nodiscard]] Expected<std::vector<std::uint8_t>> held_points(const HeldInput& input);

}  // namespace knead
