#pragma once

#include "knead/scene/scene.hpp"

namespace knead {

/// Whether surfaces and bodies, what holds them and how they evolve are the same in two scenes of one session, every
/// number bit for bit. What settings and steps cannot change is not compared: tools, forces, probes, edges that follow,
/// lattices. A scene with an open stroke is no other's equal.
///
/// Cost: linear in the control points of surfaces that are not shared.
[[nodiscard]] bool same_scene(const Scene& a, const Scene& b);

}  // namespace knead
