// Edges of one face each, and sides of surfaces without faces, where they meet geometrically.
#include <cmath>
#include <numbers>

#include "exchange/edge_pair.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using brep::EdgeKind;
using brep::EdgeMeasures;
using brep::Model;
using brep::ModelMeasures;

constexpr double degree = std::numbers::pi / 180;

/// A model of these surfaces alone, "#1", "#2", ….
Model bare(const std::vector<Surface>& surfaces) {
  Model model;
  for (const Surface& surface : surfaces) {
    const auto number = std::to_string(model.surfaces.size() + 1);
    model.surfaces.push_back({"#" + number, "", "mm", surface});
  }
  model.index_surfaces();
  return model;
}

ModelMeasures measured(const Model& model) {
  auto measures = brep::measure_edges(model);
  EXPECT_TRUE(measures) << measures.error().message();
  return measures.value_or(ModelMeasures{});
}

const EdgeMeasures& find(const ModelMeasures& all, const std::string& id) {
  for (const EdgeMeasures& edge : all.edges) {
    if (edge.id == id) return edge;
  }
  static const EdgeMeasures missing;
  std::string ids;
  for (const EdgeMeasures& edge : all.edges) ids += " " + edge.id;
  ADD_FAILURE() << id << " is missing among" << ids;
  return missing;
}

std::size_t count(const ModelMeasures& all, EdgeKind kind) {
  return static_cast<std::size_t>(std::ranges::count(all.edges, kind, &EdgeMeasures::kind));
}

KnotVector linear() { return KnotVector::clamped_uniform(1, 2).value(); }

/// A bilinear patch; a to b along u at v = 0, c to d at v = 1.
Surface patch(const Point& a, const Point& b, const Point& c, const Point& d) {
  Points net(4, 3);
  net << a.transpose(), c.transpose(), b.transpose(), d.transpose();
  return *Surface::create({linear(), linear()}, net);
}

/// Over x from `from` to `to` a plane that begins at y = 1 and z = gap, and rises by an angle.
Surface wall(double from, double to, double angle, double gap = 0) {
  const Point up(0, std::cos(angle * degree), std::sin(angle * degree));
  const Point a(from, 1, gap), b(to, 1, gap);
  return patch(a, b, a + up, b + up);
}

TEST(EdgeMeetings, ALongSideMeetsTwoShortOnes) {
  const double gap = 2e-4;  // of a size of 5
  const auto all = measured(bare(
      {patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), wall(0, 1.5, 30), wall(1.5, 4, 0, gap)}));
  const EdgeMeasures& bent = find(all, "#1.v1+#2.v0");
  EXPECT_EQ(bent.kind, EdgeKind::sharp);
  EXPECT_NEAR(bent.angle->value, 30, 1e-9);
  EXPECT_NEAR(bent.length, 1.5, 1e-6);
  EXPECT_LT(bent.gap->value, 1e-13);
  EXPECT_EQ(bent.faces, (std::vector<std::string>{"#1", "#2"}));
  const EdgeMeasures& apart = find(all, "#1.v1+#3.v0");
  EXPECT_EQ(apart.kind, EdgeKind::gap);
  EXPECT_NEAR(apart.gap->value, gap, 1e-12);
  EXPECT_NEAR(apart.length, 2.5, 1e-6);
  // And both short ones along their common side, one of them below the other.
  EXPECT_EQ(count(all, EdgeKind::open), all.edges.size() - 2);
  for (const EdgeMeasures& edge : all.edges) EXPECT_NE(edge.kind, EdgeKind::unknown) << edge.reason;
}

TEST(EdgeMeetings, WhatIsLeftOfASideIsOpen) {
  const auto all =
      measured(bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), wall(1, 2, 90)}));
  EXPECT_NEAR(find(all, "#1.v1").length, 1, 1e-6);
  EXPECT_NEAR(find(all, "#1.v1/2").length, 2, 1e-6);
  EXPECT_NEAR(find(all, "#1.v1+#2.v0").angle->value, 90, 1e-9);
  EXPECT_EQ(count(all, EdgeKind::open), 8U) << "three sides of each, and both rests";
}

TEST(EdgeMeetings, AnotherParametrisationIsTheSame) {
  const Surface base = patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), up = wall(0, 4, 12);
  const Surface finer = *insert_knots<2>(*elevate_degree<2>(up, 0, 3), {{{0.3, 0.31, 0.7}, {}}});
  // The same wall from right to left: its side runs against that of the base.
  const auto& p = up.control_points();
  const Surface back = patch(p.row(2), p.row(0), p.row(3), p.row(1));
  for (const Surface& other : {up, finer, back}) {
    const EdgeMeasures edge = find(measured(bare({base, other})), "#1.v1+#2.v0");
    EXPECT_NEAR(edge.angle->value, 12, 1e-9);
    EXPECT_LT(edge.gap->value, 1e-13);
    EXPECT_NEAR(edge.length, 4, 1e-9);
  }
}

TEST(EdgeMeetings, ACylinderMeetsItselfAndItsLids) {
  const Surface side = testing::cylinder(2);
  const auto all = measured(bare({side}));
  ASSERT_EQ(count(all, EdgeKind::seam), 1U);
  for (const EdgeMeasures& edge : all.edges) {
    if (edge.kind != EdgeKind::seam) continue;
    EXPECT_EQ(edge.faces, std::vector<std::string>{"#1"});
    EXPECT_LT(edge.angle->value, 1e-6);
    EXPECT_NEAR(edge.length, 2, 1e-9);
  }
  EXPECT_EQ(count(all, EdgeKind::open), 2U);
}

