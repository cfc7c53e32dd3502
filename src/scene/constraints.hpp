#pragma once

#include "knead/scene/model.hpp"

namespace knead {

/// All constraints on one surface; terms count its own control points. What may bend or tear is noted.
[[nodiscard]] Expected<ConstraintList> constraints_of(const SurfaceInput& surface, std::vector<std::string>& notes);

}  // namespace knead
