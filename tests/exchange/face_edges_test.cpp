#include "knead/brep/face_edges.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "exchange/face_builder.hpp"

namespace knead {
namespace {

using testing::FaceBuilder;
using testing::on_square;
using testing::square;

TEST(FaceEdges, ASurfaceWithoutAFaceIsWholeWithinItsSides) {
  const auto region =
      visible_region(testing::parse_or_die(testing::step_text(square)).model(), "#10");
  ASSERT_TRUE(region);
  EXPECT_TRUE(region->faces.empty());
  std::vector<std::string> sides;
  for (const TrimEdge& edge : region->edges) {
    sides.push_back(edge.id);
    EXPECT_TRUE(edge.neighbours.empty());
    EXPECT_EQ(edge.deviation, 0);
    const auto d = edge.id[0] == 'u' ? 0 : 1;
    for (const auto& at : edge.course) EXPECT_EQ(at[d], edge.id[1] == '0' ? 0 : 1);
    EXPECT_EQ(edge.course.front()[1 - d], 0);
    EXPECT_EQ(edge.course.back()[1 - d], 1);
  }
  EXPECT_EQ(sides, (std::vector<std::string>{"u0", "u1", "v0", "v1"}));
  EXPECT_FALSE(region->in_shell);
}

TEST(FaceEdges, AnUnknownSurfaceIsNamed) {
  const auto region =
      visible_region(testing::parse_or_die(testing::step_text(square)).model(), "#11");
  ASSERT_FALSE(region);
  EXPECT_EQ(region.error().where, "#11");
}

TEST(FaceEdges, ACircleIsFollowedInParametersAndKeepsItsName) {
  FaceBuilder b;
  const int circle = b.circle(0.4, 0, 0.5, 0.5);
  const int face = b.face(10, {b.bound({circle})});
  b.entity("OPEN_SHELL('',(#" + std::to_string(face) + "))");
  const auto region = visible_region(on_square(b).model(), "#10");
  ASSERT_TRUE(region) << region.error().message();
  EXPECT_TRUE(region->in_shell);
  ASSERT_EQ(region->edges.size(), 1U);
  const TrimEdge& edge = region->edges[0];
  EXPECT_EQ(edge.id, "#" + std::to_string(circle));
  EXPECT_FALSE(edge.seam);
  ASSERT_EQ(edge.course.size(), edge.points.size());
  for (std::size_t k = 0; k + 1 < edge.course.size(); ++k) {
    EXPECT_NEAR((edge.course[k] - Eigen::Vector2d(0.5, 0.5)).norm(), 0.4, 1e-9);
    // The middles of the chords too, to the deviation that is stated.
    EXPECT_NEAR((0.5 * (edge.course[k] + edge.course[k + 1]) - Eigen::Vector2d(0.5, 0.5)).norm(),
                0.4, edge.deviation);
  }
  EXPECT_LE(edge.deviation, 1e-3);
  EXPECT_TRUE(region->contains({0.5, 0.5}));
  EXPECT_FALSE(region->contains({0.05, 0.05}));
}

TEST(FaceEdges, FacesThatMeetAtAnEdgeAreItsNeighbours) {
  FaceBuilder b;
  const int a = b.vertex(0.5, 0, 0), c = b.vertex(0.5, 1, 0), left = b.vertex(0, 0, 0),
            top = b.vertex(0, 1, 0);
  const int shared = b.line(a, c, {0.5, 0, 0}, {0, 1, 0});
  const int first = b.face(10, {b.bound({b.line(left, a, {0, 0, 0}, {1, 0, 0}), shared,
                                         b.line(c, top, {0.5, 1, 0}, {-1, 0, 0}),
                                         b.line(top, left, {0, 1, 0}, {0, -1, 0})})});
  const int plane = b.entity("PLANE('',#" + std::to_string(b.frame()) + ")");
  const int other = b.face(plane, {b.bound({-shared})});
  const auto region = visible_region(on_square(b).model(), "#10");
  ASSERT_TRUE(region) << region.error().message();
  ASSERT_EQ(region->edges.size(), 4U);
  for (const TrimEdge& edge : region->edges) {
    if (edge.id == "#" + std::to_string(shared)) {
      EXPECT_EQ(edge.neighbours, (std::vector<std::string>{"#" + std::to_string(first),
                                                           "#" + std::to_string(other)}));
    } else {
      EXPECT_EQ(edge.neighbours, std::vector<std::string>{"#" + std::to_string(first)});
    }
  }
}

TEST(FaceEdges, AStraightEdgeIsDividedWhereItsParametersAreCurved) {
  // The unit square with its edge v = 1 shifted: lines across it are curves in parameters.
  const std::string skewed =
      "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=CARTESIAN_POINT('',(0.,1.,0.));\n"
      "#3=CARTESIAN_POINT('',(1.,0.,0.));\n#4=CARTESIAN_POINT('',(2.,3.,0.));\n" +
      testing::bilinear_patch();
  FaceBuilder b;
  const int p = b.vertex(0.2, 0.1, 0), q = b.vertex(1.2, 1.4, 0), r = b.vertex(0.2, 0.8, 0);
  b.face(10, {b.bound({b.line(p, q, {0.2, 0.1, 0}, {1, 1.3, 0}),
                       b.line(q, r, {1.2, 1.4, 0}, {-1, -0.6, 0}),
                       b.line(r, p, {0.2, 0.8, 0}, {0, -1, 0})})});
  const auto region =
      visible_region(testing::parse_or_die(testing::step_text(skewed + b.text())).model(), "#10");
  ASSERT_TRUE(region) << region.error().message();
  for (const TrimEdge& edge : region->edges) {
    EXPECT_GT(edge.course.size(), 2U) << edge.id;
    EXPECT_LE(edge.deviation, 1e-3) << edge.id;
    for (std::size_t k = 0; k < edge.course.size(); ++k) {
      const double u = edge.course[k].x(), v = edge.course[k].y();
      const Point on_surface((1 - v) * u + v * 2 * u, (1 - u) * v + u * 3 * v, 0);
      EXPECT_LE((on_surface - edge.points[k]).norm(), 1e-9) << edge.id;
    }
  }
}

/// Three patches on the unit square: on #10 is a square face, on #30 one with the same edges and,
/// in a shell, a round one with a hole, on #50 none. One edge of the squares bounds a face on a
/// plane too.
step::File several_surfaces() {
  FaceBuilder b;
  const int a = b.vertex(1, 0, 0), c = b.vertex(1, 1, 0), d = b.vertex(0, 0, 0),
            e = b.vertex(0, 1, 0);
  const int shared = b.line(a, c, {1, 0, 0}, {0, 1, 0});
  const std::vector<int> around = {b.line(d, a, {0, 0, 0}, {1, 0, 0}), shared,
                                   b.line(c, e, {1, 1, 0}, {-1, 0, 0}),
                                   b.line(e, d, {0, 1, 0}, {0, -1, 0})};
  b.face(10, {b.bound(around)});
  b.face(b.entity("PLANE('',#" + std::to_string(b.frame()) + ")"), {b.bound({-shared})});
  const int round =
      b.face(30, {b.bound({b.circle(0.4, 0, 0.5, 0.5)}), b.bound({-b.circle(0.1, 0, 0.6, 0.5)})});
  b.face(30, {b.bound(around)});
  b.entity("OPEN_SHELL('',(#" + std::to_string(round) + "))");
  std::string text = square;
  for (const std::string id : {"#30=", "#50="}) {
    std::string patch = testing::bilinear_patch();
    text += patch.replace(0, 4, id);
  }
  return testing::parse_or_die(testing::step_text(text + b.text()));
}

TEST(VisibleRegions, AreThoseOfEachSurfaceInAnyOrderAndAsOftenAsAsked) {
  const step::File file = several_surfaces();
  const VisibleRegions regions(file.shared_model());
  for (const std::string id : {"#50", "#30", "#10", "#30", "#50", "#10", "#10"}) {
    const auto region = regions.of(id);
    const auto alone = visible_region(file.model(), id);
    ASSERT_TRUE(region && alone) << id;
    EXPECT_EQ(*region, *alone) << id;
    for (std::size_t k = 0; k < alone->edges.size(); ++k) {
      const TrimEdge &edge = region->edges[k], &same = alone->edges[k];
      EXPECT_EQ(edge.neighbours, same.neighbours) << id << " " << edge.id;
      EXPECT_EQ(edge.supports, same.supports) << id << " " << edge.id;
      EXPECT_EQ(edge.seam, same.seam) << id << " " << edge.id;
    }
  }
  // And they are different.
  EXPECT_EQ(regions.of("#10")->edges.size(), 4U);
  EXPECT_FALSE(regions.of("#10")->in_shell);
  EXPECT_EQ(regions.of("#30")->edges.size(), 6U);
  EXPECT_TRUE(regions.of("#30")->in_shell);
  EXPECT_EQ(regions.of("#50")->edges.front().id, "u0");  // no face lies on it
}

TEST(VisibleRegions, FacesAroundAnEdgeAreNeighboursOfAllSurfacesThere) {
  const step::File file = several_surfaces();
  const VisibleRegions regions(file.shared_model());
  std::vector<std::string> seen;
  for (const std::string id : {"#10", "#30"}) {
    const auto region = regions.of(id);
    ASSERT_TRUE(region) << region.error().message();
    for (const TrimEdge& edge : region->edges) {
      if (edge.neighbours.size() != 3) continue;
      seen.push_back(id + " " + edge.id);
      EXPECT_EQ(edge.supports.size(), 3U);
      for (const std::string support :
           {"#10 B_SPLINE_SURFACE_WITH_KNOTS", "#30 B_SPLINE_SURFACE_WITH_KNOTS"}) {
        EXPECT_EQ(std::ranges::count(edge.supports, support), 1) << support;
      }
    }
  }
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].substr(3), seen[1].substr(3));
}

