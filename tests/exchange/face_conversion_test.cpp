#include "exchange/step/conversion.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "brep/shared_edge.hpp"
#include "exchange/two_sheets.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::step {
namespace {

using namespace brep;  // NOLINT: what is tested
using testing::FaceBuilder;
using testing::parse_or_die;

constexpr double pi = std::numbers::pi;

/// Of rounding: every control point is a few products and sums of numbers of that size.
constexpr double exact = 1e-14;

/// The distance of a point from the analytic surface, and the gradient of what is zero on it,
/// towards its normal.
struct Analytic {
  std::function<double(const Point&)> distance;
  std::function<Point(const Point&)> normal;
};

Surface converted(const File& file, int surface) {
  auto made = exact_spline(file.model(), "#" + std::to_string(surface));
  if (!made) {
    ADD_FAILURE() << made.error().message();
    std::abort();
  }
  return *std::move(made);
}

/// At 41 × 41 points: on the analytic surface to rounding, and the normal on its side.
void expect_exact(const Surface& surface, const Analytic& truth, double size) {
  const auto u = surface.knots(0).domain(), v = surface.knots(1).domain();
  constexpr int n = 40;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      Parameters<2> at(1, 2);
      at << (i == n ? u.upper : u.lower + u.length() * i / n),
          (j == n ? v.upper : v.lower + v.length() * j / n);
      const auto jet = evaluate<2>(surface, at, 1);
      ASSERT_TRUE(jet) << jet.error().message();
      const Point p = jet->at({0, 0}).row(0);
      EXPECT_LE(std::abs(truth.distance(p)), exact * size) << "at " << at;
      const Point n_at = Point(jet->at({1, 0}).row(0)).cross(Point(jet->at({0, 1}).row(0)));
      if (n_at.norm() > 1e-6 * size) {
        EXPECT_GT(n_at.normalized().dot(truth.normal(p)), 1 - 1e-9) << "at " << at;
      }
    }
  }
}

/// Every edge of its faces but the seam is on it, also between the points at which it was followed.
void expect_covers(const File& file, int surface) {
  const std::string id = "#" + std::to_string(surface);
  const auto after = with_splines(file, {&id, 1});
  ASSERT_TRUE(after) << after.error().message();
  const auto region = visible_region(after->model(), id);
  ASSERT_TRUE(region) << region.error().message();
  ASSERT_FALSE(region->edges.empty());
  for (const TrimEdge& edge : region->edges) {
    if (edge.seam) continue;
    const auto course = SharedEdge::create(after->model(), edge.id);
    ASSERT_TRUE(course) << course.error().message();
    EXPECT_LE(course->gap(), 1e-12) << edge.id << ": to which feet are found";
  }
}

Analytic cylinder(double radius) {
  return {[=](const Point& p) { return std::hypot(p.x(), p.y()) - radius; },
          [](const Point& p) { return Point(p.x(), p.y(), 0).normalized(); }};
}

std::string at_origin(FaceBuilder& b) { return "#" + std::to_string(b.frame()); }

/// A sector of a surface of revolution between two angles and two heights, bounded by arcs and
/// straight lines.
int sector(FaceBuilder& b, int surface, double r0, double z0, double r1, double z1, double from,
           double to) {
  const auto at = [](double r, double z, double angle) {
    return std::array<double, 3>{r * std::cos(angle), r * std::sin(angle), z};
  };
  const auto vertex = [&](const auto& p) { return b.vertex(p[0], p[1], p[2]); };
  const auto arc = [&](double r, double z, int a, int c) {
    return b.edge(
        a, c, "CIRCLE('',#" + std::to_string(b.frame(0, 0, z)) + "," + FaceBuilder::real(r) + ")");
  };
  const auto line = [&](int a, int c, const auto& p, const auto& q) {
    return b.line(a, c, p, {q[0] - p[0], q[1] - p[1], q[2] - p[2]});
  };
  const auto p = at(r0, z0, from), q = at(r0, z0, to), r = at(r1, z1, to), s = at(r1, z1, from);
  const int a = vertex(p), c = vertex(q), d = vertex(r), e = vertex(s);
  const int lower = arc(r0, z0, a, c), right = line(c, d, q, r), upper = arc(r1, z1, e, d),
            left = line(e, a, s, p);
  return b.face(surface, {b.bound({lower, right, -upper, left})});
}

