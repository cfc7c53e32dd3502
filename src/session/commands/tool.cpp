#include "tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../described_json.hpp"
#include "knead/scene/places.hpp"
#include "knead/sculpt/describe_shape.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

Point point_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

/// The numbers of a field that holds nothing else: none for an optional without a value.
std::span<double> numbers_of(const Field& field, void* record) {
  const Type* type = field.type;
  void* value = field.of(record);
  if (type->kind == Kind::optional) {
    if (type->count(value) == 0) return {};
    value = type->at(value, 0);
    type = type->element;
  }
  return {static_cast<double*>(value), type->kind == Kind::array ? type->length : 1};
}

/// The shape that a command describes. Lengths are those given, times `unit`; the others those of the shape as it is
/// made by default, for a radius of 1, times the radius.
Expected<Shape> shape_of(ToolCommand c, double unit, double diagonal, const Executor& executor) {
  const Type& shapes = type_of<Shape>();
  const int k = shapes.variant(c.shape);
  if (k < 0) {
    return input_error(fmt::format("\"{}\" is not a shape", c.shape), "shape",
                       "the shapes are: " + joined(variant_names(shapes)));
  }
  Shape shape;
  shapes.assign(&shape, k);
  if (auto* spline = std::get_if<SplineShape>(&shape)) {
    if (!c.surface) return input_error("the surface is missing", "surface", "give its id");
    const auto index = executor.find_surface(*c.surface);
    if (!index) return std::unexpected(index.error());
    spline->surface = executor.state.surfaces[static_cast<std::size_t>(*index)].current;
    return shape;
  }
  if (auto* cone = std::get_if<ConeShape>(&shape)) cone->height = 2;  // as high as it is wide, as a cylinder
  const double radius = c.radius ? *c.radius * unit : 0.1 * diagonal;
  for (const Field& field : shapes.variants[static_cast<std::size_t>(k)]->fields) {
    const bool length = field.unit == Unit::length;
    const std::span<double> numbers = numbers_of(field, shapes.at(&shape, 0));
    const Field* asked = type_of<ToolCommand>().find(field.name);
    const std::span<double> given = asked != nullptr ? numbers_of(*asked, &c) : std::span<double>();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (given.empty()) {
        numbers[i] *= length ? radius : 1;
      } else {
        numbers[i] = given[given.size() == 1 ? 0 : i] * (length ? unit : 1) / field.factor;
      }
    }
  }
  return shape;
}

}  // namespace

std::span<const Choice> choices(ToolMode) {
  static constexpr Choice list[] = {
      {"collision", ToolMode::collision, "what has entered the tool is pushed out"},
      {"proximity", ToolMode::proximity, "the surface is drawn to the tool's surface from either side, within `range`"},
      {"imprint", ToolMode::imprint, "collision whose result is the new rest shape"}};
  return list;
}

std::span<const Choice> choices(ToolDirection) {
  static constexpr Choice list[] = {{"pull", ToolDirection::pull}, {"push", ToolDirection::push}};
  return list;
}

