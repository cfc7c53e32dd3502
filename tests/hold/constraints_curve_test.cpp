#include <gtest/gtest.h>

#include <numbers>

#include "hold/constrained.hpp"

namespace knead {
namespace {

using namespace testing;

/// |D| along the polyline, the largest of many samples, less what the rounding of (u, v) itself
/// moves.
double largest_on(const Surface& displacement, const Parameters<2>& polyline) {
  double most = 0;
  for (Eigen::Index k = 0; k + 1 < polyline.rows(); ++k) {
    Parameters<2> at(400, 2);
    for (int t = 0; t < 400; ++t)
      at.row(t) = polyline.row(k) + (t / 399.0) * (polyline.row(k + 1) - polyline.row(k));
    for (int d = 0; d < 2; ++d) {
      const Interval domain = displacement.knots(d).domain();
      at.col(d) = at.col(d).cwiseMax(domain.lower).cwiseMin(domain.upper);
    }
    const auto e = evaluate(displacement, at, 1);
    for (int t = 0; t < 400; ++t) {
      const double slip = 2e-16 * (std::abs(at(t, 0)) * e->at({1, 0}).row(t).norm() +
                                   std::abs(at(t, 1)) * e->at({0, 1}).row(t).norm());
      most = std::max(most, e->points().row(t).norm() - slip);
    }
  }
  return most;
}

Parameters<2> zigzag(const Surface& s) {
  const double shares[5][2] = {{0.1, 0.2}, {0.55, 0.35}, {0.55, 0.8}, {0.9, 0.9}, {1, 0.13}};
  Parameters<2> polyline(5, 2);
  for (int k = 0; k < 5; ++k) {
    for (int d = 0; d < 2; ++d) {
      const Interval domain = s.knots(d).domain();
      polyline(k, d) = std::lerp(domain.lower, domain.upper, shares[k][d]);
    }
  }
  return polyline;
}

TEST(KeepCurve, HoldsEveryPointToTheBoundItStates) {
  int count = 0;
  for (const auto& [name, s] : reliefs(2, 3, true, 10)) {
    const Parameters<2> polyline = zigzag(s);
    for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
      ConstraintList list(s.size());
      const auto kept = keep_curve(s, polyline, tolerance, list);
      ASSERT_TRUE(kept) << name << kept.error().message();
      EXPECT_LE(kept->bound, tolerance * 1.0001) << name;
      for (unsigned seed = 1; seed <= 2; ++seed) {
        const Points x = random_member(s, list, seed);
        EXPECT_LT(largest_on(field(s, x), polyline),
                  kept->bound * x.rowwise().norm().maxCoeff() + 1e-11)
            << name;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 100);
}

TEST(KeepCurve, LargerTolerancesLeaveMoreFreedom) {
  const Surface s = relief(uniform_clamped(3, 20), uniform_clamped(3, 20), 3);
  Parameters<2> diagonal(2, 2);
  diagonal << 1.3, 2.2, 18.1, 17.4;
  int before = s.size();
  for (const double tolerance : {1e-9, 1e-3, 1e-1}) {
    ConstraintList list(s.size());
    const auto kept = keep_curve(s, diagonal, tolerance, list);
    ASSERT_TRUE(kept);
    EXPECT_LT(kept->constraints, before);
    before = kept->constraints;
    RecordProperty("constraints at " + std::to_string(tolerance), before);
  }
}

TEST(KeepCurve, AlongAnIsolineIsTheIsoline) {
  const Surface s = relief(uniform_clamped(3, 5), uniform_clamped(2, 6), 4);
  Parameters<2> line(2, 2);
  line << 2.3, 0, 2.3, 6;
  ConstraintList curve(s.size()), isoline(s.size());
  ASSERT_TRUE(keep_curve(s, line, 1e-9, curve));
  ASSERT_TRUE(hold_isoline(s, 0, 2.3, 0, isoline));
  EXPECT_EQ(space_of(s, curve).free_count(), space_of(s, isoline).free_count());
  EXPECT_LT(largest_on(field(s, random_member(s, curve, 1)), line), 1e-12);
}

TEST(KeepCurve, FollowsASplineInTheParameterDomain) {
  const Surface s = relief(uniform_clamped(3, 8), uniform_clamped(3, 8), 5);
  Points control(5, 3);
  control << 1, 1, 0, 2, 6, 0, 4, 7, 0, 6, 6, 0, 7, 1, 0;
  const auto curve = Curve::create({uniform_clamped(3, 2)}, control);
  const auto polyline = parameter_polyline(s, *curve, 1e-4);
  ASSERT_TRUE(polyline);
  const auto finer = parameter_polyline(s, *curve, 1e-6);
  ASSERT_TRUE(finer);
  EXPECT_GT(finer->rows(), polyline->rows());
  EXPECT_FALSE(parameter_polyline(s, *curve, 0));
  ConstraintList list(s.size());
  const auto kept = keep_curve(s, *polyline, 1e-3, list);
  ASSERT_TRUE(kept);
  const Points x = random_member(s, list, 2);
  std::vector<double> t;
  for (int k = 0; k <= 300; ++k) t.push_back(k / 150.0);
  const Parameters<2> at = evaluate_grid<1>(*curve, {t})->points().leftCols<2>();
  // A polyline that stays within δ of the curve misses it by δ |grad D|: here by a few of the
  // chords' 1e-4.
  EXPECT_LT(evaluate(field(s, x), at)->points().rowwise().norm().maxCoeff(), 1e-2);
}

TEST(KeepCurve, RefusesWhatIsNoCurveOnTheSurface) {
  const Surface s = uniform_sheet(3, 6, 6);
  ConstraintList list(s.size());
  Parameters<2> one(1, 2), outside(2, 2), good(2, 2);
  one << 0.5, 0.5;
  outside << 0.5, 0.5, 1.5, 0.5;
  good << 0.1, 0.1, 0.9, 0.9;
  EXPECT_FALSE(keep_curve(s, one, 1e-3, list));
  EXPECT_FALSE(keep_curve(s, outside, 1e-3, list));
  EXPECT_FALSE(keep_curve(s, good, 0, list));
  EXPECT_FALSE(keep_curve(s, good, 2, list));
  EXPECT_TRUE(list.constraints.empty());
}

}  // namespace
}  // namespace knead
