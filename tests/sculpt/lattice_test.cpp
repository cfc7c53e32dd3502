#include "sculpt/lattice.hpp"

#include <gtest/gtest.h>

#include "knead/contact/active_spline.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

const BoundingBox flat_box{Point(-1, 2, 0),
                           Point(3, 4, 0)};  // flat: the margin gives it a thickness

TEST(Lattice, AtRestLeavesEveryBitAndUnderAnAffineMapIsThatMap) {
  const auto lattice = Lattice::create(flat_box, 0.1, {3, 2, 1}, {6, 4, 2});
  ASSERT_TRUE(lattice) << lattice.error().message();
  Points inside = testing::random_points(200, 3);
  for (int i = 0; i < 200; ++i)
    inside.row(i) =
        (Point(1, 3, 0) + Point(2, 1, 0.2).cwiseProduct(inside.row(i).transpose())).transpose();
  EXPECT_EQ(*lattice->deformed(inside, lattice->rest().control_points()), inside);
  Eigen::Matrix3d a;
  a << 1.1, 0.3, -0.2, 0, 0.9, 0.4, 0.2, 0.1, 1.3;
  const auto map = [&](const Points& p) {
    return Points((p * a.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3));
  };
  const auto moved = lattice->deformed(inside, map(lattice->rest().control_points()));
  ASSERT_TRUE(moved);
  EXPECT_LT((*moved - map(inside)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Lattice, CarriesASurfaceAlongWithTheToolThatPressesTheSpace) {
  const Surface sheet = testing::uniform_sheet(3, 12, 12);
  const auto lattice = Lattice::create({Point(0, 0, 0), Point(1, 1, 0)}, 0.1, {2, 2, 2}, {7, 7, 4});
  ASSERT_TRUE(lattice);
  const std::vector<std::string> names = {"u0", "u1"};
  ActiveSettings<3> settings;
  settings.held = *lattice->faces(names, 1);
  settings.detail = 0.25;
  const Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.5, 0.3), 0.25), ToolMode::collision,
                     1e4, 1};
  const auto model = ActiveSpline<3>::create(lattice->rest(), settings);
  ASSERT_TRUE(model) << model.error().message();
  ActiveState state{lattice->rest().control_points()};
  for (int k = 0; k < 6; ++k) state.control_points = model->step(state, {&ball, 1})->control_points;
  const auto moved = lattice->deformed(sheet.control_points(), state.control_points);
  ASSERT_TRUE(moved);
  const double middle = (*moved)(6 * 12 + 6, 2), corner = std::abs((*moved)(0, 2));
  EXPECT_LT(middle, -0.01);  // pushed away from the ball above it
  EXPECT_LT(corner, 0.3 * -middle);
}

TEST(Lattice, NamesWhatIsWrong) {
  EXPECT_EQ(Lattice::create(flat_box, 0, {3, 3, 3}, {6, 6, 6}).error().where, "margin");
  EXPECT_NE(Lattice::create(flat_box, 0.1, {3, 3, 3}, {3, 6, 6}).error().where.find("net"),
            std::string::npos);
  const auto lattice = Lattice::create(flat_box, 0.1, {3, 3, 3}, {6, 6, 6});
  const std::vector<std::string> wrong = {"top"};
  EXPECT_NE(lattice->faces(wrong, 1).error().remedy.find("u0"), std::string::npos);
  Points outside(2, 3);
  outside << 0, 3, 0, 100, 3, 0;
  EXPECT_EQ(lattice->deformed(outside, lattice->rest().control_points()).error().where, "point 1");
}

