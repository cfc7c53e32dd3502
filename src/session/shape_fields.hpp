#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_fields.hpp"

namespace knead {

/// The measures of a tool's shape as commands name them. The defaults depend on the shape.
struct ShapeFields {
  std::optional<double> radius;  ///< default: a tenth of the surface's bounding-box diagonal
  std::optional<double> minor, height, top_radius, thickness, rounding;
  std::optional<Vector3> sizes;  ///< semi-axes or half sizes
  std::optional<std::array<double, 2>> exponents;
  std::optional<std::string> surface;  ///< of shape "surface": its id
  /// Measures known only to the description of a shape, in the order in which `add_measures` names
  /// them.
  std::array<std::optional<double>, 8> others;
};

void describe(ShapeFields& f, Fields& fields);

/// Adds the measures to the fields of a command, those of a new tool only with the shapes that have
/// them. `fallback`: the default in words; empty: those of a new tool.
void add_measures(ShapeFields& f, Fields& fields, std::string_view fallback = {});

/// The shapes by their names, each with what it is.
[[nodiscard]] std::span<const Choice> shape_choices();
[[nodiscard]] std::string_view shape_name(const Shape& shape);

/// The shape with these measures. Given lengths are multiplied by `unit`. Of the others, those that
/// `before` has stay; the rest are the defaults of the shape, for a radius of 1, times the radius,
/// which defaults to a tenth of `diagonal`. Required: a known name. Errors (input): an unknown
/// surface.
[[nodiscard]] Expected<Shape> make_shape(std::string_view name, ShapeFields fields, double unit,
                                         double diagonal, const Act& act,
                                         const Shape* before = nullptr);

/// The shape with the named measures in place of its own. With another name, the measures common to
/// both shapes stay. Errors: as above, and a field that the shape does not have.
[[nodiscard]] Expected<Shape> edited_shape(const Shape& shape, std::string_view name,
                                           const ShapeFields& fields, double unit, double diagonal,
                                           const Act& act);

}  // namespace knead
