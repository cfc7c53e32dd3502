#pragma once

#include <vector>

#include "step_entity.hpp"
#include "step_surfaces.hpp"

namespace knead {

/// `StepSurface::trimmed` for each of `surfaces`; `uncertainty` belongs to them one by one.
[[nodiscard]] std::vector<bool> trimmed_surfaces(const StepReader& reader, const std::vector<ReadSurface>& surfaces,
                                                 const std::vector<double>& uncertainty);

}  // namespace knead