/// A whole turn, bounded by two circles and a seam at angle 0.
int tube(FaceBuilder& b, int surface, double r0, double z0, double r1, double z1) {
  const int a = b.vertex(r0, 0, z0), c = b.vertex(r1, 0, z1);
  const auto circle = [&](double r, double z, int v) {
    return b.edge(
        v, v, "CIRCLE('',#" + std::to_string(b.frame(0, 0, z)) + "," + FaceBuilder::real(r) + ")");
  };
  const int lower = circle(r0, z0, a), upper = circle(r1, z1, c);
  const int seam = b.line(a, c, {r0, 0, z0}, {r1 - r0, 0, z1 - z0});
  return b.face(surface, {b.bound({lower, seam, -upper, -seam})});
}

TEST(ExactSpline, OfAPlaneIsTheRectangleOfEdgesThatAreParallelToOneAnother) {
  // Turned by 0.3 against the axes of the plane's placement.
  FaceBuilder b;
  const double c = std::cos(0.3), s = std::sin(0.3);
  const std::array<std::array<double, 3>, 4> corner = {{{1, 2, 5},
                                                        {1 + 4 * c, 2 + 4 * s, 5},
                                                        {1 + 4 * c - 3 * s, 2 + 4 * s + 3 * c, 5},
                                                        {1 - 3 * s, 2 + 3 * c, 5}}};
  std::array<int, 4> v{}, e{};
  for (std::size_t k = 0; k < 4; ++k) v[k] = b.vertex(corner[k][0], corner[k][1], corner[k][2]);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &p = corner[k], &q = corner[(k + 1) % 4];
    e[k] = b.line(v[k], v[(k + 1) % 4], p, {q[0] - p[0], q[1] - p[1], 0});
  }
  const int plane = b.entity("PLANE('floor',#" + std::to_string(b.frame(7, -3, 5)) + ")");
  b.face(plane, {b.bound({e[0], e[1], e[2], e[3]})});
  const File file = b.file();
  const Surface made = converted(file, plane);
  EXPECT_EQ(made.net(), (std::array{2, 2}));
  EXPECT_FALSE(made.rational());
  for (const auto& p : corner) {
    const Point point(p[0], p[1], p[2]);
    EXPECT_LE((made.control_points().rowwise() - point.transpose()).rowwise().norm().minCoeff(),
              exact * 10);
  }
  expect_exact(made,
               {[](const Point& p) { return p.z() - 5; },
                [](const Point&) { return Point(Point::UnitZ()); }},
               10);
  expect_covers(file, plane);
  const std::string id = "#" + std::to_string(plane);
  EXPECT_FALSE(with_splines(file, {&id, 1})->model().find_surface(id)->trimmed);
}

TEST(ExactSpline, OfAPlaneGoesAFiftiethBeyondACurvedEdge) {
  FaceBuilder b;
  const int plane = b.entity("PLANE(''," + at_origin(b) + ")");
  b.face(plane, {b.bound({b.circle(2, 0, 3, 1)})});
  const File file = b.file();
  const Points net = converted(file, plane).control_points();
  EXPECT_NEAR(net.col(0).minCoeff(), 1 - 0.08, 1e-3);
  EXPECT_NEAR(net.col(1).maxCoeff(), 3 + 0.08, 1e-3);
  expect_covers(file, plane);
}

