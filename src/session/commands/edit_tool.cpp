#include "edit_tool.hpp"

#include "session/acts/selection.hpp"

namespace knead {
namespace {

/// The tool's new position, rotation and scale.
Expected<Placement> placement_of(const EditToolCommand& c, const Placement& before, double unit,
                                 Act& act) {
  if (c.axis && c.orientation) {
    return input_error("both axis and orientation are given", "orientation", "give one of them");
  }
  const bool on_surface = c.at || c.middle.value_or(false);
  if (c.position && on_surface)
    return input_error("both position and at are given", "position", "give one of them");
  Placement placement = before;
  if (c.axis) {
    const Point axis((*c.axis)[0], (*c.axis)[1], (*c.axis)[2]);
    if (!(axis.norm() > 0))
      return input_error("the axis has no direction", "axis", "use a vector that is not zero");
    const Point present = before.rotation * Point::UnitZ();
    placement.rotation = (turn_between(present, axis) * before.rotation).normalized();
  }
  if (c.orientation) {
    const auto rotation = rotation_of(*c.orientation);
    if (!rotation) return std::unexpected(rotation.error());
    placement.rotation = *rotation;
  }
  if (c.scale) placement.scale = *c.scale;
  if (c.position)
    placement.position = unit * Point((*c.position)[0], (*c.position)[1], (*c.position)[2]);
  if (on_surface) {
    const auto surface = selected(act);
    if (!surface) return std::unexpected(surface.error());
    const auto point =
        point_at(act, **surface, {c.at.value_or(Fractions{0.5, 0.5}), c.middle.value_or(false)});
    if (!point) return std::unexpected(point.error());
    placement.position = *point;
  }
  if (!placement.position.allFinite())
    return input_error("a coordinate is too large", "position", "use smaller ones");
  return placement;
}

}  // namespace

void describe(EditToolCommand& c, Fields& fields) {
  fields.name("edit_tool", "change fields of a tool; fields not given stay as they are");
  constexpr About as_of_tool = {.help = "as for `tool`"};
  constexpr About length = {.help = "as for `tool`", .unit = Unit::length};
  fields.add("tool", c.tool, {.help = "its name; or:", .fallback = "the only tool"});
  fields.add("name", c.name, {.help = "its name", .fallback = "the only tool"});
  fields.add("shape", c.shape,
             {.help = "another shape: measures that both shapes have are kept, the others are "
                      "those of a new tool",
              .choices = shape_choices()});
  add_measures(c.measures, fields, "as it was");
  fields.add("axis", c.axis,
             {.help = "new direction of its own z axis, reached the shortest way, without twist "
                      "about that axis; or:"});
  fields.add("orientation", c.orientation, as_of_tool);
  fields.add("scale", c.scale,
             {.help = "as for `tool`; replaces the previous scale", .range = above(0)});
  fields.add("position", c.position, length);
  fields.add("at", c.at, {.help = "as for `tool`", .unit = Unit::fraction, .range = between(0, 1)});
  fields.add("middle", c.middle, as_of_tool);
  fields.add("mode", c.mode, {.help = "how it acts; the stiffness does not change"});
  fields.add("stiffness", c.stiffness,
             {.help = "as for `tool`", .range = between(0, max_tool_stiffness)});
  fields.add("range", c.range,
             {.help = "as for `tool`", .unit = Unit::length, .range = at_least(0)});
  fields.add("direction", c.direction, {.help = "of proximity"});
  fields.add("touches", c.touches, as_of_tool);
  fields.add("rigid", c.rigid, as_of_tool);
  fields.add("friction", c.friction, {.help = "as for `tool`", .range = at_least(0)});
  fields.add("plasticity", c.plasticity,
             {.help = "as for `tool`", .unit = Unit::fraction, .range = between(0, 1)});
  fields.add("relative", c.relative,
             {.help = "lengths and position of this command are fractions of the diagonal"});
}

Expected<void> execute(const EditToolCommand& c, Act& act) {
  if (c.tool && c.name && *c.tool != *c.name) {
    return input_error("tool and name are different", "name",
                       "give one of them: tools are not renamed");
  }
  auto found = find_tool(act, c.tool ? c.tool : c.name);
  if (!found) return std::unexpected(found.error());
  Tool edited = **found;
  double unit = 1, length = 0;
  if (c.relative || c.shape) {  // another shape may need a default radius
    const auto measured = diagonal(act);
    if (!measured) return std::unexpected(measured.error());
    length = *measured;
    if (c.relative) unit = length;
  }
  const Shape& before = edited.shape.shape();
  const auto shape =
      edited_shape(before, c.shape ? *c.shape : shape_name(before), c.measures, unit, length, act);
  if (!shape) return std::unexpected(shape.error());
  const Placement& at = edited.shape.placement();
  const auto placement = placement_of(c, at, unit, act);
  if (!placement) return std::unexpected(placement.error());
  const bool moved_only = *shape == before && placement->scale == at.scale;
  auto placed = moved_only ? edited.shape.moved(placement->rotation, placement->position)
                           : PlacedShape::create(*shape, *placement);
  if (!placed) {
    Error error = placed.error();
    if (error.where == "e1" || error.where == "e2") error.where = "exponents";
    return std::unexpected(error);
  }
  edited.shape = std::move(*placed);
  edited.mode = c.mode.value_or(edited.mode);
  edited.stiffness = c.stiffness.value_or(edited.stiffness);
  edited.range = c.range ? *c.range * unit : edited.range;
  edited.direction = c.direction.value_or(edited.direction);
  edited.touches = c.touches.value_or(edited.touches);
  edited.rigid = c.rigid.value_or(edited.rigid);
  edited.friction = c.friction.value_or(edited.friction);
  edited.plasticity = c.plasticity.value_or(edited.plasticity);
  if (auto tool = validated(edited); !tool) return std::unexpected(tool.error());
  **found = std::move(edited);
  return {};
}

}  // namespace knead
