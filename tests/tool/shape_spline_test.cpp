#include "knead/spline/evaluate.hpp"
#include "tool/shape_cases.hpp"

namespace knead {
namespace {

using testing::BruteForce;
using testing::make_surface;
using testing::Posed;
using testing::random_placement;
using testing::Sheet;

/// Each pair of spans as a sheet, evaluated by the library's own evaluation.
std::vector<Sheet> sheets_of(const std::shared_ptr<const Surface>& surface) {
  std::vector<Sheet> sheets;
  const KnotVector &ku = surface->knots(0), &kv = surface->knots(1);
  for (int su : ku.spans()) {
    for (int sv : kv.spans()) {
      const double a = ku[su], b = ku[su + 1], c = kv[sv], d = kv[sv + 1];
      sheets.push_back([=](double u, double v) {
        return *evaluate_point<2>(*surface,
                                  {std::min(b, a + u * (b - a)), std::min(d, c + v * (d - c))});
      });
    }
  }
  return sheets;
}

std::shared_ptr<const Surface> bumpy(std::mt19937_64& random, KnotVector ku, KnotVector kv,
                                     bool rational) {
  std::uniform_real_distribution<double> height(-0.25, 0.25), decade(-1, 1);
  Points points(ku.count() * kv.count(), 3);
  std::vector<double> weights;
  for (int i = 0; i < ku.count(); ++i) {
    for (int j = 0; j < kv.count(); ++j) {
      points.row(i * kv.count() + j) << double(i) / (ku.count() - 1), double(j) / (kv.count() - 1),
          height(random);
      if (rational) weights.push_back(std::pow(10, decade(random)));
    }
  }
  return std::make_shared<const Surface>(
      make_surface(std::move(ku), std::move(kv), points, weights));
}

/// The unit sphere as a surface of revolution of degree (2, 2), poles and seam included.
std::shared_ptr<const Surface> sphere_surface() {
  const double q = std::sqrt(0.5);
  const auto arc = testing::make_knots(2, {0, 0, 0, 1, 1, 2, 2, 2});
  const auto circle = testing::make_knots(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4});
  const double rho[] = {0, 1, 1, 1, 0}, z[] = {-1, -1, 0, 1, 1}, wm[] = {1, q, 1, q, 1};
  const double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
  Points points(45, 3);
  std::vector<double> weights;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 9; ++j) {
      points.row(9 * i + j) << rho[i] * x[j], rho[i] * y[j], z[i];
      weights.push_back(wm[i] * (j % 2 == 0 ? 1 : q));
    }
  }
  // u runs up the meridian and v round: S_u × S_v points inwards, so v is turned round.
  for (int i = 0; i < 5; ++i) points.middleRows(9 * i, 9).colwise().reverseInPlace();
  return std::make_shared<const Surface>(make_surface(arc, circle, points, weights));
}

TEST(ShapeSpline, DistanceIsThatOfBruteForce) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> value(-0.7, 1.7);
  const std::vector<std::pair<std::vector<double>, int>> knots = {
      {{0, 0, 0, 0, 1, 1, 1, 1}, 3},
      {{0, 0, 0, 0, 1, 2, 2.5, 4, 4, 4, 4}, 3},
      {{0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2}, 3},  // a crease
      {{0, 1, 2, 3, 4, 5, 6}, 2},              // unclamped
      {{0, 0, 1, 2, 2}, 1},
      {{0, 0, 0, 0, 0, 0, 1, 1 + 1e-6, 2, 2, 2, 2, 2, 2}, 5}};
  for (std::size_t k = 0; k < knots.size(); ++k) {
    for (bool rational : {false, true}) {
      const auto& [u, p] = knots[k];
      const auto& [v, q] = knots[(k + 1) % knots.size()];
      const auto surface =
          bumpy(random, testing::make_knots(p, u), testing::make_knots(q, v), rational);
      const Posed pose{random_placement(random, true)};
      const auto placed = PlacedShape::create(SplineShape{surface}, pose.placement);
      ASSERT_TRUE(placed) << placed.error().message();
      const BruteForce brute(sheets_of(surface), pose, 24);
      const double size = pose.placement.scale[0] + pose.placement.scale[1];
      int uncertified = 0;
      for (int i = 0; i < 40; ++i) {
        Point inside = testing::drawn(value, random);
        inside.z() *= 0.5;
        const Point x = pose.out(inside);
        const Nearest found = placed->nearest(x);
        uncertified += found.converged ? 0 : 1;
        EXPECT_NEAR(std::abs(found.distance), brute.distance(x, 20), 1e-10 * size)
            << "knots " << k << rational;
        EXPECT_NEAR((x - found.point).norm(), std::abs(found.distance), 1e-12 * size);
        EXPECT_NEAR(found.normal.norm(), 1, 1e-12);
      }
      EXPECT_LE(uncertified, 1) << "knots " << k << rational;
    }
  }
}