TEST(MirroredTool, HasTheDistancesOfTheMirrorImage) {
  const Point point(0.3, -0.2, 1), normal = Point(1, 2, -0.5).normalized();
  const auto reflect = [&](const Point& x) {
    return Point(x - 2 * normal.dot(x - point) * normal);
  };
  const auto surface = std::make_shared<const Surface>(
      testing::relief(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 4), 5, 0.3, 2));
  for (const Shape& shape :
       {Shape(SphereShape{0.4}), Shape(EllipsoidShape{{0.2, 0.5, 0.3}}),
        Shape(BoxShape{{0.2, 0.5, 0.3}, 0.05}), Shape(ConeShape{0.4, 0.8, 0.1}),
        Shape(TorusShape{0.5, 0.1}), Shape(BowlShape{0.5, 0.1}), Shape(PlaneShape{}),
        Shape(SplineShape{surface})}) {
    Tool tool{"tool",
              *PlacedShape::create(shape, {Eigen::Quaterniond(0.3, 0.5, -0.7, 0.2).normalized(),
                                           Point(1, 2, 3),
                                           {1, 1, 1}})};
    const auto image = mirrored(tool, point, normal);
    ASSERT_TRUE(image) << image.error().message();
    ASSERT_TRUE(*image);
    const Points samples = testing::random_points(60, 9);
    for (int i = 0; i < 60; ++i) {
      const Point x = Point(1, 2, 3) + samples.row(i).transpose();
      EXPECT_NEAR((*image)->shape.nearest(reflect(x)).distance, tool.shape.nearest(x).distance,
                  1e-9)
          << shape.index();
    }
  }
}

TEST(MirroredTool, IsNothingWhereTheToolIsItsOwnImage) {
  const Tool ball{"ball", testing::sphere_at(Point(0.5, 0.2, 0.1), 0.3)};
  EXPECT_FALSE(*mirrored(ball, Point(0.5, 0, 0), Point::UnitX()));
  EXPECT_TRUE(*mirrored(ball, Point(0.5001, 0, 0), Point::UnitX()));
}

/// A sheet with its rim held, under a ball and perhaps forces on points.
struct Sheet {
  Surface surface = testing::uniform_sheet(3, 20, 20);
  ActiveSettings<2> settings;

  Sheet() {
    for (int i = 0; i < 400; ++i) {
      const int a = i / 20, b = i % 20;
      settings.held.push_back(a < 1 || b < 1 || a > 18 || b > 18);
    }
    settings.detail = 0.3;
  }
};

TEST(ForceRoute, AnalyticAndGaussDifferByWhatInterpolationMisses) {
  Sheet s;
  s.settings.evolution = Evolution::stationary;
  const Tool ball = {"ball", testing::sphere_at(Point(0.5, 0.47, 0.25), 0.3), ToolMode::collision,
                     100, 1};
  const auto gauss =
      ActiveSurface::create(s.surface, s.settings)->step(s.surface.control_points(), {&ball, 1});
  s.settings.route = ForceRoute::analytic;
  const auto analytic =
      ActiveSurface::create(s.surface, s.settings)->step(s.surface.control_points(), {&ball, 1});
  ASSERT_TRUE(gauss && analytic);
  EXPECT_EQ(analytic->note, "");
  EXPECT_LT(analytic->residual, 1e-6);  // in balance with the forces of its own route
  const double way = (gauss->control_points - s.surface.control_points()).cwiseAbs().maxCoeff();
  const double difference =
      (gauss->control_points - analytic->control_points).cwiseAbs().maxCoeff();
  EXPECT_GT(way, 0.01);
  EXPECT_GT(difference, 0);
  EXPECT_LT(difference, 0.1 * way);  // a kink at the edge of the contact: first order in the spans
}

TEST(PointForce, SpringPullsAndVolcanoPushesWithTheStrengthThatTheySay) {
  Sheet s;
  s.settings.evolution = Evolution::stationary;
  const auto model = ActiveSurface::create(s.surface, s.settings);
  PointForce force;
  force.terms = {{10 * 20 + 10, 1.0}};
  force.to = Point(0.5, 0.5, 0.4);
  force.strength = 0.5;
  for (const auto kind : {PointForce::Kind::spring, PointForce::Kind::volcano}) {
    force.kind = kind;
    force.core = 0.05;
    ActiveLoads loads;
    loads.points = {force};
    const auto step = model->step(ActiveState{s.surface.control_points()}, {}, loads);
    ASSERT_TRUE(step) << step.error().message();
    EXPECT_TRUE(step->converged);
    EXPECT_LT(step->residual, 1e-8);
    const double z = step->control_points(10 * 20 + 10, 2);
    if (kind == PointForce::Kind::spring) {
      EXPECT_GT(z, 0.01);
    } else {
      EXPECT_LT(z, -0.01);
    }
  }
}

}  // namespace
}  // namespace knead
