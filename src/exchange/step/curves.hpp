#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "entity.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// Reads a B_SPLINE_CURVE in three dimensions in any of its forms, as `read_b_spline_surface` reads
/// surfaces.
[[nodiscard]] Expected<Curve> read_b_spline_curve(const Reader& reader, std::uint32_t instance);

}  // namespace knead::step