TEST(ExactSpline, OfACylinderIsTheSectorBetweenItsEdges) {
  FaceBuilder b;
  const int surface = b.entity("CYLINDRICAL_SURFACE(''," + at_origin(b) + ",2.5)");
  sector(b, surface, 2.5, 1, 2.5, 4, 0.5, 2.9);
  const File file = b.file();
  const Surface made = converted(file, surface);
  EXPECT_EQ(made.net(), (std::array{5, 2}));
  EXPECT_NEAR(made.knots(0).domain().lower, 0.5, 1e-12);
  EXPECT_NEAR(made.knots(0).domain().upper, 2.9, 1e-12);
  expect_exact(made, cylinder(2.5), 5);
  expect_covers(file, surface);
}

TEST(ExactSpline, OfAWholeCylinderIsClosedBitForBitAtItsSeam) {
  FaceBuilder b;
  const int surface = b.entity("CYLINDRICAL_SURFACE(''," + at_origin(b) + ",2.5)");
  tube(b, surface, 2.5, 0, 2.5, 4);
  const File file = b.file();
  const Surface made = converted(file, surface);
  EXPECT_EQ(made.net(), (std::array{9, 2}));
  const Points& net = made.control_points();
  EXPECT_EQ(net.topRows(2), net.bottomRows(2));
  expect_exact(made, cylinder(2.5), 5);
  const std::string id = "#" + std::to_string(surface);
  const auto after = with_splines(file, {&id, 1});
  ASSERT_TRUE(after);
  EXPECT_EQ(after->model().find_surface(id)->closed, (std::array{true, false}));
  EXPECT_FALSE(after->model().find_surface(id)->trimmed);
}

TEST(ExactSpline, OfAConeEndsAtItsApex) {
  FaceBuilder b;
  const int surface =
      b.entity("CONICAL_SURFACE(''," + at_origin(b) + ",2.," + FaceBuilder::real(pi / 6) + ")");
  const double t = std::tan(pi / 6), apex = -2 / t;
  tube(b, surface, 2 - 0.5 * t, -0.5, 2 + 3 * t, 3);
  const int tip =
      b.entity("CONICAL_SURFACE(''," + at_origin(b) + ",2.," + FaceBuilder::real(pi / 6) + ")");
  const int v = b.vertex(2, 0, 0);
  const int rim = b.edge(v, v, "CIRCLE(''," + at_origin(b) + ",2.)");
  b.face(tip, {b.bound({-rim}), b.vertex_bound(0, 0, apex)});
  const File file = b.file();
  const Analytic truth = {[=](const Point& p) {
                            return (std::hypot(p.x(), p.y()) - (2 + p.z() * t)) * std::cos(pi / 6);
                          },
                          [=](const Point& p) {
                            const double r = std::hypot(p.x(), p.y());
                            return Point(p.x() / r, p.y() / r, -t).normalized();
                          }};
  expect_exact(converted(file, surface), truth, 8);
  expect_covers(file, surface);
  const Surface to_apex = converted(file, tip);
  expect_exact(to_apex, truth, 8);
  for (Eigen::Index k = 0; k < to_apex.size(); k += 2) {
    EXPECT_EQ(to_apex.control_points().row(k), to_apex.control_points().row(0))
        << "one point at the apex";
  }
  EXPECT_NEAR(to_apex.control_points()(0, 2), apex, exact * 8);
}

TEST(ExactSpline, OfAWholeSphereHasItsPoles) {
  FaceBuilder b;
  const int surface =
      b.entity("SPHERICAL_SURFACE('',#" + std::to_string(b.frame(1, 2, 3)) + ",2.)");
  b.face(surface, {b.vertex_bound(1, 2, 5)});
  const Surface made = converted(b.file(), surface);
  EXPECT_EQ(made.net(), (std::array{9, 5}));
  const Point centre(1, 2, 3);
  expect_exact(made,
               {[=](const Point& p) { return (p - centre).norm() - 2; },
                [=](const Point& p) { return (p - centre).normalized(); }},
               7);
}

