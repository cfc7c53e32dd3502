#pragma once

#include <array>

#include "knead/scene/scene.hpp"
#include "knead/sculpt/lattice.hpp"

namespace knead {

/// The lattice round all control points of the selected surfaces, widened by `margin` of their diagonal. Errors: no
/// surface is selected (input); those of `Lattice::create`.
[[nodiscard]] Expected<Lattice> lattice_around_selection(const Scene& scene, double margin,
                                                         const std::array<int, 3>& degree,
                                                         const std::array<int, 3>& net);

}  // namespace knead
