#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/made_iges.hpp"
#include "support/made_step.hpp"

namespace knead::testing {

// A block over [0, 4] × [0, 2] whose roof is two B-spline faces that meet smoothly at x = 2. Both
// lie on the biquadratic z = 1 + 0.1 x (4 − x) + 0.15 y (2 − y), whose polar forms give the control
// points of patches and edges exactly.
inline double roof_x(double a, double b) { return 0.1 * (2 * (a + b) - a * b); }
inline double roof_y(double a, double b) { return 0.15 * (a + b - a * b); }
inline double roof(double x, double y) { return 1 + roof_x(x, x) + roof_y(y, y); }

/// The roof over a rectangle, bicubic with `spans` even spans along x and y.
inline Surface roof_patch(std::array<double, 2> x, std::array<double, 2> y,
                          std::array<int, 2> spans) {
  const auto at = [](const std::array<double, 2>& side, int k) {
    return std::pair(side[k > 1], side[k > 0]);
  };
  Points points(9, 3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto [a, b] = at(x, i);
      const auto [c, d] = at(y, j);
      points.row(3 * i + j) << (a + b) / 2, (c + d) / 2, 1 + roof_x(a, b) + roof_y(c, d);
    }
  }
  const KnotVector quadratic = *KnotVector::clamped_uniform(2, 3);
  Surface result = *Surface::create({quadratic, quadratic}, points);
  std::array<std::vector<double>, 2> knots;
  for (std::size_t d = 0; d < 2; ++d) {
    result = *elevate_degree(result, static_cast<int>(d));
    for (int k = 1; k < spans[d]; ++k) knots[d].push_back(static_cast<double>(k) / spans[d]);
  }
  return *insert_knots<2>(result, {knots[0], knots[1]});
}

