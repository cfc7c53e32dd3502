#pragma once

#include "knead/hold/constraints.hpp"
#include "solve/constraint_space.hpp"

namespace knead {

/// The space of displacements that satisfy the whole list.
/// \param displacement present displacements, which held control points keep.
/// \param size         the model's size, file units, > 0: the unit in which constraints are
/// compared. Errors (input): contradictory constraints, both named; a constraint that the held
/// points do not allow to within 1e-9 of the size, with the names of the holds.
[[nodiscard]] Expected<ConstraintSpace> constraint_space(const ConstraintList& list,
                                                         const Points& displacement, double size);

}  // namespace knead
