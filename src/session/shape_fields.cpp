#include "shape_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>

#include "acts/selection.hpp"
#include "describe/record_json.hpp"
#include "tool/describe_shape.hpp"

namespace knead {
namespace {

/// The numbers of a purely numeric field: none for an optional without a value.
std::span<double> numbers_of(const Field& field, void* record) {
  const Type* type = field.type;
  void* value = field.of(record);
  if (type->kind == Kind::optional) {
    if (type->count(value) == 0) return {};
    value = type->at(value, 0);
    type = type->element;
  }
  if (!type->numeric()) return {};
  return {static_cast<double*>(value), type->kind == Kind::array ? type->length : 1};
}

/// The numbers of a shape's measure; none if it does not have it.
std::span<double> measure_of(Shape& shape, std::string_view name, double& factor) {
  const Type& shapes = type_of<Shape>();
  const Field* field = shapes.variants[shape.index()]->find(name);
  if (field == nullptr) return {};
  factor = field->factor;
  return numbers_of(*field, shapes.at(&shape, 0));
}

double radius_of(const ShapeFields& f, double unit, double diagonal, Shape* before) {
  if (f.radius) return *f.radius * unit;
  double factor = 1;
  const std::span<double> present =
      before != nullptr ? measure_of(*before, "radius", factor) : std::span<double>();
  return present.empty() ? 0.1 * diagonal : present.front();
}

/// The fields of a shape, as commands name them.
std::vector<std::string_view> fields_of_shape(const Type& shape) {
  std::vector<std::string_view> names;
  if (shape.find("sizes") != nullptr) names.emplace_back("radius");
  for (const Field& field : shape.fields) names.push_back(field.name);
  return names;
}

/// The names of the shapes that have this field.
std::span<const std::string_view> shapes_with(std::string_view field) {
  static std::map<std::string_view, std::vector<std::string_view>> known = [] {
    std::map<std::string_view, std::vector<std::string_view>> shapes;
    for (const Type* shape : type_of<Shape>().variants) {
      for (const std::string_view name : fields_of_shape(*shape))
        shapes[name].push_back(shape->name);
    }
    return shapes;
  }();
  return known[field];
}

bool names_any(ShapeFields fields) {
  return std::ranges::any_of(type_of<ShapeFields>().fields, [&](const Field& field) {
    return field.type->count(field.of(&fields)) > 0;
  });
}

/// The measures that several shapes have, or that need more explanation than their shape's.
void add_named_measures(ShapeFields& f, Fields& fields, std::string_view fallback = {}) {
  const auto otherwise = [fallback](std::string_view as_new) {
    return fallback.empty() ? as_new : fallback;
  };
  const auto add = [&](std::string_view name, auto& member, About about) {
    if (fallback.empty()) about.only = {"shape", shapes_with(name)};
    fields.add(name, member, about);
  };
  add("radius", f.radius,
      {.help = "of spheres, cylinders and the like; where a shape has `sizes`, all of them",
       .unit = Unit::length,
       .range = above(0),
       .fallback = otherwise("a tenth of the diagonal")});
  add("minor", f.minor,
      {.help = "tube radius of torus and supertoroid",
       .unit = Unit::length,
       .range = above(0),
       .fallback = otherwise("a quarter of the radius")});
  add("height", f.height,
      {.help =
           "of cylinder, cone, capsule (without its caps) and wedge (from its foot to its ridge)",
       .unit = Unit::length,
       .range = above(0),
       .fallback = otherwise("twice the radius; of a wedge a tenth of the diagonal")});
  add("top_radius", f.top_radius,
      {.help = "of a cone",
       .unit = Unit::length,
       .range = at_least(0),
       .fallback = otherwise("`0`")});
  add("thickness", f.thickness,
      {.help = "wall of a bowl",
       .unit = Unit::length,
       .range = above(0),
       .fallback = otherwise("a tenth of the radius")});
  add("rounding", f.rounding,
      {.help = "radius of the edges of a box, or of the ridge of a wedge",
       .unit = Unit::length,
       .range = at_least(0),
       .fallback = otherwise("`0`")});
  add("sizes", f.sizes,
      {.help = "`[a, b, c]`: semi-axes of (super)ellipsoids, half sides of a box",
       .unit = Unit::length,
       .range = above(0),
       .fallback = otherwise("the radius each")});
  add("exponents", f.exponents,
      {.help = "`[e1, e2]` of superellipsoid and supertoroid", .fallback = otherwise("`[1, 1]`")});
  add("surface", f.surface,
      {.help = "of shape `surface`: the id of the surface of the document that is the tool, as it "
               "is now",
       .fallback = fallback});
}

/// A number of shapes that the measures above do not name.
struct OtherMeasure {
  std::string_view name;
  std::string help, fallback;
  About about;
};

std::string default_of(const Field& field, const Type& shape) {
  const double number = *static_cast<const double*>(field.of(shape.initial)) * field.factor;
  if (field.unit != Unit::length || number == 0) return fmt::format("`{}`", number);
  return number == 1 ? "a tenth of the diagonal" : fmt::format("{} tenths of the diagonal", number);
}

std::vector<OtherMeasure> other_measures() {
  Type named;
  ShapeFields value;
  Fields fields(named, &value);
  add_named_measures(value, fields);
  std::vector<OtherMeasure> others;
  for (const Type* shape : type_of<Shape>().variants) {
    for (const Field& field : shape->fields) {
      if (named.find(field.name) != nullptr || field.type->kind != Kind::number) continue;
      const auto same = std::ranges::find(others, field.name, &OtherMeasure::name);
      if (same != others.end()) {
        same->help += fmt::format("; of a {}: {}", shape->name, field.help);
      } else {
        others.push_back({field.name, fmt::format("of a {}: {}", shape->name, field.help),
                          default_of(field, *shape), field});
      }
    }
  }
  assert(others.size() <= value.others.size());
  return others;
}

}  // namespace

void add_measures(ShapeFields& f, Fields& fields, std::string_view fallback) {
  add_named_measures(f, fields, fallback);
  static const std::vector<OtherMeasure> others = other_measures();
  for (std::size_t k = 0; k < others.size(); ++k) {
    const auto& [name, help, as_new, about] = others[k];
    fields.add(name, f.others[k],
               {.help = help,
                .unit = about.unit,
                .range = about.range,
                .fallback = fallback.empty() ? std::string_view(as_new) : fallback,
                .only = fallback.empty() ? OnlyWith{"shape", shapes_with(name)} : OnlyWith{}});
  }
}

void describe(ShapeFields& f, Fields& fields) {
  fields.name("measures", "of the shape of a tool");
  add_measures(f, fields);
}

std::span<const Choice> shape_choices() {
  static const std::vector<Choice> list = [] {
    std::vector<Choice> choices;
    for (const Type* shape : type_of<Shape>().variants)
      choices.emplace_back(shape->name, shape->help);
    return choices;
  }();
  return list;
}

std::string_view shape_name(const Shape& shape) {
  return type_of<Shape>().variants[shape.index()]->name;
}

/// The error for a field that a shape, given by name, does not have but another does; else nothing.
/// A radius counts as a field if there are `sizes`.
static std::optional<Error> no_measure_of(const Type& shape, std::string_view field) {
  const auto fields = fields_of_shape(shape);
  if (std::ranges::find(fields, field) != fields.end()) return std::nullopt;
  return Error{
      ErrorKind::input, fmt::format("the shape {} has no {}", shape.name, field),
      std::string(field),
      fields.empty() ? "it has no measures of its own" : "its fields are: " + joined(fields)};
}

Expected<Shape> make_shape(std::string_view name, ShapeFields f, double unit, double diagonal,
                           const Act& act, const Shape* before) {
  const Type& shapes = type_of<Shape>();
  const int k = shapes.variant(name);
  Shape shape;
  shapes.assign(&shape, k);
  if (auto* spline = std::get_if<SplineShape>(&shape)) {
    if (!f.surface) return input_error("the surface is missing", "surface", "give its id");
    const auto index = find_surface(act, *f.surface);
    if (!index) return std::unexpected(index.error());
    spline->surface = act.state.surfaces[static_cast<std::size_t>(*index)].current;
    return shape;
  }
  if (auto* cone = std::get_if<ConeShape>(&shape))
    cone->height = 2;  // as high as it is wide, like a cylinder
  std::optional<Shape> old;
  if (before != nullptr) old = *before;
  const double radius = radius_of(f, unit, diagonal, old ? &*old : nullptr);
  for (const Field& field : shapes.variants[static_cast<std::size_t>(k)]->fields) {
    const bool length = field.unit == Unit::length;
    const std::span<double> numbers = numbers_of(field, shapes.at(&shape, 0));
    const Field* asked = type_of<ShapeFields>().find(field.name);
    const std::span<double> given = asked != nullptr ? numbers_of(*asked, &f) : std::span<double>();
    // A given radius means all sizes.
    const bool stays = old && !(field.name == "sizes" && f.radius);
    double factor = 1;
    const std::span<double> present =
        stays ? measure_of(*old, field.name, factor) : std::span<double>();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!given.empty()) {
        numbers[i] = given[given.size() == 1 ? 0 : i] * (length ? unit : 1) / field.factor;
      } else if (!present.empty()) {
        numbers[i] = present[present.size() == 1 ? 0 : i] * factor / field.factor;
      } else {
        numbers[i] *= length ? radius : 1;
      }
    }
  }
  return shape;
}

Expected<Shape> edited_shape(const Shape& shape, std::string_view name, const ShapeFields& fields,
                             double unit, double diagonal, const Act& act) {
  if (name == shape_name(shape) && !names_any(fields)) return shape;
  ShapeFields given = fields;
  const Type& named =
      *type_of<Shape>().variants[static_cast<std::size_t>(type_of<Shape>().variant(name))];
  for (const Field& field : type_of<ShapeFields>().fields) {
    if (field.type->count(field.of(&given)) == 0) continue;
    if (auto error = no_measure_of(named, field.name)) return std::unexpected(*error);
  }
  return make_shape(name, fields, unit, diagonal, act, &shape);
}

}  // namespace knead
