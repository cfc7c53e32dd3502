#include "sculpt/shape_cases.hpp"

namespace knead {
namespace {

using testing::BruteForce;
using testing::Posed;
using testing::random_placement;
using testing::shape_cases;
using testing::ShapeCase;

/// Random points from the middle of the shape to a few sizes off.
Point random_point(std::mt19937_64& random, const Posed& pose) {
  std::uniform_real_distribution<double> value(-1, 1), power(-0.5, 0.7);
  return pose.out(std::pow(10.0, power(random)) * Point(value(random), value(random), value(random)));
}

double extent(const Posed& pose) {
  return std::max({pose.placement.scale[0], pose.placement.scale[1], pose.placement.scale[2]});
}

TEST(ShapeSearch, DistanceIsThatOfBruteForce) {
  std::mt19937_64 random(11);
  for (const ShapeCase& c : shape_cases()) {
    int failed = 0, points = 0;
    for (bool unequal : {false, true}) {
      for (int k = 0; k < 3; ++k) {
        const Posed pose{random_placement(random, unequal)};
        const auto placed = PlacedShape::create(c.shape, pose.placement);
        ASSERT_TRUE(placed) << c.name << placed.error().message();
        const BruteForce brute(c.sheets, pose);
        const double size = extent(pose);
        for (int i = 0; i < 25; ++i) {
          const Point x = random_point(random, pose);
          const Nearest found = placed->nearest(x);
          const double expected = brute.distance(x);
          ++points;
          failed += found.converged ? 0 : 1;
          EXPECT_NEAR(std::abs(found.distance), expected, 1e-10 * size + 1e-13 * x.norm())
              << c.name << " scale " << pose.placement.scale[0] << " " << pose.placement.scale[1] << " "
              << pose.placement.scale[2] << " size " << size << " converged " << found.converged;
          EXPECT_NEAR((x - found.point).norm(), std::abs(found.distance), 1e-13 * (size + x.norm())) << c.name;
        }
      }
    }
    EXPECT_EQ(failed, 0) << c.name << " of " << points;
  }
}

}  // namespace
}  // namespace knead