void describe(ToolCommand& c, Fields& fields) {
  static const std::string shapes = joined(variant_names(type_of<Shape>()));
  fields.name("tool", "put a tool into the scene, or replace the one of that name");
  fields.add("name", c.name, {.help = "what `move` and `remove` call it"});
  fields.add("shape", c.shape, {.help = shapes});
  fields.add("radius", c.radius,
             {.help = "of spheres, cylinders and the like",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a tenth of the diagonal"});
  fields.add("minor", c.minor,
             {.help = "tube radius of torus and supertoroid",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "a quarter of the radius"});
  fields.add("height", c.height,
             {.help = "of cylinder, cone and capsule (without its caps)",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "twice the radius"});
  fields.add("top_radius", c.top_radius, {.help = "of a cone", .unit = Unit::length, .fallback = "`0`"});
  fields.add("thickness", c.thickness,
             {.help = "wall of a bowl", .unit = Unit::length, .range = above(0), .fallback = "a tenth of the radius"});
  fields.add("rounding", c.rounding, {.help = "edge radius of a box", .unit = Unit::length, .fallback = "`0`"});
  fields.add("sizes", c.sizes,
             {.help = "`[a, b, c]`: semi-axes of (super)ellipsoids, half sides of a box",
              .unit = Unit::length,
              .range = above(0),
              .fallback = "the radius each"});
  fields.add("exponents", c.exponents,
             {.help = "`[e1, e2]` of superellipsoid and supertoroid", .fallback = "`[1, 1]`"});
  fields.add("surface", c.surface,
             {.help = "of shape `surface`: the id of the surface of the document that is the tool, as it is now"});
  fields.add("axis", c.axis, {.help = "where its own z axis points", .fallback = "`[0, 0, 1]`"});
  fields.add("scale", c.scale, {.help = "factors along its own axes", .fallback = "`[1, 1, 1]`"});
  fields.add("position", c.position,
             {.help = "`[x, y, z]` of the centre; this or `at` is needed (a `surface` lies where it is without)",
              .unit = Unit::length});
  fields.add("at", c.at, {.help = "`[s, t]`: the centre on the surface as it is now", .unit = Unit::fraction});
  fields.add("middle", c.middle, {.help = "the visible point farthest from all edges, instead of `at`"});
  fields.add("mode", c.mode);
  fields.add("stiffness", c.stiffness, {.help = "k, from 0 to 1e10", .fallback = "`1e4`; `100` for proximity"});
  fields.add("range", c.range,
             {.help = "how far proximity reaches", .unit = Unit::length, .fallback = "half the size"});
  fields.add("direction", c.direction, {.help = "of proximity"});
  fields.add("rigid", c.rigid, {.help = "raise k until nothing enters by more than 1e-4 of the tool's size"});
  fields.add("friction", c.friction, {.help = "Coulomb's coefficient"});
  fields.add(
      "plasticity", c.plasticity,
      {.help = "share of the displacement that `remove` leaves in the rest shape, 0 to 1", .unit = Unit::fraction});
  fields.add("relative", c.relative, {.help = "lengths and position are fractions of the diagonal"});
}

template <>
Expected<void> Executor::execute(const ToolCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  const bool on_surface = c.at || c.middle.value_or(false);
  const bool own_place = c.shape == "surface" && !c.position && !on_surface;  // a surface is where it is
  if (!own_place && c.position.has_value() == on_surface) {
    return input_error(on_surface ? "both position and at are given" : "neither position nor at is given", "position",
                       "give one of them");
  }
  if (auto done = check_ranges(type_of<ToolCommand>(), &c); !done) return done;
  // Measuring the surface costs as much as a step of a small net: a tool whose lengths are all given needs it not.
  const bool infinite = c.shape == "plane";
  double length = 0;
  if (c.relative || !c.radius || infinite) {
    const auto measured = diagonal();
    if (!measured) return std::unexpected(measured.error());
    length = *measured;
  }
  const double unit = c.relative ? length : 1;
  const auto shape = shape_of(c, unit, length, *this);
  if (!shape) return std::unexpected(shape.error());
  Placement placement;
  if (c.axis) {
    const Point axis = point_of(*c.axis);
    if (!(axis.norm() > 0)) return input_error("the axis has no direction", "axis", "use a vector that is not zero");
    placement.rotation = Eigen::Quaterniond::FromTwoVectors(Point::UnitZ(), axis);
  }
  if (c.scale) placement.scale = *c.scale;
  if (c.position) {
    placement.position = unit * point_of(*c.position);
  } else if (on_surface) {
    const auto at = place_on(**surface, {c.at.value_or(Fractions{0.5, 0.5}), c.middle.value_or(false)});
    if (!at) return std::unexpected(at.error());
    const auto u = parameters_at(*(*surface)->current, *at);
    if (!u) return std::unexpected(u.error());
    const auto point = evaluate_point<2>(*(*surface)->current, *u);
    if (!point) return std::unexpected(point.error());
    placement.position = *point;
  }
  if (!placement.position.allFinite()) return input_error("a coordinate is not a finite number", "position");
  auto placed = PlacedShape::create(*shape, placement);
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
  if (auto tool = validated(made); !tool) return std::unexpected(tool.error());
  const auto same = std::ranges::find(state.tools, c.name, [](const Tool& t) { return t.name; });
  if (same != state.tools.end()) {
    *same = std::move(made);
  } else {
    state.tools.push_back(std::move(made));
  }
  return {};
}

}  // namespace knead
