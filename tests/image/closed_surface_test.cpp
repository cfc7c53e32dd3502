#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "image/volume_fixtures.hpp"
#include "knead/image/surface_snake.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

using std::numbers::pi;
using testing::distances, testing::Radii;

TEST(ClosedSurface, OfEveryDegreeIsTheSphereOrTheTorus) {
  for (const int p : {2, 3, 4, 5, 7}) {
    const SurfaceSnakeSettings settings{.degree = p, .control_points = {32, 24}};
    const auto ball =
        closed_surface({.centre = {1, 2, 3}, .radii = {10, 10, 10}, .axis = {1, 1, 0}}, settings);
    ASSERT_TRUE(ball) << ball.error().message();
    const Radii r = distances(*ball, {1, 2, 3});
    EXPECT_NEAR(r.least, 10, p == 2 ? 1e-2 : 2e-3) << p;
    EXPECT_NEAR(r.most, 10, p == 2 ? 1e-2 : 2e-3) << p;
    const SurfaceMeasure m = measure(*ball);
    EXPECT_NEAR(m.volume, 4 * pi / 3 * 1000, p == 2 ? 2 : 0.5) << p;
    EXPECT_NEAR(m.area, 4 * pi * 100, p == 2 ? 0.3 : 0.05) << p;
    const auto ring = closed_surface({.form = SurfaceForm::torus, .radii = {10, 4}}, settings);
    ASSERT_TRUE(ring) << ring.error().message();
    EXPECT_NEAR(measure(*ring).volume, 2 * pi * pi * 10 * 16, p == 2 ? 0.5 : 0.1) << p;
    EXPECT_NEAR(measure(*ring).area, 4 * pi * pi * 40, p == 2 ? 0.5 : 0.1) << p;
  }
}

TEST(ClosedSurface, PolesAreOnePointWithATangentPlane) {
  const auto egg = closed_surface({.radii = {10, 7, 4}}, {.control_points = {20, 12}});
  ASSERT_TRUE(egg);
  const Points& c = egg->surface.control_points();
  for (const int column : {0, 11}) {
    for (int i = 1; i < 23; ++i) EXPECT_LT((c.row(i * 12 + column) - c.row(column)).norm(), 1e-13);
  }
  for (const double v : {0.0, egg->surface.knots()[1].domain().upper}) {
    Parameters<2> at(40, 2);
    for (int k = 0; k < 40; ++k) at.row(k) << egg->surface.knots()[0].domain().length() * k / 40, v;
    const auto slopes = evaluate(egg->surface, at, 1, v > 0 ? Side::left : Side::right);
    ASSERT_TRUE(slopes);
    for (int k = 0; k < 40; ++k) {
      const Eigen::RowVector3d along = slopes->at({0, 1}).row(k);
      EXPECT_NEAR(along[2], 0, 1e-12);  // the plane across the axis
      EXPECT_GT(along.norm(), 0.3);
    }
  }
}

TEST(ClosedMesh, IsClosedAndKnowsWhatIsInside) {
  for (const SurfaceForm form : {SurfaceForm::sphere, SurfaceForm::torus}) {
    const auto surface =
        closed_surface({.form = form,
                        .centre = {20, 20, 20},
                        .radii = {12, form == SurfaceForm::torus ? 5.0 : 12.0, 12}},
                       {});
    ASSERT_TRUE(surface);
    const ClosedMesh mesh = closed_mesh(*surface);
    const auto points = mesh.points.rows(), triangles = std::ssize(mesh.triangles);
    EXPECT_EQ(points - triangles / 2,
              form == SurfaceForm::torus ? 0 : 2);  // Euler's number: 3 edges for 2 triangles
    double volume = 0;
    for (const auto& t : mesh.triangles) {
      volume += mesh.points.row(t[0]).dot(mesh.points.row(t[1]).cross(mesh.points.row(t[2]))) / 6;
    }
    EXPECT_NEAR(volume, measure(*surface).volume, 0.01 * volume);
    EXPECT_EQ(crossings(mesh), 0);
    const VolumeImage mask = mask_of(mesh, {41, 41, 41}, {});
    for (int k = 0; k < 41; ++k) {
      for (int j = 0; j < 41; ++j) {
        for (int i = 0; i < 41; ++i) {
          const double x = i - 20, y = j - 20, z = k - 20;
          const double out = form == SurfaceForm::torus ? std::hypot(std::hypot(x, y) - 12, z) - 5
                                                        : std::hypot(x, y, z) - 12;
          if (std::abs(out) < 0.05) continue;
          EXPECT_EQ(mask.at(i, j, k), out < 0 ? 1 : 0) << i << " " << j << " " << k;
        }
      }
    }
  }
}

TEST(ClosedMesh, KnowsWhereItCrossesItself) {
  auto ball = closed_surface({.radii = {10, 10, 10}}, {.control_points = {16, 12}});
  ASSERT_TRUE(ball);
  Points c = ball->surface.control_points();
  for (Eigen::Index k = 0; k < c.rows(); ++k) {
    if (c(k, 2) > 5)
      c.row(k) << c(k, 0) / 2, c(k, 1) / 2,
          -30 - c(k, 2);  // the north cap goes out through the south
  }
  const ClosedSurface crossed{*ball->surface.with_control_points(std::move(c)), ball->form};
  const ClosedMesh mesh = closed_mesh(crossed);
  EXPECT_GT(crossings(mesh), 10);
}

}  // namespace
}  // namespace knead
