#pragma once

#include <vector>

#include "step_entity.hpp"
#include "step_surfaces.hpp"

namespace knead::step {

/// `SurfaceEntity::trimmed` for each of `surfaces`; `uncertainty` belongs to them one by one.
[[nodiscard]] std::vector<bool> trimmed_surfaces(const Reader& reader, const std::vector<ReadSurface>& surfaces,
                                                 const std::vector<double>& uncertainty);

}  // namespace knead::step
