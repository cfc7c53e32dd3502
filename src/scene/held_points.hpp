#pragma once

#include <cstdint>
#include <vector>

#include "scene.hpp"

namespace knead {

/// What determines which control points of a surface are held: equal inputs give equal answers.
struct HeldInput {
  std::array<int, 2> net = {0, 0};
  int hold_rows = 0;
  std::set<std::array<int, 2>> pins;
  std::vector<KeptConstraint> constraints;
  std::shared_ptr<const VisibleRegion> visible;  ///< if edges of faces are held, else null
  std::vector<bool> masked;                      ///< control points that a mask holds; empty: none

  friend bool operator==(const HeldInput&, const HeldInput&) = default;
};

[[nodiscard]] HeldInput held_input(const SceneSurface& surface);

/// How each control point of a surface is held, over all kinds of constraint (`hold`, `pin`,
/// `edge`, `freeze`, `keep`; not symmetries and seams): 0 free, 1 fixed, 2 coupled to others by a
/// condition, as near a pinned surface point or a kept curve. Row i n + j. Cost: that of the
/// constraints; for kept curves see `keep_curve`.
[[nodiscard]] Expected<std::vector<std::uint8_t>> held_points(const HeldInput& input);

}  // namespace knead
