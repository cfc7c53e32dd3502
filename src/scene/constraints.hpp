#pragma once

#include "knead/scene/model.hpp"

namespace knead {

/// All constraints on one surface; terms are numbered by its own control points. Notes what may bend or tear.
[[nodiscard]] Expected<ConstraintList> constraints_of(const SurfaceInput& surface, std::vector<std::string>& notes);

/// Appends the conditions of `from` for these coordinates only. One on a single control point leaves its coordinate its
/// bits, as a held flag does.
void append_components(const ConstraintList& from, const Components& components, ConstraintList& to);

}  // namespace knead