/// Returns the solid.
inline int block(StepBuilder& b) {
  constexpr std::array<std::array<double, 2>, 4> corner = {{{0, 0}, {4, 0}, {4, 2}, {0, 2}}};
  std::array<int, 4> low, high, floor, post;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [x, y] = corner[k];
    low[k] = b.vertex(x, y, 0);
    high[k] = b.vertex(x, y, roof(x, y));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [x, y] = corner[k];
    const auto [u, v] = corner[(k + 1) % 4];
    floor[k] = b.straight_edge(low[k], low[(k + 1) % 4], {x, y, 0}, {u, v, 0});
    post[k] = b.straight_edge(low[k], high[k], {x, y, 0}, {x, y, roof(x, y)});
  }
  const int south = b.vertex(2, 0, roof(2, 0)), north = b.vertex(2, 2, roof(2, 2));
  const auto along_x = [&](int from, int to, double a, double c, double y) {
    const double rise = 1 + roof_y(y, y);
    return b.bezier_edge(from, to,
                         {{a, y, rise + roof_x(a, a)},
                          {(a + c) / 2, y, rise + roof_x(a, c)},
                          {c, y, rise + roof_x(c, c)}});
  };
  const auto along_y = [&](int from, int to, double x) {
    const double rise = 1 + roof_x(x, x);
    return b.bezier_edge(from, to,
                         {{x, 0, rise}, {x, 1, rise + roof_y(0, 2)}, {x, 2, rise + roof_y(2, 2)}});
  };
  const int south_west = along_x(high[0], south, 0, 2, 0),
            south_east = along_x(south, high[1], 2, 4, 0);
  const int north_west = along_x(high[3], north, 0, 2, 2),
            north_east = along_x(north, high[2], 2, 4, 2);
  const int west = along_y(high[0], high[3], 0), middle = along_y(south, north, 2),
            east = along_y(high[1], high[2], 4);
  std::vector<int> faces;
  faces.push_back(b.face(b.plane({0, 0, 0}, {0, 0, -1}, {1, 0, 0}),
                         {b.bound({-floor[3], -floor[2], -floor[1], -floor[0]})}));
  faces.push_back(b.face(b.plane({0, 0, 0}, {0, -1, 0}, {1, 0, 0}),
                         {b.bound({floor[0], post[1], -south_east, -south_west, -post[0]})}));
  faces.push_back(b.face(b.plane({4, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                         {b.bound({floor[1], post[2], -east, -post[1]})}));
  faces.push_back(b.face(b.plane({0, 2, 0}, {0, 1, 0}, {1, 0, 0}),
                         {b.bound({floor[2], post[3], north_west, north_east, -post[2]})}));
  faces.push_back(b.face(b.plane({0, 0, 0}, {-1, 0, 0}, {0, 1, 0}),
                         {b.bound({floor[3], post[0], west, -post[3]})}));
  faces.push_back(b.face(b.surface(roof_patch({-1, 3}, {-1, 3}, {4, 4}), "west roof"),
                         {b.bound({south_west, middle, -north_west, -west})}));
  faces.push_back(b.face(b.surface(roof_patch({1, 6}, {-0.5, 2.5}, {5, 3}), "east roof"),
                         {b.bound({south_east, east, -north_east, -middle})}));
  const int shell = b.entity("CLOSED_SHELL('',(" + StepBuilder::list_of(faces) + "))");
  return b.entity(fmt::format("MANIFOLD_SOLID_BREP('block',#{})", shell));
}

/// A bulging tube about the z axis with two flat caps: one rational surface, closed in u, with a
/// seam. Returns the solid.
inline int tube(StepBuilder& b, double radius, double height) {
  const std::vector<std::array<double, 3>> profile = {{radius, 0, 0},
                                                      {1.2 * radius, 0, height / 3},
                                                      {1.2 * radius, 0, 2 * height / 3},
                                                      {radius, 0, height}};
  Points points(4, 3);
  for (int k = 0; k < 4; ++k)
    points.row(k) =
        Eigen::Map<const Eigen::RowVector3d>(profile[static_cast<std::size_t>(k)].data());
  const Curve curve = *Curve::create({*KnotVector::clamped_uniform(3, 4)}, points);
  const Surface side = *revolve(*insert_knots<1>(curve, {std::vector<double>{0.5}}));
  const int low = b.vertex(radius, 0, 0), high = b.vertex(radius, 0, height);
  const auto circle = [&](int vertex, double z) {
    return b.edge(vertex, vertex,
                  fmt::format("CIRCLE('',#{},{})", b.frame(0, 0, z), StepBuilder::real(radius)));
  };
  const int below = circle(low, 0), above = circle(high, height),
            seam = b.bezier_edge(low, high, profile);
  const std::vector<int> faces = {
      b.face(b.surface(side, "side"), {b.bound({below, seam, -above, -seam})}),
      b.face(b.plane({0, 0, 0}, {0, 0, -1}, {1, 0, 0}), {b.bound({-below})}),
      b.face(b.plane({0, 0, height}, {0, 0, 1}, {1, 0, 0}), {b.bound({above})})};
  const int shell = b.entity("CLOSED_SHELL('',(" + StepBuilder::list_of(faces) + "))");
  return b.entity(fmt::format("MANIFOLD_SOLID_BREP('tube',#{})", shell));
}

inline constexpr const char* ap203 = "CONFIG_CONTROL_DESIGN";
inline constexpr const char* ap214 = "AUTOMOTIVE_DESIGN { 1 0 10303 214 3 1 1 1 }";

inline std::string block_file() {
  StepBuilder b;
  b.product("Geh\\X2\\00E4\\X0\\use", "ADVANCED_BREP_SHAPE_REPRESENTATION", {block(b)},
            b.context("inch"));
  return b.backward(ap203);
}

inline std::string tube_file() {
  StepBuilder b;
  b.product("tube", "ADVANCED_BREP_SHAPE_REPRESENTATION", {tube(b, 0.3, 0.9)}, b.context("m"));
  return b.forward(ap214);
}

/// Two blocks and three tubes in inch, one of the tubes turned.
inline std::string assembly_file() {
  StepBuilder b;
  const int context = b.context("inch");
  const auto part = b.product("block", "ADVANCED_BREP_SHAPE_REPRESENTATION", {block(b)}, context);
  const auto bush =
      b.product("bush", "ADVANCED_BREP_SHAPE_REPRESENTATION", {tube(b, 0.5, 1)}, context);
  std::vector<int> places;
  for (const double y : {0.0, 5.0}) places.push_back(b.placement({0, y, 0}, {0, 0, 1}, {1, 0, 0}));
  for (const double x : {-1.0, 5.0})
    places.push_back(b.placement({x, 1, 0.25}, {0, 0, 1}, {0, 1, 0}));
  places.push_back(b.placement({2, 1, 3}, {1, 0, 0}, {0, 1, 0}));
  const auto whole = b.product("assembly", "SHAPE_REPRESENTATION", places, context);
  for (std::size_t k = 0; k < places.size(); ++k) {
    b.place(k < 2 ? part : bush, whole, places[k],
            fmt::format("{} {}", k < 2 ? "block" : "bush", k));
  }
  return b.forward(ap214);
}

inline std::string open_shell_file(StepBuilder& b, int face, const std::string& unit) {
  const int shell = b.entity(fmt::format("OPEN_SHELL('',(#{}))", face));
  const int model = b.entity(fmt::format("SHELL_BASED_SURFACE_MODEL('',(#{}))", shell));
  b.product("shell", "MANIFOLD_SURFACE_SHAPE_REPRESENTATION", {model}, b.context(unit));
  return b.forward(ap203);
}

/// Half a sphere: a rational surface with a pole, which a VERTEX_LOOP bounds.
inline std::string dome_file() {
  StepBuilder b;
  const Surface half = *revolve(*circle_quarters({0, 0}, 2, 0, 1));
  const int face =
      b.face(b.surface(half, "dome"), {b.vertex_bound(0, 0, 2), b.bound({b.circle(2, 0)})});
  return open_shell_file(b, face, "m");
}

/// A strip [0, 10] × [0, 5] that bulges inside; its file lists the knot ½ twice, once each.
inline std::string strip_file() {
  Points points(15, 3);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 3; ++j)
      points.row(3 * i + j) << 2.5 * i, 2.5 * j, i % 4 == 0 || j != 1 ? 0 : 1;
  }
  const Surface s = *Surface::create(
      {*KnotVector::create(2, {0, 0, 0, 0.5, 0.5, 1, 1, 1}), *KnotVector::clamped_uniform(2, 3)},
      points);
  StepBuilder b;
  constexpr std::array<std::array<double, 3>, 4> corner = {
      {{0, 0, 0}, {10, 0, 0}, {10, 5, 0}, {0, 5, 0}}};
  std::array<int, 4> vertex;
  std::vector<int> edges;
  for (std::size_t k = 0; k < 4; ++k)
    vertex[k] = b.vertex(corner[k][0], corner[k][1], corner[k][2]);
  for (std::size_t k = 0; k < 4; ++k) {
    edges.push_back(
        b.straight_edge(vertex[k], vertex[(k + 1) % 4], corner[k], corner[(k + 1) % 4]));
  }
  std::string text = open_shell_file(b, b.face(b.surface(s, "strip"), {b.bound(edges)}), "mm");
  const auto half = "," + StepBuilder::real(0.5);
  text.replace(text.find("(3,2,3)"), 7, "(3,1,1,3)");
  text.insert(text.find(half, text.find("(3,1,1,3)")), half);
  return text;
}

