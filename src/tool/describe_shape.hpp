#pragma once

#include "describe/describe.hpp"
#include "knead/tool/shape.hpp"

namespace knead {

/// The shapes of tools by name, "sphere" to "surface", with their fields as scripts spell them.
/// Shapes have radius 1 by default: where only the radius of a shape is known, its other lengths
/// are the default ones times the radius. `PlacedShape::create` checks more than the ranges, such
/// as a torus's minor radius against its radius.
template <>
const Type& type_of<Shape>();

}  // namespace knead
