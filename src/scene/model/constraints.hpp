#pragma once

#include "model.hpp"

namespace knead {

/// All constraints on one shape; terms are numbered by its own control points. Notes what may bend
/// or tear.
template <int D>
[[nodiscard]] Expected<ConstraintList> constraints_of(const ShapeInput<D>& shape,
                                                      std::vector<std::string>& notes);

}  // namespace knead
