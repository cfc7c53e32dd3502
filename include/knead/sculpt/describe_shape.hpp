#pragma once

#include "knead/base/describe.hpp"
#include "knead/sculpt/shape.hpp"

namespace knead {

/// The shapes of tools by name, "sphere" to "surface", with their fields as scripts spell them. The shapes as they are
/// made by default are those of radius 1: the lengths of a shape of which only the radius is known are those times the
/// radius. `PlacedShape::create` checks more than the ranges, such as a torus' minor radius against its radius.
template <>
const Type& type_of<Shape>();

}  // namespace knead
