#pragma once

#include "knead/scene/model.hpp"

namespace knead {

/// All constraints on one surface; terms are numbered by its own control points. Notes what may bend or tear.
[[nodiscard]] Expected<ConstraintList> constraints_of(const SurfaceInput& surface, std::vector<std::string>& notes);

}  // namespace knead