TEST(ExactSpline, OfACapOfASphereReachesOnePole) {
  FaceBuilder b;
  const int surface = b.entity("SPHERICAL_SURFACE(''," + at_origin(b) + ",2.)");
  const double z = 1.2, r = std::sqrt(4 - z * z);
  b.face(surface, {b.bound({b.circle(r, z)})});
  const File file = b.file();
  const Surface made = converted(file, surface);
  EXPECT_NEAR(made.knots(1).domain().lower, std::asin(z / 2), 1e-12);
  EXPECT_EQ(made.knots(1).domain().upper, pi / 2);
  expect_exact(
      made,
      {[](const Point& p) { return p.norm() - 2; }, [](const Point& p) { return p.normalized(); }},
      2);
  expect_covers(file, surface);
}

Analytic torus(double major, double minor) {
  const auto from_ring = [=](const Point& p) {
    return Point(p - major * Point(p.x(), p.y(), 0).normalized());
  };
  return {[=](const Point& p) { return from_ring(p).norm() - minor; },
          [=](const Point& p) { return from_ring(p).normalized(); }};
}

TEST(ExactSpline, OfATorusIsWholeOrAPart) {
  FaceBuilder b;
  const int part = b.entity("TOROIDAL_SURFACE(''," + at_origin(b) + ",5.,1.5)");
  b.face(part, {b.bound({b.circle(6.5, 0)}), b.bound({-b.circle(5, 1.5)})});
  const int whole = b.entity("TOROIDAL_SURFACE(''," + at_origin(b) + ",5.,1.5)");
  const int v = b.vertex(6.5, 0, 0);
  const int ring = b.edge(v, v, "CIRCLE(''," + at_origin(b) + ",6.5)");
  const int frame = b.entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(b.point(5, 0, 0)) + ",#" +
                             std::to_string(b.direction(0, -1, 0)) + ",#" +
                             std::to_string(b.direction(1, 0, 0)) + ")");
  const int tube_edge = b.edge(v, v, "CIRCLE('',#" + std::to_string(frame) + ",1.5)");
  b.face(whole, {b.bound({ring, tube_edge, -ring, -tube_edge})});
  const File file = b.file();
  const Surface quarter = converted(file, part), all = converted(file, whole);
  EXPECT_EQ(quarter.net(), (std::array{9, 3}));
  EXPECT_EQ(all.net(), (std::array{9, 9}));
  for (const Surface& made : {quarter, all}) expect_exact(made, torus(5, 1.5), 13);
  expect_covers(file, part);
}

TEST(ExactSpline, OfAnExtrusionSweepsItsCurve) {
  FaceBuilder b;
  const int direction = b.direction(0, 0, 1);
  const int vector = b.entity("VECTOR('',#" + std::to_string(direction) + ",3.)");
  const int ellipse = b.entity("ELLIPSE(''," + at_origin(b) + ",4.,2.)");
  const int surface = b.entity("SURFACE_OF_LINEAR_EXTRUSION('',#" + std::to_string(ellipse) + ",#" +
                               std::to_string(vector) + ")");
  // From angle 0 to a right angle, heights 1 to 2.
  const int a = b.vertex(4, 0, 1), c = b.vertex(0, 2, 1), d = b.vertex(0, 2, 2),
            e = b.vertex(4, 0, 2);
  const auto arc = [&](int from, int to, double z) {
    return b.edge(from, to, "ELLIPSE('',#" + std::to_string(b.frame(0, 0, z)) + ",4.,2.)");
  };
  b.face(surface, {b.bound({arc(a, c, 1), b.line(c, d, {0, 2, 1}, {0, 0, 1}), -arc(e, d, 2),
                            b.line(e, a, {4, 0, 2}, {0, 0, -1})})});
  const File file = b.file();
  const Surface made = converted(file, surface);
  EXPECT_EQ(made.net(), (std::array{3, 2}));
  const Point lower = made.control_points().colwise().minCoeff(),
              upper = made.control_points().colwise().maxCoeff();
  EXPECT_NEAR(lower.z(), 1, exact * 4);
  EXPECT_NEAR(upper.z(), 2, exact * 4);
  expect_exact(made,
               {[](const Point& p) { return std::hypot(p.x() / 4, p.y() / 2) - 1; },
                [](const Point& p) { return Point(p.x() / 16, p.y() / 4, 0).normalized(); }},
               4);
  expect_covers(file, surface);
}

