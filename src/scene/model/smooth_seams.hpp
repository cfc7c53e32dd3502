#pragma once

#include <span>
#include <vector>

#include "hold/edge_coupling.hpp"
#include "knead/hold/seams.hpp"

namespace knead {

/// Seams with this angle at rest or less, radians, count as smooth.
inline constexpr double smooth_seam = 1e-3;

/// Whether a seam is smooth at rest, and coupled in position only.
[[nodiscard]] bool may_crease(const SeamReport& report);

/// The points of a seam that `may_crease`, with the directions in which both sides run on from one
/// another: with x on side a and the parameters' direction d_a across its edge, J_a d_a = J_b d_b,
/// J the Jacobians at rest. Displacements whose derivatives agree in these directions keep the
/// tangent planes common, whatever the ratio of the sides (docs/seams.md). Points at poles are left
/// out. Errors (numerical): those of evaluation.
[[nodiscard]] Expected<CoupledEdge> smooth_seam_edge(std::span<const Surface* const> patches,
                                                     const Seam& seam);

}  // namespace knead