TEST(ShapeSpline, SphereAsASurfaceIsTheSphere) {
  const auto surface = sphere_surface();
  const auto spline = PlacedShape::create(SplineShape{surface});
  const auto sphere = PlacedShape::create(SphereShape{1});
  ASSERT_TRUE(spline && sphere);
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> value(-2, 2);
  std::vector<Point> points;
  for (int k = 0; k < 500; ++k) points.emplace_back(value(random), value(random), value(random));
  for (double z : {2.0, 0.5, -0.5, -3.0}) points.emplace_back(0, 0, z);  // towards the poles
  for (double z : {2.0, 0.5, -0.5, -3.0}) points.emplace_back(1e-9, -1e-9, z);
  for (double x : {2.0, 0.5}) points.emplace_back(x, 0, 0);  // on the seam
  for (const Point& x : points) {
    if (x.norm() < 0.05) continue;
    const Nearest a = spline->nearest(x), b = sphere->nearest(x);
    EXPECT_TRUE(a.converged) << x.transpose();
    EXPECT_NEAR(a.distance, b.distance, 1e-12) << x.transpose();
    EXPECT_LE((a.point - b.point).norm(), 1e-10 / x.norm()) << x.transpose();
    EXPECT_LE((a.normal - b.normal).norm(), 1e-9 / std::min(1.0, x.norm())) << x.transpose();
    EXPECT_LE((a.hessian - b.hessian).norm(), 1e-6 * b.hessian.norm() * b.hessian.norm() + 1e-6)
        << x.transpose();
  }
}

TEST(ShapeSpline, MiddleOfASphereSurfaceIsReportedAsUncertain) {
  const auto spline = PlacedShape::create(SplineShape{sphere_surface()});
  ASSERT_TRUE(spline);
  const Nearest found = spline->nearest(Point::Zero());
  EXPECT_NEAR(found.distance, -1, 1e-12);
  EXPECT_FALSE(found.converged);
}

TEST(ShapeSpline, OutsideIsTheSideOfTheNormalAndBeyondTheBorder) {
  const auto ku = testing::make_knots(1, {0, 0, 1, 1});
  const auto surface = std::make_shared<const Surface>(testing::sheet(ku, ku));
  const auto placed = PlacedShape::create(SplineShape{surface});
  ASSERT_TRUE(placed);
  EXPECT_NEAR(placed->nearest(Point(0.3, 0.4, 0.5)).distance, 0.5, 1e-15);
  EXPECT_NEAR(placed->nearest(Point(0.3, 0.4, -0.5)).distance, -0.5, 1e-15);
  EXPECT_EQ(placed->nearest(Point(0.3, 0.4, -0.5)).hessian.norm(), 0);
  const Nearest beyond = placed->nearest(Point(1.3, 0.4, -0.4));
  EXPECT_NEAR(beyond.distance, 0.5, 1e-15);
  EXPECT_LE((beyond.normal - Point(0.6, 0, -0.8)).norm(), 1e-14);
  EXPECT_NEAR(beyond.hessian.trace(), 2, 1e-12);  // a cylinder round the border: 1/0.5
  EXPECT_NEAR(placed->nearest(Point(2, 2, -1)).hessian.trace(), 2 / std::sqrt(3.0),
              1e-12);  // a ball round the corner
}

TEST(ShapeSpline, ACreaseHasOneInsideOnBothOfItsSides) {
  // A roof over y: outside above. Below the ridge, and above it, the ridge is nearest or its two
  // slopes are.
  const auto ku = testing::make_knots(1, {0, 0, 1, 1}),
             kv = testing::make_knots(1, {0, 0, 1, 2, 2});
  Points points(6, 3);
  points << 0, -1, 0, 0, 0, 1, 0, 1, 0, 1, -1, 0, 1, 0, 1, 1, 1, 0;
  const auto surface = std::make_shared<const Surface>(make_surface(ku, kv, points));
  const auto placed = PlacedShape::create(SplineShape{surface});
  ASSERT_TRUE(placed);
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> value(-0.5, 0.5);
  for (int k = 0; k < 300; ++k) {
    const Point x(0.5 + 0.9 * value(random), 0.5 * value(random), 1 + value(random));
    const double depth = (x.z() - 1 + std::abs(x.y())) /
                         std::sqrt(2.0);  // signed distance to the nearer slope's plane
    const Nearest found = placed->nearest(x);
    EXPECT_EQ(found.distance < 0, depth < 0) << x.transpose();
    if (depth < 0 && std::abs(x.y()) < 0.2) {
      EXPECT_NEAR(found.distance, depth, 1e-13) << x.transpose();
    }
  }
}

TEST(ShapeSpline, WeightsThatAreNotPositiveAreNamed) {
  const auto ku = testing::make_knots(1, {0, 0, 1, 1});
  Points points(4, 3);
  points << 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0;
  const auto surface = std::make_shared<const Surface>(make_surface(ku, ku, points, {1, 1, -1, 1}));
  const auto placed = PlacedShape::create(SplineShape{surface});
  ASSERT_FALSE(placed);
  EXPECT_NE(placed.error().where.find("surface"), std::string::npos);
}

}  // namespace
}  // namespace knead