TEST(EdgeMeetings, ManyAtOneLineAreNonManifold) {
  const auto all = measured(bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), wall(0, 4, 20),
                                  wall(0, 4, 70), wall(0, 4, 120)}));
  EXPECT_EQ(count(all, EdgeKind::non_manifold), 3U) << "each of the others with one";
}

TEST(EdgeMeetings, SidesThatRunApartFromAVertexDoNotMeet) {
  for (const double angle : {3.0, 20.0}) {
    const Point far(4 * std::cos(angle * degree), 4 * std::sin(angle * degree), 0);
    const auto all = measured(bare({patch({0, 0, 0}, {4, 0, 0}, {0, -1, 0}, {4, -1, 0}),
                                    patch({0, 0, 0}, far, {0, 1, 0}, far + Point(0, 1, 0))}));
    for (const EdgeMeasures& edge : all.edges) {
      if (edge.id == "#1.v0+#2.v0") {
        EXPECT_LT(edge.length, 0.02) << angle;
      }
    }
    EXPECT_GE(count(all, EdgeKind::open), 7U);
  }
}

TEST(EdgeMeetings, SidesThatContinueEachOtherDoNotMeet) {
  const auto all = measured(bare({patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}),
                                  patch({1, 0, 1e-5}, {2, 0, 0}, {1, -1, 0}, {2, -1, 0})}));
  EXPECT_EQ(count(all, EdgeKind::open), 8U);
  EXPECT_EQ(all.edges.size(), 8U);
}

TEST(EdgeMeetings, PointsAndLinesAreNoFaces) {
  const Surface line = patch({0, 1, 0}, {4, 1, 0}, {0, 1, 0}, {4, 1, 0});
  const Surface point = patch({0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0});
  const Surface fan = patch({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {4, 1, 0});
  const auto all = measured(bare({line, fan, point, wall(0, 4, 45)}));
  EXPECT_EQ(find(all, "#2.v1+#4.v0").kind, EdgeKind::sharp);
  EXPECT_EQ(all.edges.size(), 6U) << "three sides of the fan, of which one meets the wall";
}

// The first wall ends, and the second begins, a little apart: between both the base has no partner
// at the one point at which its partner changes.
TEST(EdgeMeetings, EndsThatDoNotQuiteMeetLeaveNothingOpen) {
  const auto all = measured(bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}),
                                  wall(0, 1.53, 30), wall(1.53 + 2e-8, 4, 50)}));
  EXPECT_NEAR(find(all, "#1.v1+#2.v0").length, 1.53, 1e-6);
  EXPECT_NEAR(find(all, "#1.v1+#3.v0").length, 2.47, 1e-6);
  for (const EdgeMeasures& edge : all.edges) EXPECT_NE(edge.id, "#1.v1");
}

/// A wall whose side has the height z(s) at x = 4 s³: one high and narrow bump where it begins, and
/// one that is low and wide.
TEST(EdgeMeetings, FindsTheLargestGapRightBesideAnEnd) {
  constexpr int degree_of_side = 12;
  const auto bernstein = [](int n, double s) {
    double result = std::pow(1 - s, degree_of_side - n) * std::pow(s, n);
    for (int k = 0; k < n; ++k) result *= double(degree_of_side - k) / (k + 1);
    return result;
  };
  constexpr double height = 1e-4;
  Points net(2 * (degree_of_side + 1), 3);
  double largest = 0;
  for (int k = 0; k <= degree_of_side; ++k) {
    // s³ in the basis of degree 12.
    const double x = 4.0 * k * (k - 1) * (k - 2) / (12 * 11 * 10);
    const double z = k == 1 ? height : k == 6 ? 0.6 * height : 0;
    net.row(2 * k) << x, 1, z;
    net.row(2 * k + 1) << x, 2, z;
  }
  for (int k = 0; k <= 10000; ++k) {
    const double s = k / 1e4;
    largest = std::max(largest, height * (bernstein(1, s) + 0.6 * bernstein(6, s)));
  }
  const Surface side = *Surface::create(
      {*KnotVector::clamped_uniform(degree_of_side, degree_of_side + 1), linear()}, net);
  const auto all = measured(bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), side}));
  EXPECT_NEAR(find(all, "#1.v1+#2.v0").gap->value, largest, 0.01 * largest);
}

TEST(EdgeMeetings, PartsHaveCoordinatesOfTheirOwn) {
  Model model = bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), wall(0, 4, 45)});
  EXPECT_EQ(count(measured(model), EdgeKind::sharp), 1U);
  brep::Assembly assembly;
  for (const char* id : {"#1", "#2"}) {
    assembly.parts.emplace_back();
    assembly.parts.back().surfaces = {id};
    assembly.parts.back().places.resize(1);
  }
  model.assembly = assembly;
  EXPECT_EQ(count(measured(model), EdgeKind::open), 8U);
}

TEST(EdgeMeetings, OneOfBothEdgesOrTheirPairChoosesIt) {
  const Model model = bare({patch({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {4, 1, 0}), wall(0, 4, 45)});
  for (const char* id : {"#1.v1", "#2.v0", "#1.v1+#2.v0"}) {
    const std::vector<std::string> ids = {id};
    const auto chosen = brep::measure_edges(model, {}, ids);
    ASSERT_TRUE(chosen);
    ASSERT_EQ(chosen->edges.size(), 1U);
    EXPECT_EQ(chosen->edges[0].id, "#1.v1+#2.v0");
  }
  const std::vector<std::string> wrong = {"#1.w0"};
  EXPECT_FALSE(brep::measure_edges(model, {}, wrong));
}

}  // namespace
}  // namespace knead
