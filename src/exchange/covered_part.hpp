#pragma once

#include <span>

#include "knead/spline/spline.hpp"
#include "step_entity.hpp"
#include "step_faces.hpp"

namespace knead::step {

/// The part of an elementary or swept surface that these faces on it cover, as `exact_spline`.
[[nodiscard]] Expected<Surface> spline_of_faces(const Reader& reader, std::span<const Face> faces);

}  // namespace knead::step