TEST(ExactSpline, OfARevolutionTurnsItsCurve) {
  // A line askew to the axis sweeps the hyperboloid x² + y² = 1 + z².
  FaceBuilder b;
  const int vector = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 1, 1)) + ",1.)");
  const int line = b.entity("LINE('',#" + std::to_string(b.point(1, 0, 0)) + ",#" +
                            std::to_string(vector) + ")");
  const int axis = b.entity("AXIS1_PLACEMENT('',#" + std::to_string(b.point(0, 0, 0)) + ",$)");
  const int surface = b.entity("SURFACE_OF_REVOLUTION('',#" + std::to_string(line) + ",#" +
                               std::to_string(axis) + ")");
  b.face(surface,
         {b.bound({b.circle(std::sqrt(2.0), 1)}), b.bound({-b.circle(std::sqrt(5.0), 2)})});
  const File file = b.file();
  const Surface made = converted(file, surface);
  EXPECT_EQ(made.net(), (std::array{9, 2}));
  expect_exact(made,
               {[](const Point& p) { return std::hypot(p.x(), p.y()) - std::hypot(1, p.z()); },
                [](const Point& p) { return Point(p.x(), p.y(), -p.z()).normalized(); }},
               3);
}

TEST(ExactSpline, OfSeveralFacesOnOneCylinderCoversThemAll) {
  FaceBuilder b;
  const int surface = b.entity("CYLINDRICAL_SURFACE(''," + at_origin(b) + ",1.)");
  sector(b, surface, 1, 0, 1, 1, 5.5, 6.5);
  sector(b, surface, 1, 2, 1, 3, 0.1, 1.5);
  const Surface made = converted(b.file(), surface);
  EXPECT_NEAR(made.knots(0).domain().length(), 1.5 + 2 * pi - 5.5, 1e-12);
  EXPECT_NEAR(made.knots(1).domain().length(), 3, 1e-12);

  FaceBuilder halves;
  const int both = halves.entity("CYLINDRICAL_SURFACE(''," + at_origin(halves) + ",1.)");
  sector(halves, both, 1, 0, 1, 1, 0.7, 0.7 + pi);
  sector(halves, both, 1, 0, 1, 1, 0.7 + pi, 0.7 + 2 * pi);
  const Surface whole = converted(halves.file(), both);
  EXPECT_NEAR(whole.knots(0).domain().length(), 2 * pi, 1e-12);
  EXPECT_EQ(whole.control_points().topRows(2), whole.control_points().bottomRows(2));
  EXPECT_NEAR(std::remainder(whole.knots(0).domain().lower - 0.7, pi), 0, 1e-9)
      << "the seam is at an edge";
}

TEST(ExactSpline, WhatCannotBeConvertedIsSaid) {
  const File file = parse_or_die(testing::two_sheets(false, true).text);
  const auto spline = exact_spline(file.model(), "#10");
  ASSERT_FALSE(spline);
  EXPECT_NE(spline.error().what.find("B-spline surface already"), std::string::npos);
  const auto unknown = exact_spline(file.model(), "#999");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::input);
  FaceBuilder b;
  const int plane = b.entity("PLANE(''," + at_origin(b) + ")");
  const int offset = b.entity("OFFSET_SURFACE('',#" + std::to_string(plane) + ",1.,.F.)");
  b.face(offset, {b.bound({b.circle(2, 1)})});
  const File other = b.file();
  ASSERT_EQ(other_surfaces(other.model()).size(), 1U);
  EXPECT_EQ(other_surfaces(other.model())[0].form, "OFFSET_SURFACE");
  EXPECT_FALSE(exact_spline(other.model(), other_surfaces(other.model())[0].id));
}

}  // namespace
}  // namespace knead::step
