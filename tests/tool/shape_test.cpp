#include "tool/shape_cases.hpp"

namespace knead {
namespace {

using testing::random_placement;
using testing::shape_cases;
using testing::ShapeCase;

PlacedShape placed(const Shape& shape, const Placement& placement = {}) {
  auto made = PlacedShape::create(shape, placement);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

std::string refused(const Shape& shape, const Placement& placement = {}) {
  const auto made = PlacedShape::create(shape, placement);
  return made ? "accepted" : made.error().where;
}

TEST(Shape, WrongNumbersAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(SphereShape{0}), "radius");
  EXPECT_EQ(refused(SphereShape{nan}), "radius");
  EXPECT_EQ(refused(EllipsoidShape{{1, -1, 1}}), "semi_axes");
  EXPECT_EQ(refused(BoxShape{{1, 1, 0.1}, 0.2}), "rounding");
  EXPECT_EQ(refused(CylinderShape{1, 0}), "half_height");
  EXPECT_EQ(refused(ConeShape{0, 1, 0}), "radius");
  EXPECT_EQ(refused(CapsuleShape{1, -1}), "half_height");
  EXPECT_EQ(refused(TorusShape{1, 1.1}), "minor");
  EXPECT_EQ(refused(BowlShape{1, 2}), "thickness");
  EXPECT_EQ(refused(SuperellipsoidShape{{1, 1, 1}, 0.05, 1}), "e1");
  EXPECT_EQ(refused(SupertoroidShape{1, {0.2, 0.2}, 1, 5}), "e2");
  EXPECT_EQ(refused(SupertoroidShape{1, {1.2, 0.2}, 1, 1}), "semi_axes");
  EXPECT_EQ(refused(WedgeShape{0, 60, 1, 0}), "length");
  EXPECT_EQ(refused(WedgeShape{1, 180, 1, 0}), "angle");
  EXPECT_EQ(refused(WedgeShape{1, nan, 1, 0}), "angle");
  EXPECT_EQ(refused(WedgeShape{1, 60, -1, 0}), "height");
  EXPECT_EQ(refused(WedgeShape{1, 60, 1, 2}), "accepted");
  EXPECT_EQ(refused(WedgeShape{1, 60, 1, 2.001}), "rounding");  // 1 / (1 − sin 30°) = 2
  EXPECT_EQ(refused(SplineShape{}), "surface");
  Placement p;
  p.scale[1] = 0;
  EXPECT_EQ(refused(SphereShape{}, p), "scale");
  p = {};
  p.position.x() = nan;
  EXPECT_EQ(refused(PlaneShape{}, p), "position");
  p = {};
  p.rotation.w() = 2;
  EXPECT_EQ(refused(PlaneShape{}, p), "rotation");
}

TEST(Shape, DistancesThatAreKnown) {
  EXPECT_EQ(placed(SphereShape{2}).nearest(Point(0, 3, 0)).distance, 1);
  EXPECT_EQ(placed(BoxShape{{1, 2, 3}}).nearest(Point(4, 6, 3)).distance, 5);
  EXPECT_EQ(placed(BoxShape{{1, 2, 3}}).nearest(Point(0.5, 0, 0)).distance, -0.5);
  EXPECT_NEAR(placed(BoxShape{{1, 2, 3}, 0.5}).nearest(Point(3.5, 5.5, 0)).distance, 4.5, 1e-15);
  EXPECT_EQ(placed(CylinderShape{1, 2}).nearest(Point(4, 0, 6)).distance, 5);
  EXPECT_EQ(placed(CapsuleShape{1, 2}).nearest(Point(3, 0, 6)).distance, 4);
  EXPECT_EQ(placed(TorusShape{4, 1}).nearest(Point(0, 1, 4)).distance, 4);
  EXPECT_EQ(placed(PlaneShape{}).nearest(Point(7, 8, -2)).distance, -2);
  EXPECT_NEAR(placed(ConeShape{3, 4}).nearest(Point(0, 0, 6)).distance, 2, 1e-15);
  EXPECT_NEAR(placed(ConeShape{3, 4}).nearest(Point(0.001, 0, 1)).distance, -1, 1e-15);
  // A wedge of 90°, its foot 4 wide: over the ridge, on a flank's normal, at a corner, below,
  // inside, beyond an end.
  const PlacedShape wedge = placed(WedgeShape{10, 90, 2, 0});
  EXPECT_NEAR(wedge.nearest(Point(1, 0, 5)).distance, 3, 1e-15);
  EXPECT_NEAR(wedge.nearest(Point(1, 2, 2)).distance, std::sqrt(2), 1e-15);
  EXPECT_NEAR(wedge.nearest(Point(1, 5, -4)).distance, 5, 1e-15);
  EXPECT_EQ(wedge.nearest(Point(1, 1, -3)).distance, 3);
  EXPECT_NEAR(wedge.nearest(Point(1, 0.5, 1)).distance, -std::sqrt(0.125), 1e-15);
  EXPECT_EQ(wedge.nearest(Point(-4.9, 0, 1)).distance, 4.9 - 5);
  EXPECT_NEAR(wedge.nearest(Point(8, 0, 6)).distance, 5, 1e-15);
  // Rounded to 1, its ridge still touches z = 2, and equal distances over it are circles about (0,
  // 0, 1).
  EXPECT_NEAR(placed(WedgeShape{10, 90, 2, 1}).nearest(Point(0, 0.3, 1.4)).distance, 0.5 - 1,
              1e-15);
  EXPECT_NEAR(placed(WedgeShape{10, 90, 2, 1}).nearest(Point(0, 3, 5)).distance, 4, 1e-15);
  // The bowl: wall, hollow, below, and over the rim.
  const PlacedShape bowl = placed(BowlShape{5, 1});
  EXPECT_NEAR(bowl.nearest(Point(0, 0, -4.25)).distance, -0.25, 1e-15);
  EXPECT_NEAR(bowl.nearest(Point(0, 0, -3)).distance, 1, 1e-15);
  EXPECT_NEAR(bowl.nearest(Point(0, 0, -7)).distance, 2, 1e-15);
  EXPECT_NEAR(bowl.nearest(Point(4.5, 0, 2)).distance, 2, 1e-15);
}

TEST(Shape, UnequalScaleKeepsWhatItMust) {
  Placement p;
  p.scale = {2, 3, 0.5};
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> value(-4, 4);
  for (int k = 0; k < 300; ++k) {
    const Point x(value(random), value(random), value(random));
    EXPECT_EQ(placed(SphereShape{2}, p).nearest(x).distance,
              placed(EllipsoidShape{{4, 6, 1}}).nearest(x).distance);
    EXPECT_EQ(placed(BoxShape{{1, 1, 1}}, p).nearest(x).distance,
              placed(BoxShape{{2, 3, 0.5}}).nearest(x).distance);
    EXPECT_EQ(placed(PlaneShape{}, p).nearest(x).distance, x.z());
    // Two ways to the same ellipsoid: the one-dimensional root and the search.
    const Nearest a = placed(EllipsoidShape{{4, 6, 1}}).nearest(x);
    const Nearest b = placed(SuperellipsoidShape{{4, 6, 1}, 1, 1}).nearest(x);
    EXPECT_NEAR(a.distance, b.distance, 1e-12);
    EXPECT_LE((a.hessian - b.hessian).norm(), 1e-6 * (1 + a.hessian.squaredNorm()));
  }
}

TEST(Shape, NoDirectionWhereACircleOrSphereOfPointsIsNearest) {
  const std::vector<std::pair<Shape, Point>> ties = {{SphereShape{1}, Point::Zero()},
                                                     {EllipsoidShape{{1, 1, 1}}, Point::Zero()},
                                                     {EllipsoidShape{{1, 1, 3}}, Point::Zero()},
                                                     {CylinderShape{1, 5}, Point(0, 0, 1)},
                                                     {CapsuleShape{1, 2}, Point(0, 0, 0.5)},
                                                     {TorusShape{2, 1}, Point(0, 0, 0.3)},
                                                     {TorusShape{2, 1}, Point(2, 0, 0)},
                                                     {ConeShape{1, 2, 0}, Point(0, 0, 1.2)}};
  for (const auto& [shape, x] : ties) {
    const Nearest found = placed(shape).nearest(x);
    EXPECT_EQ(found.normal.norm(), 0) << shape.index();
    EXPECT_EQ(found.hessian.norm(), 0) << shape.index();
    EXPECT_NEAR((found.point - x).norm(), std::abs(found.distance), 1e-15) << shape.index();
  }
}

TEST(Shape, EllipsoidsThatAreNeedlesOrDiscs) {
  std::mt19937_64 random(32);
  std::normal_distribution<double> normal;
  for (double small : {1e-6, 1e-3, 0.999999}) {
    for (const std::array<double, 3>& a :
         {std::array{1.0, 1.0, small}, {1.0, small, small}, {small, 0.5, 1.0}}) {
      const PlacedShape ellipsoid = placed(EllipsoidShape{a});
      const Eigen::Array3d axes(a[0], a[1], a[2]);
      for (int k = 0; k < 500; ++k) {
        Point x(normal(random), normal(random), normal(random));
        if (k % 3 == 1) x *= 1e-3;
        if (k % 3 == 2) x[k % 9 / 3] = 0;
        const Nearest found = ellipsoid.nearest(x);
        // On the ellipsoid, and the way to it along its normal: with convexity that is the nearest
        // point from outside.
        EXPECT_NEAR((found.point.array() / axes).matrix().norm(), 1, 1e-13);
        EXPECT_LE(((x - found.point) - found.distance * found.normal).norm(),
                  1e-12 * (1 + x.norm()));
        const double inside = (x.array() / axes).matrix().norm();
        if (std::abs(inside - 1) > 1e-12) {
          EXPECT_EQ(found.distance < 0, inside < 1);
        }
      }
    }
  }
}

TEST(Shape, BatchIsTheSingleCallAndTheBoxHoldsTheShape) {
  std::mt19937_64 random(33);
  std::normal_distribution<double> normal;
  for (const ShapeCase& c : shape_cases()) {
    const Placement p = random_placement(random, true);
    const PlacedShape shape = placed(c.shape, p);
    EXPECT_GT(shape.size(), 0) << c.name;
    const BoundingBox box = shape.bounding_box();
    Points x(20, 3);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      x.row(k) =
          p.position.transpose() + 2 * p.scale[0] * testing::drawn(normal, random).transpose();
    }
    const NearestPoints batch = shape.nearest_points(x);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      const Nearest one = shape.nearest(x.row(k));
      EXPECT_EQ(one.distance, batch.distances[k]) << c.name;
      EXPECT_EQ(one.point, Point(batch.points.row(k))) << c.name;
      EXPECT_EQ(one.normal, Point(batch.normals.row(k))) << c.name;
      EXPECT_EQ(one.hessian, batch.hessians[static_cast<std::size_t>(k)]) << c.name;
      const double slack = 1e-9 * box.diagonal();
      EXPECT_TRUE(((one.point - box.lower).array() >= -slack).all()) << c.name;
      EXPECT_TRUE(((box.upper - one.point).array() >= -slack).all()) << c.name;
    }
  }
  EXPECT_TRUE(std::isinf(placed(PlaneShape{}).size()));
}

}  // namespace
}  // namespace knead