/// A scope of Part 21's first edition, and surfaces with implied knots, which no face uses.
inline std::string scope_file() {
  StepBuilder b;
  const int context = b.context("mm");
  b.product("scope", "SHAPE_REPRESENTATION", {90, 91}, context);
  std::string text = b.forward(ap203);
  const std::string scope =
      "#80=&SCOPE\n#81=CARTESIAN_POINT('',(2.,0.,0.));\n#82=CARTESIAN_POINT('',(3.,0.,1.));\n"
      "#83=BEZIER_CURVE('scoped',1,(#81,#82),.UNSPECIFIED.,.F.,.F.);\n"
      "ENDSCOPE /#83/ GEOMETRIC_CURVE_SET('',(#83));\n";
  const std::string bare =
      unit_square_points() +
      "#90=BEZIER_SURFACE('b',1,1,((#1,#2),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n"
      "#5=CARTESIAN_POINT('',(.5,.5,1.));\n"
      "#91=QUASI_UNIFORM_SURFACE('q',2,1,((#1,#2),(#5,#5),(#3,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n";
  text.insert(text.rfind("ENDSEC"), scope);
  return text.insert(text.find("#100="), bare);
}

inline const std::vector<MadeFile> made_step_files = {
    {"made_block.stp", block_file},       {"made_tube.step", tube_file},
    {"made_assembly.stp", assembly_file}, {"made_dome.stp", dome_file},
    {"made_strip.stp", strip_file},       {"made_scope.stp", scope_file}};

}  // namespace knead::testing
