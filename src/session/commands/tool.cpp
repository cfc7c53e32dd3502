#include "tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "scene/places.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/trimming.hpp"

namespace knead {
namespace {

/// The tool's position, rotation and scale.
Expected<Placement> placement_of(const ToolCommand& c, double unit, Act& act) {
  Placement placement;
  if (c.axis && c.orientation) {
    return input_error("both axis and orientation are given", "orientation", "give one of them");
  }
  if (c.axis) {
    const Point axis = point_of(*c.axis);
    if (!(axis.norm() > 0))
      return input_error("the axis has no direction", "axis", "use a vector that is not zero");
    placement.rotation = turn_between(Point::UnitZ(), axis);
  }
  if (c.orientation) {
    const auto rotation = rotation_of(*c.orientation);
    if (!rotation) return std::unexpected(rotation.error());
    placement.rotation = *rotation;
  }
  if (c.scale) placement.scale = *c.scale;
  if (c.position) {
    placement.position = unit * point_of(*c.position);
  } else if (c.at || c.middle.value_or(false)) {
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

Expected<Eigen::Quaterniond> rotation_of(const std::array<double, 4>& q) {
  const Eigen::Quaterniond given(q[3], q[0], q[1], q[2]);
  const double norm = given.norm();
  if (std::isfinite(norm) && norm > 0) return given.normalized();
  return input_error("this is not a rotation", "orientation",
                     "give a quaternion [x, y, z, w] that is not zero");
}

Expected<Point> point_at(Act& act, SceneSurface& surface, const SurfacePlace& place) {
  const auto at = place_on(act, surface, place);
  if (!at) return std::unexpected(at.error());
  const auto u = parameters_at(*surface.current, *at);
  if (!u) return std::unexpected(u.error());
  return evaluate_point<2>(*surface.current, *u);
}

std::span<const Choice> choices(ToolMode) {
  static constexpr Choice list[] = {
      {"collision", ToolMode::collision, "what has entered the tool is pushed out"},
      {"proximity", ToolMode::proximity,
       "the surface is drawn to the tool's surface from either side, within `range`"},
      {"imprint", ToolMode::imprint, "collision whose result is the new rest shape"}};
  return list;
}

std::span<const Choice> choices(ToolDirection) {
  static constexpr Choice list[] = {{"pull", ToolDirection::pull, "towards the tool's surface"},
                                    {"push", ToolDirection::push, "away from it"}};
  return list;
}

std::span<const Choice> choices(ToolTouch) {
  static constexpr Choice list[] = {
      {"all", ToolTouch::all, "all of a surface, what no face shows too"},
      {"visible", ToolTouch::visible,
       "what the faces show; a tool in a hole, or beside the face, touches nothing"}};
  return list;
}

void describe(ToolCommand& c, Fields& fields) {
  fields.name("tool", "add a tool to the scene, or replace the one of that name");
  fields.add("name", c.name, {.help = "what `move` and `remove` call it"});
  fields.add("shape", c.shape, {.help = "its form", .choices = shape_choices()});
  add_measures(c.measures, fields);
  fields.add("axis", c.axis,
             {.help = "direction of its own z axis; or:", .fallback = "`[0, 0, 1]`"});
  fields.add("orientation", c.orientation,
             {.help = "its rotation, a quaternion `[x, y, z, w]` of any length",
              .fallback = "`[0, 0, 0, 1]`"});
  fields.add("scale", c.scale,
             {.help = "factors along its own axes", .range = above(0), .fallback = "`[1, 1, 1]`"});
  fields.add("position", c.position,
             {.help = "`[x, y, z]` of the centre; this or `at` is needed (a `surface` stays in "
                      "place without them)",
              .unit = Unit::length});
  fields.add("at", c.at,
             {.help = "`[s, t]`: the centre on the surface as it is now; or `\"middle\"`, the "
                      "visible point farthest from all edges",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("middle", c.middle, {.help = "`true` is the same as `\"at\": \"middle\"`"});
  fields.add("mode", c.mode, {.help = "how it acts"});
  fields.add("stiffness", c.stiffness,
             {.help = "k",
              .range = between(0, max_tool_stiffness),
              .fallback = "`1e4`; `100` for proximity"});
  fields.add("range", c.range,
             {.help = "how far proximity reaches",
              .unit = Unit::length,
              .range = at_least(0),
              .fallback = "half the size"});
  fields.add("direction", c.direction, {.help = "of proximity"});
  fields.add("touches", c.touches, {.help = "of surfaces that edges of faces bound"});
  fields.add("rigid", c.rigid,
             {.help = "raise k until nothing enters by more than 1e-4 of the tool's size"});
  fields.add("friction", c.friction, {.help = "Coulomb's coefficient", .range = at_least(0)});
  fields.add("plasticity", c.plasticity,
             {.help = "share of the displacement that `remove` leaves in the rest shape",
              .unit = Unit::fraction,
              .range = between(0, 1)});
  fields.add("relative", c.relative,
             {.help = "lengths and position are fractions of the diagonal"});
}

Expected<void> execute(const ToolCommand& c, Act& act) {
  if (auto some = some_selected(act); !some) return some;
  const bool on_surface = c.at || c.middle.value_or(false);
  // A surface stays in place.
  const bool own_place = c.shape == "surface" && !c.position && !on_surface;
  if (!own_place && c.position.has_value() == on_surface) {
    return input_error(
        on_surface ? "both position and at are given" : "neither position nor at is given",
        "position", "give one of them");
  }
  // Measuring the surface costs as much as a step of a small net: a tool whose lengths are all
  // given does not need it.
  const bool infinite = c.shape == "plane";
  double length = 0;
  if (c.relative || !c.measures.radius || infinite) {
    const auto measured = diagonal(act);
    if (!measured) return std::unexpected(measured.error());
    length = *measured;
  }
  const double unit = c.relative ? length : 1;
  const auto shape = make_shape(c.shape, c.measures, unit, length, act);
  if (!shape) return std::unexpected(shape.error());
  const auto placement = placement_of(c, unit, act);
  if (!placement) return std::unexpected(placement.error());
  auto placed = PlacedShape::create(*shape, *placement);
  if (!placed) {
    Error error = placed.error();
    if (error.where == "e1" || error.where == "e2") error.where = "exponents";
    return std::unexpected(error);
  }
  const double stiffness = c.stiffness.value_or(c.mode == ToolMode::proximity ? 100 : 1e4);
  const double size = std::isfinite(placed->size()) ? placed->size() : 0.1 * length;
  Tool made{c.name, std::move(*placed), c.mode, stiffness, c.range ? *c.range * unit : 0.5 * size};
  made.rigid = c.rigid;
  made.friction = c.friction;
  made.plasticity = c.plasticity;
  made.direction = c.direction;
  made.touches = c.touches;
  if (auto tool = validated(made); !tool) return std::unexpected(tool.error());
  const auto same =
      std::ranges::find(act.state.tools, c.name, [](const Tool& t) { return t.name; });
  if (same != act.state.tools.end()) {
    *same = std::move(made);
  } else {
    act.state.tools.push_back(std::move(made));
  }
  return {};
}

}  // namespace knead
