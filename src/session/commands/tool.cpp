#include "tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/scene/places.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

Point point_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

/// Whether lengths that were given can be; errors speak of the fields of the command.
Expected<void> check_lengths(const ToolCommand& c) {
  const std::pair<const char*, std::optional<double>> lengths[] = {
      {"radius", c.radius}, {"minor", c.minor}, {"height", c.height}, {"thickness", c.thickness}};
  for (const auto& [field, value] : lengths) {
    if (value && !(*value > 0))
      return input_error(fmt::format("{} is not a length", *value), field, "use a number > 0");
  }
  for (double size : c.sizes.value_or(Vector3{1, 1, 1})) {
    if (!(size > 0)) return input_error(fmt::format("{} is not a length", size), "sizes", "use three numbers > 0");
  }
  return {};
}

/// The shape that a command describes, lengths times `unit`.
Expected<Shape> shape_of(const ToolCommand& c, double unit, double diagonal, const Executor& executor) {
  const double radius = c.radius ? *c.radius * unit : 0.1 * diagonal;
  const double minor = c.minor ? *c.minor * unit : 0.25 * radius, height = c.height ? *c.height * unit : 2 * radius;
  const double thickness = c.thickness ? *c.thickness * unit : 0.1 * radius;
  const double rounding = c.rounding.value_or(0) * unit, top = c.top_radius.value_or(0) * unit;
  std::array<double, 3> sizes = {radius, radius, radius};
  if (c.sizes) {
    for (std::size_t k = 0; k < 3; ++k) sizes[k] = (*c.sizes)[k] * unit;
  }
  const std::array<double, 2> e = c.exponents.value_or(std::array<double, 2>{1, 1});
  if (c.shape == "sphere") return SphereShape{radius};
  if (c.shape == "ellipsoid") return EllipsoidShape{sizes};
  if (c.shape == "box") return BoxShape{sizes, rounding};
  if (c.shape == "cylinder") return CylinderShape{radius, 0.5 * height};
  if (c.shape == "cone") return ConeShape{radius, height, top};
  if (c.shape == "capsule") return CapsuleShape{radius, 0.5 * height};
  if (c.shape == "torus") return TorusShape{radius, minor};
  if (c.shape == "plane") return PlaneShape{};
  if (c.shape == "bowl") return BowlShape{radius, thickness};
  if (c.shape == "superellipsoid") return SuperellipsoidShape{sizes, e[0], e[1]};
  if (c.shape == "supertoroid") return SupertoroidShape{radius, {minor, minor}, e[0], e[1]};
  if (c.shape == "surface") {
    if (!c.surface) return input_error("the surface is missing", "surface", "give its id");
    const auto index = executor.find_surface(*c.surface);
    if (!index) return std::unexpected(index.error());
    return SplineShape{executor.state.surfaces[static_cast<std::size_t>(*index)].current};
  }
  return input_error(fmt::format("\"{}\" is not a shape", c.shape), "shape",
                     "the shapes are: sphere, ellipsoid, box, cylinder, cone, capsule, torus, plane, bowl, "
                     "superellipsoid, supertoroid, surface");
}

}  // namespace

template <>
Expected<void> Executor::execute(const ToolCommand& c) {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  const bool own_place = c.shape == "surface" && !c.position && !c.at;  // a surface is where it is
  if (!own_place && c.position.has_value() == c.at.has_value()) {
    return input_error(c.at ? "both position and at are given" : "neither position nor at is given", "position",
                       "give one of them");
  }
  if (auto done = check_lengths(c); !done) return done;
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
  } else if (c.at) {
    const auto u = parameters_at(*(*surface)->current, *c.at);
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
