#pragma once

#include <string>

#include "knead/exchange/format.hpp"
#include "knead/session/session.hpp"

namespace knead::studio {

/// The model as a file of a format of triangles: the faces of the open STEP file as it would be saved, or, without one,
/// all surfaces, whole, with `detail` grid lines. Errors: those of saving and of `save_model` or `save_surfaces`.
[[nodiscard]] Expected<std::string> mesh_file(const Session& session, const Format& format, int detail);

}  // namespace knead::studio
