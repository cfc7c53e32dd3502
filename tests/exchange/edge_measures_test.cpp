// How faces at edges meet, beside pairs of surfaces of which that is known in closed form.
#include "knead/brep/edge_measures.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "exchange/edge_pair.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using brep::EdgeKind;
using brep::EdgeMeasures;
using brep::measure_edges;
using testing::Pair;
using testing::StepBuilder;

constexpr double degree = std::numbers::pi / 180;
constexpr double right = 0.01;  // what is promised, as a share of the figure

Surface surface_of(const KnotVector& u, const KnotVector& v,
                   const std::function<Point(int, int)>& at) {
  Points net(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) net.row(i * v.count() + j) = at(i, j).transpose();
  }
  return *Surface::create({u, v}, net);
}

/// Over x and y from 0 to 1 the height z0(y) + z2(y) x², whose Bézier heights are given.
Surface bowl(const std::vector<double>& edge, const std::vector<double>& rise) {
  const auto n = static_cast<int>(edge.size());
  return surface_of(KnotVector::clamped_uniform(2, 3).value(),
                    KnotVector::clamped_uniform(n - 1, n).value(), [&](int i, int j) {
                      const auto k = static_cast<std::size_t>(j);
                      return Point(i / 2.0, j / (n - 1.0), edge[k] + (i == 2 ? rise[k] : 0));
                    });
}

TEST(EdgeMeasures, PlanesWithAGapAndAnAngle) {
  for (const double angle : {0.003, 0.2, 3.0, 40.0, 90.0, 150.0}) {
    for (const bool against : {false, true}) {
      for (const bool turned : {false, true}) {
        const double gap = 0.01, s = std::sin(angle * degree), c = std::cos(angle * degree);
        Pair pair;
        const double sign = turned ? -1 : 1;
        const int tilted = pair.builder.plane({0, 0, gap}, {sign * -s, 0, sign * c}, {c, 0, s});
        const auto m = pair.between(pair.flat(), tilted, {true, !turned}, against);
        ASSERT_TRUE(m.gap && m.angle && m.off_curve) << m.reason;
        EXPECT_NEAR(m.gap->value, gap * std::abs(c), right * gap * std::abs(c) + 1e-15);
        EXPECT_NEAR(m.off_curve->value, m.gap->value, 1e-15) << "the edge is on the first plane";
        EXPECT_NEAR(m.angle->value, angle, right * angle);
        EXPECT_NEAR(m.length, 1, 1e-12);
        EXPECT_EQ(m.faces.size(), 2U);
        EXPECT_EQ(m.gap->at.parameters.size(), 2U);
        EXPECT_EQ(m.course, (std::vector{m.start, m.end})) << "straight";
      }
    }
  }
}

TEST(EdgeMeasures, ThePlaceIsGivenOnBothFaces) {
  Pair pair;
  const int plane = pair.flat();
  const Surface sheet = bowl({0, 0}, {0.25, 0.25});
  const auto m = pair.between(plane, pair.builder.surface(sheet, "sheet"));
  ASSERT_TRUE(m.curvature);
  const auto& at = m.curvature->at;
  EXPECT_NEAR(at.point[0], 0, 1e-15);
  EXPECT_NEAR(at.parameters[0][0], 0.5, 1e-12) << "the plane's origin is at x = -0.5";
  EXPECT_NEAR(at.parameters[0][1], at.point[1], 1e-12);
  EXPECT_NEAR(at.parameters[1][0], 0, 1e-12);
  EXPECT_NEAR(at.parameters[1][1], at.point[1], 1e-9) << "a fraction of its domain";
}

TEST(EdgeMeasures, ACylinderTangentToAPlane) {
  for (const double radius : {0.5, 3.0, 40.0}) {
    Pair pair;
    const int flat = pair.flat();
    const auto m = pair.between(flat, pair.cylinder(radius));
    ASSERT_TRUE(m.curvature && m.relative_curvature) << m.reason;
    EXPECT_NEAR(m.curvature->value, 1 / radius, right / radius);
    EXPECT_NEAR(m.relative_curvature->value, 100, 1);
    EXPECT_LE(m.angle->value, 1e-9);
    EXPECT_EQ(m.kind, EdgeKind::g1);
  }
}

TEST(EdgeMeasures, WhatIsNearlyFlatHasNoDifference) {
  Pair pair;
  const int flat = pair.flat();
  const auto m = pair.between(flat, pair.cylinder(3000));
  EXPECT_EQ(m.curvature->value, 0) << "1/3000 is below 1e-3 over the size, the square root of 5";
  EXPECT_EQ(m.kind, EdgeKind::g2);
}

