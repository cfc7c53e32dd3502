#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scene.hpp"
#include "sculpt/lattice.hpp"

namespace knead {

/// The lattice round all control points of these surfaces, widened by `margin` of their diagonal.
/// Errors: there are none (input); those of `Lattice::create`.
[[nodiscard]] Expected<Lattice> lattice_around(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, double margin,
    const std::array<int, 3>& degree, const std::array<int, 3>& net);

/// The same round the selected surfaces as they are. Errors: no surface is selected (input); those
/// of `lattice_around`.
[[nodiscard]] Expected<Lattice> lattice_around_selection(const Scene& scene, double margin,
                                                         const std::array<int, 3>& degree,
                                                         const std::array<int, 3>& net);

/// The lattice of the scene, if another pull goes on where the last one ended: it has this net,
/// degree and margin, and the selected surfaces are those that it was put round, on the same basis
/// and with the control points that it has given them. Else null.
[[nodiscard]] const PulledLattice* lattice_to_pull_on(const Scene& scene, double margin,
                                                      const std::array<int, 3>& degree,
                                                      const std::array<int, 3>& net);

}  // namespace knead
