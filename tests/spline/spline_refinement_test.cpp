#include "knead/spline/spline_refinement.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "spline/sample_splines.hpp"

namespace knead {
namespace {

using testing::clamped_knots;
using testing::knot_families;
using testing::make_spline;
using testing::random_spline;

double size_of(const Points& points) { return points.cwiseAbs().maxCoeff(); }

/// The largest distance of both on a grid of the finer one's places, relative to the largest
/// coordinate.
template <int D>
double moved(const Spline<D>& before, const Spline<D>& after) {
  const auto grid = testing::grid_of(after);
  const auto a = evaluate_grid<D>(before, testing::spans_of<D>(grid)),
             b = evaluate_grid<D>(after, testing::spans_of<D>(grid));
  if (!a || !b) {
    ADD_FAILURE() << (a ? b.error() : a.error()).message();
    return 1;
  }
  return (a->points() - b->points()).rowwise().norm().maxCoeff() / size_of(before.control_points());
}

/// The promise, in which the rounding of both evaluations is included.
double bound(int p) { return 24 * (p + 1) * 0x1p-52; }

std::vector<double> middles(const KnotVector& knots) {
  return span_midpoints(knots, knots.domain());
}

template <class Check>
void for_each_surface(Check check) {
  std::mt19937_64 random(3);
  for (const int p : {1, 2, 3, 5, 9}) {
    const auto families = knot_families(p);
    for (std::size_t k = 0; k < families.size(); ++k) {
      const auto& other = families[(k + 3) % families.size()];
      for (const double decades : {-1.0, 0.0, 1.0, 6.0}) {
        check(random_spline<2>(random, {families[k].knots, other.knots}, decades),
              families[k].name + " x " + other.name + ", weights 1e+-" + std::to_string(decades));
      }
    }
  }
}

TEST(Refine, InsertionLeavesTheShapeOfEverySurface) {
  for_each_surface([](const Surface& s, const std::string& name) {
    const auto finer = insert_knots<2>(s, {middles(s.knots(0)), middles(s.knots(1))});
    ASSERT_TRUE(finer) << name;
    EXPECT_LE(moved(s, *finer), bound(s.knots(0).degree())) << name;
  });
}

TEST(Refine, ClampedEndsLeaveTheShapeOfEverySurfaceOnItsDomain) {
  for_each_surface([](const Surface& s, const std::string& name) {
    const auto clamped = with_clamped_ends(s);
    ASSERT_TRUE(clamped) << name << ": " << clamped.error().message();
    for (int d = 0; d < 2; ++d) {
      EXPECT_TRUE(clamped->knots(d).clamped()) << name;
      EXPECT_EQ(clamped->knots(d).domain().lower, s.knots(d).domain().lower) << name;
      EXPECT_EQ(clamped->knots(d).domain().upper, s.knots(d).domain().upper) << name;
    }
    EXPECT_LE(moved(s, *clamped), bound(s.knots(0).degree())) << name;
  });
}

TEST(Refine, ElevationLeavesTheShapeOfEverySurface) {
  for_each_surface([](const Surface& s, const std::string& name) {
    for (const int direction : {0, 1}) {
      const auto higher = elevate_degree(s, direction, 2);
      ASSERT_TRUE(higher) << name;
      EXPECT_EQ(higher->knots(direction).degree(), s.knots(direction).degree() + 2);
      EXPECT_EQ(higher->knots(1 - direction), s.knots(1 - direction));
      EXPECT_LE(moved(s, *higher), 2 * bound(s.knots(0).degree())) << name;
    }
  });
}

TEST(Refine, CurvesAndVolumesAreRefinedByTheSameCode) {
  std::mt19937_64 random(4);
  for (const double decades : {-1.0, 3.0}) {
    for (const auto& [name, knots] : knot_families(3)) {
      const auto curve = random_spline<1>(random, {knots}, decades);
      EXPECT_LE(moved(curve, *insert_knots<1>(curve, {middles(knots)})), bound(3)) << name;
      EXPECT_LE(moved(curve, *elevate_degree(curve, 0)), bound(3)) << name;
      const auto bezier = bezier_pieces(curve);
      ASSERT_TRUE(bezier);
      if (knots.clamped()) {
        EXPECT_LE(moved(curve, *bezier), bound(3)) << name;
      }
    }
    const auto volume =
        random_spline<3>(random,
                         {clamped_knots(2, {0, 1, 3}), testing::uniform_unclamped(3, 3),
                          testing::periodic(2, {1, 2, 0.5})},
                         decades);
    const auto finer = insert_knots<3>(
        volume, {std::vector{0.25, 0.25}, std::vector<double>{}, std::vector{2.75}});
    ASSERT_TRUE(finer);
    EXPECT_EQ(finer->net(),
              (std::array{volume.net()[0] + 2, volume.net()[1], volume.net()[2] + 1}));
    EXPECT_LE(moved(volume, *finer), bound(3));
    for (int d = 0; d < 3; ++d) EXPECT_LE(moved(volume, *elevate_degree(volume, d)), bound(3));
  }
}

TEST(Refine, BezierPiecesAreTheSpans) {
  std::mt19937_64 random(9);
  const auto s = random_spline<2>(
      random, {clamped_knots(3, {0, 1, 2.5, 3}, {0, 2, 4, 0}), clamped_knots(2, {0, 1, 4})});
  const auto pieces = bezier_pieces(s);
  ASSERT_TRUE(pieces);
  EXPECT_EQ(pieces->net(), (std::array{12, 6}));
  EXPECT_LE(moved(s, *pieces), bound(3));
  // Piece (1, 0) stands on its own: rows 4 … 7, columns 0 … 2.
  Points net(12, 3);
  for (int i = 0; i < 4; ++i)
    net.middleRows(3 * i, 3) = pieces->control_points().middleRows(6 * (4 + i), 3);
  const auto piece = make_spline<2>({clamped_knots(3, {1, 2.5}), clamped_knots(2, {0, 1})}, net);
  for (const double u : {1.0, 1.7, 2.25}) {
    const Point a = *evaluate_point<2>(s, {u, 0.4}), b = *evaluate_point<2>(piece, {u, 0.4});
    EXPECT_LE((a - b).norm(), bound(3));
  }
}

TEST(Refine, ControlPointsAndWeightsThatAreNotTouchedKeepTheirBits) {
  std::mt19937_64 random(6);
  for (const double decades : {-1.0, 6.0}) {
    const auto s = random_spline<2>(
        random, {testing::uniform_clamped(3, 20), testing::uniform_clamped(2, 4)}, decades);
    const auto finer = insert_knots<2>(s, {std::vector{10.5}, std::vector<double>{}});
    ASSERT_TRUE(finer);
    const int columns = s.net()[1];
    for (int i = 0; i < finer->net()[0]; ++i) {
      if (11 <= i && i <= 13) continue;  // u lies among the arguments of these three
      const int old = i < 11 ? i : i - 1;
      for (int j = 0; j < columns; ++j) {
        EXPECT_EQ(std::memcmp(finer->control_points().row(i * columns + j).data(),
                              s.control_points().row(old * columns + j).data(), 24),
                  0)
            << i << ", " << j;
        if (decades >= 0) {
          EXPECT_EQ(finer->weights()[static_cast<std::size_t>(i * columns + j)],
                    s.weights()[static_cast<std::size_t>(old * columns + j)]);
        }
      }
    }
    // Elevation keeps the corners, which the clamped surface goes through.
    const auto higher = elevate_degree(s, 0);
    ASSERT_TRUE(higher);
    EXPECT_EQ(higher->control_points().row(0), s.control_points().row(0));
    EXPECT_EQ(higher->control_points().bottomRows(1), s.control_points().bottomRows(1));
  }
}

TEST(Refine, KnotsInsertedOneByOneOrTogetherGiveTheSame) {
  std::mt19937_64 random(8);
  const auto curve = random_spline<1>(random, {clamped_knots(4, {0, 1, 2.5, 3}, {0, 2, 5, 0})}, 2);
  const std::vector list{0.5, 2.75, 0.5, 1.0, 0.25, 1.0};
  const auto together = insert_knots<1>(curve, {list});
  auto one_by_one = curve;
  for (const double u : list) one_by_one = *insert_knots<1>(one_by_one, {std::vector{u}});
  ASSERT_TRUE(together);
  EXPECT_EQ(together->knots(), one_by_one.knots());
  EXPECT_LE((together->control_points() - one_by_one.control_points()).cwiseAbs().maxCoeff(),
            bound(4));
}

TEST(Refine, ALargeNetIsRefinedInBothDirections) {
  std::mt19937_64 random(10);
  const auto knots = testing::uniform_clamped(3, 297);
  const auto s = random_spline<2>(random, {knots, knots}, 1);
  ASSERT_EQ(s.net(), (std::array{300, 300}));
  const auto finer = refine_region<2>(s, {Interval{100, 110}, Interval{0, 297}});
  ASSERT_TRUE(finer);
  EXPECT_EQ(finer->net(), (std::array{310, 597}));
  std::uniform_real_distribution<double> place(0, 297);
  Parameters<2> at(1000, 2);
  for (int k = 0; k < 1000; ++k) at.row(k) << place(random), place(random);
  const auto a = evaluate<2>(s, at), b = evaluate<2>(*finer, at);
  EXPECT_LE((a->points() - b->points()).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Refine, ARegionHalvesTheSpansItMeets) {
  std::mt19937_64 random(12);
  const auto s =
      random_spline<2>(random, {testing::uniform_clamped(3, 8), testing::uniform_clamped(2, 8)});
  const auto finer = refine_region<2>(s, {Interval{2, 3.5}, Interval{7.5, 99}});
  ASSERT_TRUE(finer);
  EXPECT_EQ(finer->net(), (std::array{13, 11}));
  EXPECT_EQ(finer->knots(0).multiplicity(2.5), 1);
  EXPECT_EQ(finer->knots(0).multiplicity(3.5), 1);
  EXPECT_EQ(finer->knots(1).multiplicity(7.5), 1);
  EXPECT_LE(moved(s, *finer), bound(3));
  EXPECT_FALSE(refine_region<2>(s, {Interval{9, 10}, Interval{0, 1}}));
  EXPECT_FALSE(refine_region<2>(s, {Interval{3, 2}, Interval{0, 1}}));
  EXPECT_FALSE(refine_region<2>(s, {Interval{0, 1}, Interval{std::nan(""), 1}}));
}

TEST(Refine, ErrorsNameTheDirection) {
  std::mt19937_64 random(13);
  const auto s = random_spline<2>(
      random, {testing::uniform_clamped(3, 2), testing::uniform_clamped(max_degree, 2)});
  EXPECT_NE(insert_knots<2>(s, {std::vector<double>{}, std::vector{-1.0}})
                .error()
                .message()
                .find("direction 1: inserted knot 0"),
            std::string::npos);
  EXPECT_NE(elevate_degree(s, 1).error().message().find("direction 1"), std::string::npos);
  const auto other = Refinement::create(s.knots(0), s.knots(0));
  EXPECT_EQ(refined(s, 1, *other).error().kind, ErrorKind::usage);
  const auto line = make_spline<1>({clamped_knots(1, {0, 1})}, Points::Random(2, 3), {1, -1});
  EXPECT_EQ(insert_knots<1>(line, {std::vector{0.5}}).error().kind, ErrorKind::numerical)
      << "weight 0 in the middle";
}

}  // namespace
}  // namespace knead
