#pragma once

#include "knead/sculpt/constraints.hpp"
#include "solve/constraint_space.hpp"

namespace knead {

/// The space of displacements that satisfy the whole list.
/// \param displacement present displacements: held control points keep theirs.
/// \param size         the model's size, file units, > 0: the unit in which constraints are compared.
/// Errors (input): constraints that contradict each other, both named; a constraint that what is held does not allow to
/// within 1e-9 of the size, with the names of the holds.
[[nodiscard]] Expected<ConstraintSpace> constraint_space(const ConstraintList& list, const Points& displacement,
                                                         double size);

}  // namespace knead
