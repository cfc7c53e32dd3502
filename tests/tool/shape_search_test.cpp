#include <optional>

#include "tool/shape_cases.hpp"
#include "tool/shape_kernel.hpp"

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
  const Point direction = testing::drawn(value, random);
  return pose.out(std::pow(10.0, power(random)) * direction);
}

double extent(const Posed& pose) {
  return std::max({pose.placement.scale[0], pose.placement.scale[1], pose.placement.scale[2]});
}

/// (|x|^(2/e) + |y|^(2/e))^(e/2); what is 1e-11 of the other counts as zero, because at a cusp its
/// rounding would show.
double norm_of(double x, double y, double e) {
  const double a = std::max(std::abs(x), std::abs(y)), b = std::min(std::abs(x), std::abs(y));
  return b < 1e-11 * a ? a : a * std::pow(1 + std::pow(b / a, 2 / e), e / 2);
}

/// A point of the superquadric near a point of the own frame: exactly on it by its implicit
/// equation.
std::optional<Point> on_superquadric(const Shape& shape, const Point& y) {
  if (const auto* s = std::get_if<SuperellipsoidShape>(&shape)) {
    const double in_plane = norm_of(y.x() / s->semi_axes[0], y.y() / s->semi_axes[1], s->e2);
    return Point(y / norm_of(in_plane, y.z() / s->semi_axes[2], s->e1));
  }
  if (const auto* s = std::get_if<SupertoroidShape>(&shape)) {
    const double rho = norm_of(y.x(), y.y(), s->e2);
    const double a = (rho - s->major) / s->semi_axes[0], b = y.z() / s->semi_axes[1],
                 r = norm_of(a, b, s->e1);
    const double new_rho = s->major + s->semi_axes[0] * a / r;
    return Point(y.x() * new_rho / rho, y.y() * new_rho / rho, y.z() / r);
  }
  return std::nullopt;
}

TEST(ShapeSearch, OfRoundSuperquadricsIsThatOfAnEllipsoidAndATorus) {
  std::mt19937_64 random(5);
  const std::pair<Shape, Shape> pairs[] = {
      {SuperellipsoidShape{{0.7, 0.7, 0.7}, 1, 1}, SphereShape{0.7}},
      {SuperellipsoidShape{{0.7, 0.4, 0.2}, 1, 1}, EllipsoidShape{{0.7, 0.4, 0.2}}},
      {SupertoroidShape{0.8, {0.3, 0.3}, 1, 1}, TorusShape{0.8, 0.3}},
  };
  for (const auto& [given, plain] : pairs) {
    for (int k = 0; k < 20; ++k) {
      const Posed pose{random_placement(random, k % 2 == 1)};
      const auto a = PlacedShape::create(given, pose.placement),
                 b = PlacedShape::create(plain, pose.placement);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->size(), b->size(), 1e-12 * b->size());
      const Point x = random_point(random, pose);
      EXPECT_NEAR(a->nearest(x).distance, b->nearest(x).distance, 1e-9 * extent(pose));
      EXPECT_LE((a->nearest(x).point - b->nearest(x).point).norm(), 1e-6 * extent(pose));
    }
  }
}

