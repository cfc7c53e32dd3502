#pragma once

#include "triangulate.hpp"

namespace knead {

/// Triangles of a polygon with holes and no further points (see `triangulate`); `points` are those
/// of the loops in order, of which the first `sizes[0]` are the outline. None if no ear is left,
/// which happens only where sides cross.
///
/// A corner of the bridged ring is an ear where it turns left and no reflex corner lies in its
/// triangle. Turns are decided exactly, so that what remains is without crossings again and, by the
/// two-ears theorem (Meisters 1975), has an ear. Corners at one place do not hide each other: their
/// inner angles do not overlap.
[[nodiscard]] std::optional<std::vector<Triangle>> clip_ears(
    std::span<const Eigen::Vector2d> points, std::span<const std::uint32_t> sizes);

}  // namespace knead
