#pragma once

#include "constraint_space.hpp"

namespace knead {

/// T of the space over all 3N coordinates, whether a constraint couples them or not.
[[nodiscard]] SparseMatrix coordinate_map(const ConstraintSpace& space);

}  // namespace knead