TEST(ShapeSearch, DistanceIsThatOfBruteForce) {
  std::mt19937_64 random(11);
  for (const ShapeCase& c : shape_cases()) {
    int uncertified = 0;
    for (bool unequal : {false, true}) {
      for (int k = 0; k < 3; ++k) {
        const Posed pose{random_placement(random, unequal)};
        const auto placed = PlacedShape::create(c.shape, pose.placement);
        ASSERT_TRUE(placed) << c.name << placed.error().message();
        const BruteForce brute(c.sheets, pose);
        const double size = extent(pose);
        for (int i = 0; i < 20; ++i) {
          const Point x = random_point(random, pose);
          const Nearest found = placed->nearest(x);
          uncertified += found.converged ? 0 : 1;
          const double expected = brute.distance(x), tolerance = 1e-10 * size;
          EXPECT_LE(std::abs(found.distance), expected + tolerance) << c.name;
          EXPECT_NEAR((x - found.point).norm(), std::abs(found.distance), 1e-13 * (size + x.norm()))
              << c.name;
          // The nearest point is one of the surface. (Compass search stalls on squarish and pinched
          // superquadrics, so there the equation tells.)
          const Eigen::Array3d scale(pose.placement.scale[0], pose.placement.scale[1],
                                     pose.placement.scale[2]);
          const Point local =
              ((pose.placement.rotation.conjugate() * (found.point - pose.placement.position))
                   .array() /
               scale)
                  .matrix();
          if (const auto on = on_superquadric(c.shape, local)) {
            EXPECT_LE((pose.out(*on) - found.point).norm(), tolerance) << c.name;
          } else {
            EXPECT_GE(std::abs(found.distance), expected - tolerance) << c.name;
          }
        }
      }
    }
    EXPECT_LE(uncertified, 1) << c.name << " of 120";
  }
}

/// Everything that holds at each point whatever the shape.
TEST(ShapeSearch, NormalIsTheGradientAndHessianItsDerivative) {
  std::mt19937_64 random(12);
  for (const ShapeCase& c : shape_cases()) {
    int compared = 0, wrong_gradient = 0, wrong_hessian = 0;
    for (int k = 0; k < 4; ++k) {
      const Posed pose{random_placement(random, k >= 2)};
      const auto placed = PlacedShape::create(c.shape, pose.placement);
      ASSERT_TRUE(placed);
      const double size = extent(pose), h = 1e-6 * size;
      for (int i = 0; i < 40; ++i) {
        const Point x = random_point(random, pose);
        const Nearest at = placed->nearest(x);
        ASSERT_NEAR(at.normal.norm(), 1, 1e-12) << c.name;
        EXPECT_LE((at.normal * at.distance - (x - at.point)).norm(), 1e-12 * (size + x.norm()))
            << c.name;
        EXPECT_LE((at.hessian * at.normal).norm() * size, 1e-6 * (1 + at.hessian.norm() * size))
            << c.name;
        Point slope;
        Eigen::Matrix3d bend;
        for (int axis = 0; axis < 3; ++axis) {
          const Nearest left = placed->nearest(x - h * Point::Unit(axis));
          const Nearest right = placed->nearest(x + h * Point::Unit(axis));
          EXPECT_LE(std::abs(right.distance - left.distance), 2 * h * (1 + 1e-4))
              << c.name;  // 1-Lipschitz
          slope[axis] = (right.distance - left.distance) / (2 * h);
          bend.col(axis) = (right.normal - left.normal) / (2 * h);
        }
        // Where a kink or a strongly bent place is between the differences they say nothing: few
        // points in all.
        ++compared;
        if (at.hessian.norm() * h > 1e-4) continue;
        wrong_gradient += (slope - at.normal).norm() > 1e-5;
        wrong_hessian += (bend - at.hessian).norm() > 1e-3 * (at.hessian.norm() + 1 / size);
      }
    }
    EXPECT_LE(wrong_gradient, 1) << c.name << " of " << compared;
    EXPECT_LE(wrong_hessian, 3) << c.name << " of " << compared;
  }
}

TEST(ShapeSearch, RigidMotionCarriesEverythingAlong) {
  std::mt19937_64 random(13);
  for (const ShapeCase& c : shape_cases()) {
    Placement still = random_placement(random, true);
    const Posed pose{still};
    const auto placed = PlacedShape::create(c.shape, still);
    ASSERT_TRUE(placed);
    const Eigen::Quaterniond turn = random_placement(random, false).rotation;
    const Point shift = pose.placement.scale[0] * Point(0.3, -1, 2);
    const auto moved = placed->moved(turn * still.rotation, turn * still.position + shift);
    ASSERT_TRUE(moved);
    for (int i = 0; i < 30; ++i) {
      const Point x = random_point(random, pose);
      const Nearest a = placed->nearest(x), b = moved->nearest(turn * x + shift);
      EXPECT_NEAR(a.distance, b.distance, 1e-12 * (extent(pose) + x.norm())) << c.name;
      EXPECT_LE((turn * a.normal - b.normal).norm(), 1e-8) << c.name;
    }
  }
}

