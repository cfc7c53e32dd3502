#pragma once

#include <span>
#include <string>

#include "act.hpp"

namespace knead {

/// The id of the surface in "#12 PLANE".
[[nodiscard]] std::string id_of_support(const std::string& support);

/// Makes surfaces of other forms of the file, given by their ids or those of faces on them, exact
/// B-spline surfaces of the scene. Edges of their faces are held, to `order` derivatives across
/// them. Errors: those of `Source::with_splines`.
[[nodiscard]] Expected<void> convert_surfaces(Act& act, std::span<const std::string> ids,
                                              int order);

}  // namespace knead