TEST(EdgeMeasures, CylindersOfTwoRadii) {
  const double r = 2, q = 5;
  {
    Pair pair;
    const int first = pair.cylinder(r);
    const auto m = pair.between(first, pair.cylinder(q));
    EXPECT_NEAR(m.curvature->value, 1 / r - 1 / q, right * (1 / r - 1 / q));
    EXPECT_NEAR(m.relative_curvature->value, 100 * (q - r) / (q + r),
                right * 100 * (q - r) / (q + r));
    EXPECT_EQ(m.kind, EdgeKind::g1);
  }
  {
    Pair pair;
    const int first = pair.cylinder(r);
    const auto m = pair.between(first, pair.cylinder(q, false), {true, false});
    EXPECT_LE(m.angle->value, 1e-9);
    EXPECT_NEAR(m.curvature->value, 1 / r + 1 / q, right * (1 / r + 1 / q)) << "an inflection";
    EXPECT_NEAR(m.relative_curvature->value, 100, 1);
  }
  Pair same;
  const int first = same.cylinder(r);
  EXPECT_EQ(same.between(first, same.cylinder(r)).kind, EdgeKind::g2);
}

TEST(EdgeMeasures, SplinesWithABumpBetweenSamples) {
  // z(0, y) = h y (1 − y)², largest at y = 1/3: h 4/27.
  const double h = 0.02, bend = 0.35;
  Pair pair;
  const int plane = pair.flat();
  const auto sheet = bowl({0, h / 3, 0, 0}, {bend, bend, bend, bend});
  const auto m = pair.between(plane, pair.builder.surface(sheet, "bump"));
  EXPECT_NEAR(m.gap->value, h * 4 / 27, right * h * 4 / 27);
  EXPECT_NEAR(m.gap->at.point[1], 1.0 / 3, 0.02) << "where it is within a thousandth";
  EXPECT_NEAR(m.curvature->value, 2 * bend, right * 2 * bend);
  // Normals turn with the slope along the edge, largest at y = 0: h.
  EXPECT_NEAR(m.angle->value, std::atan(h) / degree, right * std::atan(h) / degree);
}

TEST(EdgeMeasures, CurvatureJumpsAtKnotsAcross) {
  // z = a(y) x² with a piecewise linear: its largest value is at the knot 0.4.
  const auto v = KnotVector::create(1, {0, 0, 0.4, 1, 1}).value();
  const std::array<double, 3> a = {0.1, 0.5, 0.2}, y = {0, 0.4, 1};
  const Surface sheet = surface_of(KnotVector::clamped_uniform(2, 3).value(), v, [&](int i, int j) {
    const auto k = static_cast<std::size_t>(j);
    return Point(i / 2.0, y[k], i == 2 ? a[k] : 0);
  });
  Pair pair;
  const int plane = pair.flat();
  const auto m = pair.between(plane, pair.builder.surface(sheet, "ridge"));
  EXPECT_NEAR(m.curvature->value, 1, right);
  EXPECT_NEAR(m.curvature->at.point[1], 0.4, 1e-3);
}

TEST(EdgeMeasures, AlongAKnotLineTheSideOfTheFaceCounts) {
  // One surface on both sides, flat for x < 0 and bent for x > 0; its knot line is the edge.
  const auto u = KnotVector::create(2, {-1, -1, -1, 0, 1, 1, 1}).value();
  const std::array<double, 4> x = {-1, -0.5, 0.5, 1}, z = {0, 0, 0, 0.4};
  const Surface sheet = surface_of(u, KnotVector::clamped_uniform(1, 2).value(), [&](int i, int j) {
    const auto k = static_cast<std::size_t>(i);
    return Point(x[k], j, z[k]);
  });
  Pair pair;
  const int id = pair.builder.surface(sheet, "half");
  const auto m = pair.between(id, id);
  EXPECT_LE(m.angle->value, 1e-6) << "normals are taken 1e-9 of the domain beside the knot";
  EXPECT_NEAR(m.curvature->value, 0.8, right * 0.8) << "z = 0.4 x² there";
  EXPECT_NEAR(m.relative_curvature->value, 100, 1);
}

TEST(EdgeMeasures, AnEdgeThatIsSmoothOnAPartOnly) {
  // z rises with x by 2 max(0, y − 1/2)² …: a twist that begins in the middle.
  const auto v = KnotVector::create(2, {0, 0, 0, 0.5, 1, 1, 1}).value();
  const std::array<double, 4> rise = {0, 0, 0, 0.4}, y = {0, 0.25, 0.75, 1};
  const Surface sheet = surface_of(KnotVector::clamped_uniform(1, 2).value(), v, [&](int i, int j) {
    const auto k = static_cast<std::size_t>(j);
    return Point(i, y[k], i == 1 ? rise[k] : 0);
  });
  Pair pair;
  const int plane = pair.flat();
  const auto m = pair.between(plane, pair.builder.surface(sheet, "twist"));
  EXPECT_EQ(m.kind, EdgeKind::partly);
  EXPECT_NEAR(m.angle->value, std::atan(0.4) / degree, right * 21.8);
  EXPECT_GT(m.smooth_share, 0.5);
  EXPECT_LT(m.smooth_share, 0.6);
  EXPECT_LE(*m.least_angle, 1e-9);
}

