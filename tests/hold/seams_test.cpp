#include "knead/hold/seams.hpp"

#include "seams_support.hpp"

namespace knead {
namespace {

using namespace knead::testing;

FoundSeams find(const std::vector<Surface>& patches, double tolerance = 1e-3) {
  auto found = find_seams(pointers(patches), tolerance);
  if (!found) ADD_FAILURE() << found.error().message();
  return std::move(*found);
}

Surface moved(const Surface& s, const Point& by) {
  return *s.with_control_points(s.control_points().rowwise() + by.transpose());
}

TEST(Seams, AllPairsOfEdgesAreFoundInBothOrientationsWithTheirGap) {
  const auto pair = smooth_pair(uniform_clamped(2, 3), uniform_clamped(3, 2),
                                clamped_knots(3, {0, 1, 1.5, 4}), 2, 1);
  for (SurfaceEdge a : all_edges) {
    for (SurfaceEdge b : all_edges) {
      for (bool reversed : {false, true}) {
        const FoundSeams found =
            find({with_edge_at(pair[0], a, false),
                  moved(with_edge_at(pair[1], b, reversed), Point(0, 3e-4, 4e-4))});
        ASSERT_EQ(found.seams.size(), 1u) << edge_name(a) << edge_name(b) << reversed;
        const Seam& seam = found.seams[0];
        EXPECT_EQ(seam.a, (PatchEdge{0, a}));
        EXPECT_EQ(seam.b, (PatchEdge{1, b}));
        EXPECT_EQ(seam.reversed, reversed);
        EXPECT_EQ(seam.kind, SeamKind::whole);
        EXPECT_NEAR(seam.gap, 5e-4, 1e-14);
        EXPECT_TRUE(found.collapsed.empty());
      }
    }
  }
}

TEST(Seams, TheToleranceIsTheUsersAndIncludesWhatItNames) {
  const Surface s = uniform_sheet(2, 4, 4);
  const std::vector<Surface> apart = {s, moved(s, Point(1, 0, 0.01))};
  EXPECT_TRUE(find(apart, 0.0099).seams.empty());
  EXPECT_EQ(find(apart, 0.0101).seams.size(), 1u);
  EXPECT_FALSE(find_seams({}, 0));
  EXPECT_FALSE(find_seams({}, -1));
  EXPECT_FALSE(find_seams({}, std::nan("")));
  EXPECT_TRUE(find_seams({}, 1)->seams.empty());
  EXPECT_DOUBLE_EQ(suggested_seam_tolerance(pointers(apart)), 1e-4 * Point(2, 1, 0.01).norm());
}

TEST(Seams, CornersThatMeetAreNotEnough) {
  const Surface s = uniform_sheet(3, 6, 6);
  Points points = moved(s, Point(1, 0, 0)).control_points();
  for (int j = 1; j < 5; ++j) points(j, 0) += 0.02;
  EXPECT_TRUE(find({s, *s.with_control_points(points)}, 1e-4).seams.empty());
}

TEST(Seams, APatchIsASeamWithItselfWhereItClosesAndAPoleWhereItCollapses) {
  const FoundSeams tube = find({cylinder()});
  ASSERT_EQ(tube.seams.size(), 1u);
  EXPECT_EQ(tube.seams[0],
            (Seam{{0, SurfaceEdge::u0}, {0, SurfaceEdge::u1}, false, SeamKind::whole, 0}));
  EXPECT_TRUE(tube.collapsed.empty());
  const FoundSeams ball = find({transposed(sphere())});
  ASSERT_EQ(ball.seams.size(), 1u);
  EXPECT_EQ(ball.seams[0].a.edge, SurfaceEdge::v0);
  EXPECT_EQ(ball.seams[0].b.edge, SurfaceEdge::v1);
  ASSERT_EQ(ball.collapsed.size(), 2u);
  EXPECT_EQ(ball.collapsed[0].edge, (PatchEdge{0, SurfaceEdge::u0}));
  EXPECT_EQ(ball.collapsed[0].size, 0);
}

TEST(Seams, AStripThinnerThanTheToleranceIsNotClosedWithItself) {
  EXPECT_TRUE(find({uniform_sheet(3, 8, 4, 1, 5e-4)}).seams.empty());
}

TEST(Seams, AnEdgeFoldedOntoItselfIsOne) {
  Points points(6, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1;
  const FoundSeams found =
      find({make_surface(clamped_knots(1, {0, 1}), clamped_knots(2, {0, 1}), points)});
  ASSERT_EQ(found.seams.size(), 1u);
  EXPECT_EQ(found.seams[0].a, found.seams[0].b);
  EXPECT_EQ(found.seams[0].a.edge, SurfaceEdge::u0);
  EXPECT_TRUE(found.seams[0].reversed);
  EXPECT_LT(found.seams[0].gap, 1e-15);
}

TEST(Seams, PartOfAnEdgeIsToldFromAWholeOne) {
  const Surface large = uniform_sheet(3, 5, 5, 1, 1);
  const Surface small = moved(uniform_sheet(2, 4, 4, 0.3, 0.3), Point(1, 0.4, 0));
  const FoundSeams found = find({small, large});
  ASSERT_EQ(found.seams.size(), 1u);
  EXPECT_EQ(found.seams[0].kind, SeamKind::partial);
  EXPECT_EQ(found.seams[0].a, (PatchEdge{0, SurfaceEdge::u0}));
  EXPECT_EQ(found.seams[0].b, (PatchEdge{1, SurfaceEdge::u1}));
  EXPECT_LT(found.seams[0].gap, 1e-14);
  // Overlapping by half of either.
  EXPECT_EQ(find({large, moved(large, Point(1, 0.5, 0))}).seams.at(0).kind, SeamKind::partial);
  // Meeting in a corner, side by side or in one line, is nothing.
  EXPECT_TRUE(find({large, moved(large, Point(1, 1, 0))}).seams.empty());
}

TEST(Seams, TheSameCurveInOtherParametersIsToldFromTheSameEdge) {
  const Surface s = uniform_sheet(2, 4, 4);
  Points points = moved(s, Point(1, 0, 0)).control_points();
  for (int i = 0; i < 4; ++i)
    points(4 * i + 1, 1) += 0.1;  // a straight edge run through at another speed
  const FoundSeams found = find({s, *s.with_control_points(points)});
  ASSERT_EQ(found.seams.size(), 1u);
  EXPECT_EQ(found.seams[0].kind, SeamKind::reparametrised);
  // Circles that start elsewhere.
  const Surface tube = cylinder();
  Points turn = tube.control_points();
  for (Eigen::Index k = 0; k < turn.rows(); ++k) {
    const Point p = tube.control_points().row(k);
    turn.row(k) << -p.y(), p.x(), p.z() + 2;
  }
  int between = 0;
  for (const Seam& seam : find({tube, *tube.with_control_points(turn)}).seams) {
    if (seam.a.patch == seam.b.patch) continue;
    ++between;
    EXPECT_EQ(seam.kind, SeamKind::reparametrised);
  }
  EXPECT_EQ(between, 1);
}

TEST(Seams, AnEdgeThatCannotBeEvaluatedIsNamedAndTheOthersAreFound) {
  const Surface s = uniform_sheet(1, 2, 2);
  const Surface bad =
      make_surface(s.knots(0), s.knots(1), moved(s, Point(1, 0, 0)).control_points(), {1, 1, 0, 0});
  const FoundSeams found = find({s, bad});
  EXPECT_EQ(found.seams.size(), 1u);
  ASSERT_FALSE(found.unusable.empty());
  EXPECT_EQ(found.unusable[0].first, (PatchEdge{1, SurfaceEdge::u1}));
}

TEST(Seams, UnclampedEdgesLieAtTheEndsOfTheDomain) {
  const Surface s = uniform_sheet(3, 7, 7);
  const KnotVector k = uniform_unclamped(3, 4);
  Points points(49, 3);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) points.row(7 * i + j) << 1 + (i - 1) / 4.0, (j - 1) / 4.0, 0;
  }
  const FoundSeams found = find({s, make_surface(k, k, points)});
  ASSERT_EQ(found.seams.size(), 1u);
  EXPECT_EQ(found.seams[0].kind, SeamKind::whole);
  EXPECT_LT(found.seams[0].gap, 1e-14);
}

TEST(Seams, AGridOfHundredsOfPatchesHasOneSeamPerInnerEdge) {
  constexpr int side = 16;
  std::vector<Surface> patches;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const Surface s = moved(uniform_sheet(3, 6, 6), Point(i, j, 0));
      patches.push_back(
          with_edge_at(s, all_edges[static_cast<std::size_t>((i + j) % 4)], i % 2 == 1));
    }
  }
  const FoundSeams found = find(patches);
  EXPECT_EQ(found.seams.size(), 2u * side * (side - 1));
  for (const Seam& seam : found.seams) EXPECT_EQ(seam.kind, SeamKind::whole);
}

}  // namespace
}  // namespace knead
