#pragma once

#include <span>

#include "knead/spline/spline.hpp"
#include "step_entity.hpp"
#include "step_faces.hpp"

namespace knead::step {

/// The part of an elementary or swept surface that these faces on it cover, as `exact_spline`.
/// \param uncertainty of the surface, see `uncertainties_of`
[[nodiscard]] Expected<Surface> spline_of_faces(const Reader& reader, std::span<const Face> faces, double uncertainty);

}  // namespace knead::step
