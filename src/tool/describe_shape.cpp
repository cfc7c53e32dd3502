#include "describe_shape.hpp"

namespace knead {

namespace {

constexpr About length(std::string_view help) {
  return {.help = help, .unit = Unit::length, .range = above(0)};
}

constexpr About exponents = {.help =
                                 "[e1, e2] along and round the z axis: 1 is round, towards 0 "
                                 "square, 2 straight, above 2 pinched",
                             .range = between(0.1, 4)};

}  // namespace

static void describe(SphereShape& s, Fields& fields) {
  fields.name("sphere", "x² + y² + z² <= radius²");
  fields.add("radius", s.radius, length(""));
}

static void describe(EllipsoidShape& s, Fields& fields) {
  fields.name("ellipsoid", "a ball stretched along its axes");
  fields.add("sizes", s.semi_axes, length("[a, b, c] semi-axes"));
}

static void describe(BoxShape& s, Fields& fields) {
  fields.name("box", "with rounded edges and corners");
  fields.add("sizes", s.half_sizes, length("[a, b, c] half sides"));
  fields.add("rounding", s.rounding,
             {.help = "radius of its edges", .unit = Unit::length, .range = at_least(0)});
}

static void describe(CylinderShape& s, Fields& fields) {
  fields.name("cylinder", "about z");
  fields.add("radius", s.radius, length(""));
  fields.add("height", s.half_height,
             {.help = "along z", .unit = Unit::length, .range = above(0), .factor = 2});
}

static void describe(ConeShape& s, Fields& fields) {
  fields.name("cone", "about z, from the disc of `radius` in z = 0 up to the disc of `top_radius`");
  fields.add("radius", s.radius, length("of its foot"));
  fields.add("height", s.height, length("along z"));
  fields.add("top_radius", s.top_radius,
             {.help = "0 for a point", .unit = Unit::length, .range = at_least(0)});
}

static void describe(CapsuleShape& s, Fields& fields) {
  fields.name("capsule", "a cylinder about z with half balls for ends");
  fields.add("radius", s.radius, length(""));
  fields.add(
      "height", s.half_height,
      {.help = "along z, without its ends", .unit = Unit::length, .range = above(0), .factor = 2});
}

static void describe(TorusShape& s, Fields& fields) {
  fields.name("torus", "about z");
  fields.add("radius", s.major, length("of the middle of its tube"));
  fields.add("minor", s.minor, length("of its tube"));
}

static void describe(PlaneShape&, Fields& fields) {
  fields.name("plane", "all that is below z = 0");
}

static void describe(BowlShape& s, Fields& fields) {
  fields.name("bowl", "half of a hollow ball, open towards z");
  fields.add("radius", s.radius, length("outside"));
  fields.add("thickness", s.thickness, length("of its wall"));
}

static void describe(SuperellipsoidShape& s, Fields& fields) {
  fields.name("superellipsoid", "from a ball over a pillow to a box");
  fields.add("sizes", s.semi_axes, length("[a, b, c] semi-axes"));
  fields.add_pair("exponents", s.e1, s.e2, exponents);
}

static void describe(SupertoroidShape& s, Fields& fields) {
  fields.name("supertoroid", "from a round to a square ring");
  fields.add("radius", s.major, length("of the middle of its tube"));
  fields.add("minor", s.semi_axes,
             {.help = "of its tube; or [across, along z]",
              .unit = Unit::length,
              .range = above(0),
              .uniform = true});
  fields.add_pair("exponents", s.e1, s.e2, exponents);
}

static void describe(SplineShape& s, Fields& fields) {
  fields.name("surface", "a surface of the document");
  fields.add("surface", s.surface);
}

static std::string_view tag_of(const Shape*) { return "shape"; }

template <>
const Type& type_of<Shape>() {
  return make_type<Shape>();
}

}  // namespace knead
