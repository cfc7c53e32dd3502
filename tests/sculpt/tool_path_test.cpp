#include "sculpt/tool_path.hpp"

#include <gtest/gtest.h>

namespace knead {
namespace {

std::vector<Point> places_of(const std::vector<Point>& vertices, double spacing) {
  ToolPath path(spacing);
  std::vector<Point> places;
  for (const Point& vertex : vertices) path.go_to(vertex, places);
  path.finish(places);
  return places;
}

TEST(ToolPath, PlacesHaveOneDistanceAlongThePathAndTheEndIsOne) {
  const std::vector<Point> places = places_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1.2, 0}}, 0.3);
  ASSERT_EQ(places.size(), 9);
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const double way = places[k].x() + places[k].y();  // of this path, its length up to there
    EXPECT_NEAR(way, 0.3 * static_cast<double>(k), 1e-14);
  }
  EXPECT_EQ(places.back(), Point(1, 1.2, 0));
}

TEST(ToolPath, APathInManyPiecesHasThePlacesOfOneInFew) {
  std::vector<Point> many;
  for (int k = 0; k <= 480; ++k) many.emplace_back(150.0 * k / 480, 0, 12);
  const std::vector<Point> few = places_of({{0, 0, 12}, {150, 0, 12}}, 2.5),
                           fine = places_of(many, 2.5);
  ASSERT_EQ(few.size(), 61);
  ASSERT_LE(std::max(fine.size(), few.size()) - std::min(fine.size(), few.size()),
            1);  // the end, up to rounding
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_LT((few[k] - fine[k]).norm(), 1e-11);
}

TEST(ToolPath, APointIsOnePlaceAndStandingStillIsNone) {
  EXPECT_EQ(places_of({{1, 2, 3}}, 0.5).size(), 1);
  EXPECT_EQ(places_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, 0.5).size(), 1);
  EXPECT_EQ(places_of({}, 0.5).size(), 0);
}

}  // namespace
}  // namespace knead
