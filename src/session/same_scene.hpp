#pragma once

#include "scene/scene.hpp"

namespace knead {

/// Whether two scenes of one session are the same, every number bit for bit, but for edges that
/// have come to follow. A scene with an open stroke is no other's equal.
///
/// Cost: linear in the control points of surfaces that are not shared.
[[nodiscard]] bool same_scene(const Scene& a, const Scene& b);

}  // namespace knead
