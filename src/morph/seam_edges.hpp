#pragma once

#include <span>

#include "knead/hold/seams.hpp"
#include "surface_fit.hpp"

namespace knead::morph {

/// Edges of a fit where surfaces meet geometrically, for those that no face's edge joins: surfaces
/// without faces, T-junctions.
///
/// Of a `whole` seam both feet have the same share of their sides. Of others the points of the side
/// that is wholly in the other, or else of the first, have their nearest points on the other side;
/// those farther away than the gap of the seam and 1e-6 of the size of the surfaces are left out.
/// Seams of a surface with itself are left out: closed surfaces stay closed without them.
/// \param seams of these surfaces, as by `find_seams`; their positions are those of the fit.
/// Errors: those of evaluation. Cost: some hundred evaluations per seam, or searches.
[[nodiscard]] Expected<std::vector<FitEdge>> edges_of_seams(
    std::span<const Surface* const> surfaces, std::span<const Seam> seams);

}  // namespace knead::morph
