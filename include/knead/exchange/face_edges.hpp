#pragma once

#include <string>

#include "knead/exchange/step_file.hpp"
#include "knead/sculpt/visible_region.hpp"

namespace knead {

/// What the faces of a STEP file show of one of its B-spline surfaces, and their edges with their names, neighbours and
/// course in the parameters of the surface.
///
/// Bounds are followed as by `trim_loops`; edges are sampled finer, from foot point to foot point, with the middle of
/// each chord brought to the surface too until it is within 2e-4 of the edge's extent of the chord in parameters. Each
/// edge comes once. A file's own curves in parameters (PCURVE) are not needed. Without faces there are no edges, and
/// the whole surface is visible. Errors: there is no such surface; a face on it cannot be followed, named with the
/// reason (input). Cost: O((p + 1)²) per point and iteration, and a pass over the file.
[[nodiscard]] Expected<VisibleRegion> visible_region(const step::File& file, const std::string& surface);

}  // namespace knead