TEST(VisibleRegions, AnUnknownSurfaceIsNamed) {
  const auto region = VisibleRegions(several_surfaces().shared_model()).of("#11");
  ASSERT_FALSE(region);
  EXPECT_EQ(region.error().where, "#11");
}

TEST(VisibleRegions, OutliveTheFileTheyWereMadeFrom) {
  const auto regions = [] {
    return std::make_unique<const VisibleRegions>(several_surfaces().shared_model());
  }();
  const auto region = regions->of("#30");
  ASSERT_TRUE(region) << region.error().message();
  EXPECT_EQ(*region, *visible_region(several_surfaces().model(), "#30"));
}

TEST(VisibleRegion, TheMiddleIsFarthestFromAllEdges) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(0.4, 0, 0.5, 0.5)}), b.bound({-b.circle(0.1, 0, 0.6, 0.5)})});
  const step::File file = on_square(b);
  const auto region = visible_region(file.model(), "#10");
  ASSERT_TRUE(region);
  const auto middle = visible_middle(file.surfaces()[0].surface, *region);
  ASSERT_TRUE(middle);
  // Between the left ends of both circles: x from 0.1 to 0.5.
  EXPECT_NEAR(middle->at.x(), 0.3, 5e-3);  // the peak is flat
  EXPECT_NEAR(middle->distance, 0.2, 1e-3);
}

TEST(VisibleRegion, WhatIsNearestToAHoleIsOnItsRim) {
  FaceBuilder b;
  b.face(10, {b.bound({b.circle(0.4, 0, 0.5, 0.5)}), b.bound({-b.circle(0.1, 0, 0.6, 0.5)})});
  const step::File file = on_square(b);
  const auto region = visible_region(file.model(), "#10");
  ASSERT_TRUE(region);
  EXPECT_FALSE(region->contains({0.58, 0.5}));
  const auto near = visible_near(file.surfaces()[0].surface, *region, Point(0.58, 0.5, 0));
  ASSERT_TRUE(near);
  EXPECT_TRUE(region->contains(near->at));
  EXPECT_NEAR(near->at.x(), 0.5, 2e-3);
}

}  // namespace
}  // namespace knead
