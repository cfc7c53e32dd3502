#include "sculpt/travelled.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "contact/active.hpp"
#include "knead/spline/evaluate.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

Points bump(const Surface& s, int row, int column, const Point& by) {
  Points result = Points::Zero(s.size(), 3);
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      result.row((row + i) * s.net()[1] + column + j) =
          (i == 0 && j == 0 ? 1.0 : 0.4) * by.transpose();
    }
  }
  return result;
}

TEST(Travelled, ShiftsADentOverAPlane) {
  // By two spans in u and one back in v: control points of the middle move with it, to rounding.
  const Surface s = testing::box<2>(3, 24);
  const auto values = *SiteValues<2>::create(s, Sites::chebyshev);
  const double span = 1.0 / 21;
  const Travel travel{Point(8 * span, 9 * span, 0.3), Point(10 * span, 8 * span, 0.3)};
  const Points found = travelled(s, values, bump(s, 9, 10, Point(0.1, 0, -1)), {&travel, 1});
  EXPECT_LE((found - bump(s, 11, 9, Point(0.1, 0, -1))).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Travelled, LeavesWhatIsUnderAToolThatRests) {
  const Surface s = testing::box<2>(3, 24);
  const auto values = *SiteValues<2>::create(s, Sites::chebyshev);
  const double span = 1.0 / 21;
  const Points before = bump(s, 4, 4, Point(0, 0, 1)) + bump(s, 18, 18, Point(0, 0, 2));
  const std::vector<Travel> travels = {
      {Point(4 * span, 4 * span, 0.2), Point(4 * span, 4 * span, 0.2)},
      {Point(17 * span, 17 * span, 0.2), Point(17 * span, 15 * span, 0.2)}};
  const Points found = travelled(s, values, before, travels);
  const Points expected = bump(s, 4, 4, Point(0, 0, 1)) + bump(s, 18, 16, Point(0, 0, 2));
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(travelled(s, values, before, {}), before);
}

TEST(Travelled, GoesOnBesideTheBorder) {
  // A foot on the border shows no way through the domain; the tangents do.
  const Surface s = testing::box<2>(3, 24);
  const auto values = *SiteValues<2>::create(s, Sites::chebyshev);
  const double span = 1.0 / 21;
  const Travel travel{Point(-0.1, 9 * span, 0), Point(-0.1 + span, 9 * span, 0)};
  const Points found = travelled(s, values, bump(s, 9, 10, Point(0, 0, 1)), {&travel, 1});
  EXPECT_LE((found - bump(s, 10, 10, Point(0, 0, 1))).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Travelled, TurnsWithTheNormal) {
  // Along a sheet bent about y, by 30 degrees: what was along the normal there is along the normal
  // here.
  const Surface flat = testing::box<2>(3, 40);
  Points bent = flat.control_points();
  for (Eigen::Index i = 0; i < bent.rows(); ++i) {
    const double angle = 0.5 * std::numbers::pi * (bent(i, 0) - 0.5);
    bent.row(i) = Point(std::sin(angle), bent(i, 1), std::cos(angle)).transpose();
  }
  const Surface s = *flat.with_control_points(bent);
  const auto values = *SiteValues<2>::create(s, Sites::chebyshev);
  const auto radial = [](double angle) { return Point(std::sin(angle), 0, std::cos(angle)); };
  const double angle = std::numbers::pi / 6;
  const Travel travel{1.2 * radial(-angle / 2) + Point(0, 0.5, 0),
                      1.2 * radial(angle / 2) + Point(0, 0.5, 0)};
  const int row = 14;  // about where the tool was
  const Points before = bump(s, row, 19, 0.1 * radial(-angle / 2));
  const Points after = travelled(s, values, before, {&travel, 1});
  const auto field_before = *s.with_control_points(before),
             field_after = *s.with_control_points(after);
  const auto foot = [&](double a) {
    return std::array<double, 2>{0.5 + a / (0.5 * std::numbers::pi), 0.5};
  };
  const Point was = *evaluate_point<2>(field_before, foot(-angle / 2)),
              is = *evaluate_point<2>(field_after, foot(angle / 2));
  EXPECT_GT(was.norm(), 0.01);
  const Eigen::AngleAxisd turn(angle, Point(0, 1, 0));
  EXPECT_LE((is - turn * was).norm(), 0.02 * was.norm());
}

TEST(Travelled, StaysWhereTheShapeHasNoTangents) {
  const Surface flat = testing::box<2>(2, 8);
  const Surface point = *flat.with_control_points(Points::Zero(flat.size(), 3));
  const Points before = bump(flat, 3, 3, Point(0, 0, 1));
  const Travel travel{Point(1, 0, 0), Point(2, 0, 0)};
  EXPECT_EQ(travelled(point, *SiteValues<2>::create(flat, Sites::chebyshev), before, {&travel, 1}),
            before);
}

}  // namespace
}  // namespace knead
