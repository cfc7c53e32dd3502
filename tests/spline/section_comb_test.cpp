#include "spline/section_comb.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "knead/spline/revolution.hpp"

namespace knead {
namespace {

/// Round the z axis, from z = -height to height.
Surface cylinder(double radius, double height) {
  Points ends(2, 3);
  ends << radius, 0, -height, radius, 0, height;
  return *revolve(*Curve::create({*KnotVector::create(1, {0, 0, 1, 1})}, ends));
}

Surface sphere(double radius) { return *revolve(*circle_quarters({0, 0}, radius, 3, 2)); }

/// Whether the teeth of a comb lie on the plane, and the vectors in it.
void expect_in_plane(const SectionComb& comb, const SectionPlane& plane, double size) {
  for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
    EXPECT_NEAR(comb.places.row(k).dot(plane.normal), plane.offset, 1e-11 * size);
    EXPECT_NEAR(comb.vectors.row(k).dot(plane.normal), 0, 1e-11 / size);
  }
}

TEST(SectionCombs, OfASphereAreOneOverTheRadiusOfTheCircle) {
  const double r = 30;
  for (const Point& normal :
       {Point(0, 0, 1), Point(1, 0, 0), Point(0.6, 0, 0.8), Point(0.48, 0.6, 0.64)}) {
    for (const double offset : {0.3, 12.0, -25.0}) {
      const SectionPlane plane{normal, offset};
      const auto combs = section_combs(sphere(r), plane, 0.01);
      ASSERT_TRUE(combs);
      ASSERT_FALSE(combs->empty());
      const double small = std::sqrt(r * r - offset * offset);
      Eigen::Index teeth = 0;
      for (const SectionComb& comb : *combs) {
        expect_in_plane(comb, plane, r);
        teeth += comb.places.rows();
        for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
          // Of length `small`.
          const Point towards = offset * normal - Point(comb.places.row(k).transpose());
          EXPECT_NEAR(towards.norm(), small, 1e-10 * r);
          EXPECT_NEAR((Point(comb.vectors.row(k).transpose()) - towards / (small * small)).norm(),
                      0, 1e-9 / small);
        }
      }
      EXPECT_GT(teeth, 24);
    }
  }
}

TEST(SectionCombs, OfASlantedCutOfACylinderAreThoseOfTheEllipse) {
  const double r = 10;
  for (const double slant : {0.0, 0.3, 1.0, 1.3}) {  // of the plane against the circles
    const SectionPlane plane{{std::sin(slant), 0, std::cos(slant)}, 0.5};
    const auto combs = section_combs(cylinder(r, 100), plane, 0.01);
    ASSERT_TRUE(combs);
    const double a = r / std::cos(slant), b = r;  // semi-axes: along (cos, 0, -sin), and along y
    const Point axis(std::cos(slant), 0, -std::sin(slant)), centre(0, 0, 0.5 / std::cos(slant));
    Eigen::Index teeth = 0;
    for (const SectionComb& comb : *combs) {
      expect_in_plane(comb, plane, r);
      teeth += comb.places.rows();
      for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
        const Point p = Point(comb.places.row(k).transpose()) - centre;
        const double c = p.dot(axis) / a, s = p.y() / b;
        EXPECT_NEAR(c * c + s * s, 1, 1e-11);
        const double expected = a * b / std::pow(a * a * s * s + b * b * c * c, 1.5);
        EXPECT_NEAR(comb.vectors.row(k).norm(), expected, 1e-10 * expected + 1e-12);
        EXPECT_LT(comb.vectors.row(k).dot(p), 0);  // towards the inside
      }
    }
    EXPECT_GT(teeth, 24);
  }
}

TEST(SectionCombs, AlongACylinderAreStraight) {
  const auto combs = section_combs(cylinder(10, 20), {{0.6, 0.8, 0}, 3}, 0.01);
  ASSERT_TRUE(combs);
  ASSERT_EQ(combs->size(), 2U);
  for (const SectionComb& comb : *combs) {
    EXPECT_LT(comb.vectors.cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_NEAR((comb.places.bottomRows(1) - comb.places.topRows(1)).norm(), 40, 1e-10);
  }
}

TEST(SectionCombs, FollowEachCurveOnce) {
  // The sides of the grid do not divide a curve: neighbouring teeth are neighbours on the circle.
  const auto combs = section_combs(sphere(30), {{0, 0, 1}, 10}, 0.01);
  ASSERT_TRUE(combs);
  ASSERT_EQ(combs->size(), 1U);
  const Points& places = combs->front().places;
  double length = 0;
  for (Eigen::Index k = 0; k + 1 < places.rows(); ++k)
    length += (places.row(k + 1) - places.row(k)).norm();
  const double whole = 2 * std::acos(-1.0) * std::sqrt(800.0);
  EXPECT_LT(length, whole);
  EXPECT_GT(length, 0.99 * whole);
}

TEST(SectionCombs, AreNoneBesideTheSurfaceAndAnErrorWithoutAPlane) {
  EXPECT_TRUE(section_combs(sphere(30), {{0, 0, 1}, 31}, 0.01)->empty());
  EXPECT_FALSE(section_combs(sphere(30), {{0, 0, 2}, 0}, 0.01).has_value());
  EXPECT_FALSE(section_combs(sphere(30), {{0, 0, 1}, NAN}, 0.01).has_value());
  EXPECT_FALSE(section_combs(sphere(30), {{0, 0, 1}, 0}, 0).has_value());
}

}  // namespace
}  // namespace knead