TEST(EdgeMeasures, OpenEdgesAreMeasuredFromTheirCurve) {
  Pair pair;
  const int plane = pair.builder.plane({0, 0, 0.25}, {0, 0, 1}, {1, 0, 0});
  const auto all = pair.measures(pair.flat(), plane);
  ASSERT_EQ(all.edges.size(), 7U);
  int open = 0;
  for (const EdgeMeasures& m : all.edges) {
    if (m.kind != EdgeKind::open) continue;
    ++open;
    EXPECT_EQ(m.faces.size(), 1U);
    EXPECT_FALSE(m.angle || m.curvature);
    EXPECT_NEAR(m.gap->value, m.middle[0] > 0 ? 0.25 : 0, 1e-15);
  }
  EXPECT_EQ(open, 6);
}

TEST(EdgeMeasures, TheSeamOfATubeWithACornerHasItsAngle) {
  // A triangle along y, whose corner at (0, ·, 0) is the seam: the normals turn by 120 degrees.
  const auto u = KnotVector::create(1, {0, 0, 1, 2, 3, 3}).value();
  const double h = std::sqrt(3) / 2;
  const std::array<std::array<double, 2>, 4> corner = {{{0, 0}, {0.5, h}, {-0.5, h}, {0, 0}}};
  const Surface tube = surface_of(u, KnotVector::clamped_uniform(1, 2).value(), [&](int i, int j) {
    const auto& [x, z] = corner[static_cast<std::size_t>(i)];
    return Point(x, j, z);
  });
  StepBuilder b;
  const int s = b.vertex(0, 0, 0), e = b.vertex(0, 1, 0);
  const int seam = b.line(s, e, {0, 0, 0}, {0, 1, 0});
  const auto ring = [&](int at, double y) {
    std::vector<int> ids;
    for (const auto& [x, z] : corner) ids.push_back(b.point(x, y, z));
    return b.edge(at, at, "POLYLINE('',(" + StepBuilder::list_of(ids) + "))");
  };
  const int low = ring(s, 0), high = ring(e, 1);
  b.face(b.surface(tube, "tube"), {b.bound({low, seam, -high, -seam})});
  const auto file = b.file();
  const auto measured = measure_edges(file.model());
  ASSERT_TRUE(measured);
  const auto found =
      std::ranges::find(measured->edges, "#" + std::to_string(seam), &EdgeMeasures::id);
  ASSERT_NE(found, measured->edges.end());
  EXPECT_EQ(found->kind, EdgeKind::seam);
  EXPECT_LE(found->gap->value, 1e-12);
  EXPECT_NEAR(found->angle->value, 120, 0.01);
  EXPECT_EQ(found->angle->at.parameters.size(), 2U);
}

TEST(EdgeMeasures, MoreThanTwoFacesAreNonManifold) {
  Pair pair;
  StepBuilder& b = pair.builder;
  const int s = b.vertex(0, 0, 0), e = b.vertex(0, 1, 0), edge = b.line(s, e, {0, 0, 0}, {0, 1, 0});
  for (const double angle : {0.0, 60.0, 180.0}) {
    const double x = std::cos(angle * degree), z = std::sin(angle * degree);
    const int p = b.vertex(x, 0, z), q = b.vertex(x, 1, z);
    b.face(b.plane({0, 0, 0}, {-z, 0, x}, {x, 0, z}),
           {b.bound({b.straight_edge(s, p, {0, 0, 0}, {x, 0, z}),
                     b.straight_edge(p, q, {x, 0, z}, {x, 1, z}),
                     b.straight_edge(q, e, {x, 1, z}, {0, 1, 0}), -edge})});
  }
  const auto file = b.file();
  const auto measured = measure_edges(file.model(), {}, std::vector{"#" + std::to_string(edge)});
  ASSERT_TRUE(measured && measured->edges.size() == 1);
  EXPECT_EQ(measured->edges[0].kind, EdgeKind::non_manifold);
  EXPECT_EQ(measured->edges[0].faces.size(), 3U);
  EXPECT_NEAR(measured->edges[0].angle->value, 180 - 60, 1e-6);
}

TEST(EdgeMeasures, DoNotDependOnTheNumberOfThreads) {
  const auto run = [] {
    Pair pair;
    const int plane = pair.flat();
    const auto sheet = bowl({0, 0.01, 0, 0}, {0.1, 0.3, 0.2, 0.4});
    const auto all = pair.measures(plane, pair.builder.surface(sheet, "bump"));
    return brep::check_json({.thresholds = {}, .edges = all.edges});
  };
  const std::string by_one = testing::with_threads(1, run);
  for (const int threads : testing::thread_counts)
    EXPECT_EQ(testing::with_threads(threads, run), by_one) << threads;
}

TEST(EdgeMeasures, AnEdgeThatThereIsNotIsAnError) {
  Pair pair;
  const int plane = pair.flat();
  pair.between(plane, plane);
  const auto file = pair.builder.file();
  const auto none = measure_edges(file.model(), {}, std::vector<std::string>{pair.edge, "#7"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().where, "#7");
}

}  // namespace
}  // namespace knead
