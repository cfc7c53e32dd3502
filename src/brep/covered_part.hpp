#pragma once

#include <span>

#include "knead/brep/model.hpp"
#include "knead/spline/spline.hpp"

namespace knead::brep {

/// The part of an elementary or swept surface that these faces, all on it, cover, as
/// `exact_spline`.
[[nodiscard]] Expected<Surface> spline_of_faces(const Model& model,
                                                std::span<const Face* const> faces);

}  // namespace knead::brep