TEST(ShapeSearch, FarAwayNearbyOnTheAxesAndAtTheMiddle) {
  std::mt19937_64 random(14);
  std::normal_distribution<double> normal;
  for (const ShapeCase& c : shape_cases()) {
    for (bool unequal : {false, true}) {
      Placement plain;
      if (unequal) plain.scale = {0.7, 1.3, 1.1};
      const Posed pose{plain};
      const auto placed = PlacedShape::create(c.shape, plain);
      ASSERT_TRUE(placed);
      const BruteForce brute(c.sheets, pose);
      std::vector<Point> points = {Point::Zero()};
      for (int axis = 0; axis < 3; ++axis) {
        for (double at : {-2.0, -0.1, 0.05, 0.5, 3.0, 1000.0})
          points.push_back(at * Point::Unit(axis));
        Point plane = testing::drawn(normal, random);
        plane[axis] = 0;
        points.push_back(plane);
        points.push_back(plane + 1e-9 * Point::Unit(axis));
      }
      points.push_back(1000 * testing::drawn(normal, random));
      for (const Point& x : points) {
        const Nearest found = placed->nearest(x);
        EXPECT_LE(std::abs(found.distance), brute.distance(x) + 1e-10 + 1e-15 * x.norm())
            << c.name << x.transpose();
        EXPECT_NEAR((x - found.point).norm(), std::abs(found.distance), 1e-13 * (1 + x.norm()))
            << c.name;
        EXPECT_TRUE(found.hessian.allFinite()) << c.name << x.transpose();
        EXPECT_TRUE(found.normal.isZero() || std::abs(found.normal.norm() - 1) < 1e-12) << c.name;
      }
      // A hair's breadth off the surface on either side.
      for (int i = 0; i < 20; ++i) {
        const Nearest start = placed->nearest(random_point(random, pose));
        for (double off : {1e-9, -1e-9, 0.0}) {
          const Nearest found = placed->nearest(start.point + off * start.normal);
          EXPECT_LE(std::abs(found.distance), 1.0001e-9 + 1e-12) << c.name;
          if (off > 0 && start.distance > 0) {
            EXPECT_NEAR(found.distance, off, 1e-13 + 1e-6 * off) << c.name;
          }
        }
      }
    }
  }
}

TEST(SearchedShapes, AreOutsideWhereTheirDistanceIsPositive) {
  std::mt19937_64 random(7);
  const std::vector<Shape> shapes = {SuperellipsoidShape{{1, 0.4, 0.7}, 0.3, 1.6},
                                     SuperellipsoidShape{}, SupertoroidShape{}, SphereShape{1}};
  for (const Shape& shape : shapes) {
    const bool known = !std::holds_alternative<SphereShape>(shape);
    for (const std::array<double, 3>& scale : {std::array<double, 3>{1, 1, 1}, {0.5, 2, 1.3}}) {
      const Placement placement{Eigen::Quaterniond(0.7, 0.3, -0.5, 0.4).normalized(),
                                Point(1, -2, 0.5), scale};
      const auto placed = PlacedShape::create(shape, placement);
      ASSERT_TRUE(placed);
      int outside = 0;
      for (int k = 0; k < 300; ++k) {
        const Point x = random_point(random, Posed{placement});
        const double distance = placed->nearest(x).distance;
        if (std::abs(distance) < 1e-9) continue;
        outside += detail::is_outside(*placed, x) ? 1 : 0;
        EXPECT_EQ(detail::is_outside(*placed, x), known && distance > 0) << distance;
      }
      EXPECT_EQ(outside > 30, known);
    }
  }
}

}  // namespace
}  // namespace knead
