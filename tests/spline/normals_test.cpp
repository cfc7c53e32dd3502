#include "knead/spline/evaluate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "knead/spline/curvature.hpp"
#include "knead/spline/revolution.hpp"
#include "sample_splines.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A sphere about the origin with outward normals and a pole at each end of v.
Surface sphere(double radius) { return *revolve(*circle_quarters({0, 0}, radius, -1, 2)); }

TEST(UnitNormals, OfASphereAreItsRadiiAndZeroAtThePoles) {
  for (const double radius : {1e-3, 1.0, 2e4}) {
    const Surface surface = sphere(radius);
    const std::vector<double> u = {0, 0.1, 0.25, 0.6, 1}, v = {0, 0.2, 0.5, 0.77, 1};
    const auto normals = unit_normals_on_grid(surface, {u, v});
    const auto points = evaluate_grid<2>(surface, {u, v});
    ASSERT_TRUE(normals && points);
    for (Eigen::Index k = 0; k < normals->rows(); ++k) {
      const bool pole = k % 5 == 0 || k % 5 == 4;
      if (pole) {
        EXPECT_TRUE(normals->row(k).isZero(0)) << normals->row(k);
      } else {
        EXPECT_LE((normals->row(k) - points->points().row(k) / radius).norm(), 32 * epsilon);
      }
    }
  }
}

TEST(UnitNormals, HaveUnitLengthAndStandOnBothDerivatives) {
  std::mt19937_64 random(41);
  for (const double decades : {-1.0, 0.5}) {
    for (int p = 1; p <= 4; ++p) {
      const auto surface = testing::random_spline<2>(
          random, {testing::uniform_clamped(p, 5), testing::uniform_unclamped(3, 4)}, decades);
      const Parameters<2> at = testing::rows_of<2>(testing::grid_of(surface));
      for (const Side side : {Side::left, Side::right}) {
        const auto jet = evaluate<2>(surface, at, 1, side);
        const auto normals = unit_normals(surface, at, side);
        ASSERT_TRUE(jet && normals);
        for (Eigen::Index k = 0; k < at.rows(); ++k) {
          const Point n = normals->row(k), a = jet->at({1, 0}).row(k), b = jet->at({0, 1}).row(k);
          const double share = a.norm() * b.norm() / a.cross(b).norm();
          ASSERT_FALSE(n.isZero(0));
          EXPECT_LE(std::abs(n.norm() - 1), 4 * epsilon);
          EXPECT_LE(std::abs(n.dot(a)), 8 * epsilon * share * a.norm());
          EXPECT_LE(std::abs(n.dot(b)), 8 * epsilon * share * b.norm());
          EXPECT_GT(a.cross(b).dot(n), 0);
        }
      }
    }
  }
}

TEST(UnitNormals, AreThoseOfCurvature) {
  const Surface surface = sphere(3);
  const auto normals = unit_normals(surface, Parameters<2>{{0.3, 0.4}});
  EXPECT_LE((normals->row(0).transpose() - curvature(surface, {0.3, 0.4})->normal).norm(),
            4 * epsilon);
}

TEST(UnitNormals, OfAGridAreThoseOfItsPoints) {
  std::mt19937_64 random(42);
  for (const double decades : {-1.0, 0.5}) {
    const auto surface = testing::random_spline<2>(
        random, {testing::random_knots(random, 3), testing::random_knots(random, 2)}, decades);
    const auto grid = testing::grid_of(surface);
    const auto evaluator = Evaluator<2>::on_grid(surface.knots(), testing::spans_of<2>(grid), 1);
    const Points expected = *unit_normals(surface, testing::rows_of<2>(grid));
    EXPECT_EQ(*unit_normals_on_grid(surface, testing::spans_of<2>(grid)), expected);
    EXPECT_EQ(unit_normals(*evaluator->evaluate(surface)), expected);
  }
}

/// A bilinear or biquadratic patch over [0, 1]².
Surface patch(int p, const Points& points) {
  const auto knots = testing::clamped_knots(p, {0, 1}, {0, 0});
  return testing::make_spline<2>({knots, knots}, points);
}

TEST(UnitNormals, AreZeroWhereTheDerivativesSpanNoPlane) {
  // An edge that is one point: S_v = 0 along u = 0.
  const Surface pole = patch(1, Points{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(*unit_normals(pole, Parameters<2>{{0, 0}, {0, 0.5}, {0, 1}, {0.5, 0.5}}),
            (Points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
  // Derivatives that are parallel at a corner: three of its control points lie on a line.
  const Surface straight = patch(1, Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}});
  EXPECT_TRUE(unit_normals(straight, Parameters<2>{{0, 0}})->isZero(0));
  EXPECT_FALSE(unit_normals(straight, Parameters<2>{{0.5, 0.5}})->isZero(0));
  // A surface that is a line, or a point, has no normal anywhere.
  const Surface line = patch(1, Points{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {3, 6, 9}});
  const Surface point = patch(1, Points{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  for (const Surface* s : {&line, &point}) {
    EXPECT_TRUE(unit_normals(*s, Parameters<2>{{0, 0}, {0.3, 0.6}, {1, 1}})->isZero(0));
  }
}

TEST(UnitNormals, AreZeroWhereOneDirectionIsABillionTimesFaster) {
  for (const auto& [length, normal] : {std::pair{1e-8, true}, {1e-10, false}}) {
    const auto short_span = *KnotVector::create(1, {0, 0, length, length});
    const auto flat = testing::make_spline<2>({short_span, *KnotVector::create(1, {0, 0, 1, 1})},
                                              Points{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
    EXPECT_EQ(unit_normals(flat, Parameters<2>{{0, 0}})->row(0),
              Eigen::RowVector3d(0, 0, normal ? 1 : 0));
  }
}

TEST(UnitNormals, DoNotDependOnTheSizeOfTheSurface) {
  std::mt19937_64 random(43);
  const auto surface = testing::random_spline<2>(
      random, {testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 4)});
  const Parameters<2> at = testing::rows_of<2>(testing::grid_of(surface));
  const Points expected = *unit_normals(surface, at);
  for (const double size : {std::ldexp(1, -240), std::ldexp(1, 160)}) {
    const auto scaled = surface.with_control_points(size * surface.control_points());
    EXPECT_EQ(*unit_normals(*scaled, at), expected);
  }
}

TEST(UnitNormals, BitsDoNotDependOnTheNumberOfThreads) {
  const Surface surface = sphere(2);
  std::vector<double> u;
  for (int k = 0; k <= 240; ++k) u.push_back(k / 240.0);
  const auto run = [&] { return *unit_normals_on_grid(surface, {u, u}); };
  const Points expected = testing::with_threads(1, run);
  for (const int threads : testing::thread_counts)
    EXPECT_EQ(testing::with_threads(threads, run), expected);
}

TEST(UnitNormals, FailAsEvaluationDoes) {
  EXPECT_EQ(unit_normals(sphere(1), Parameters<2>{{0, 0}, {0, 2}}).error().where,
            "direction 1: parameter 1");
}

}  // namespace
}  // namespace knead
