#include "knead/energy/loads.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/energy/stiffness.hpp"
#include "support/numbers.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

constexpr DomainScaling<2> scaling = {1.0, {0.7, 2.5}};

std::vector<Surface> surfaces() {
  std::vector<Surface> result;
  for (const auto& family : testing::knot_families(3)) {
    if (!family.ordinary() || family.knots.count() > 30) continue;
    result.push_back(
        testing::relief(family.knots, testing::clamped_knots(2, {0, 1, 3}, {3, 2, 3}), 3));
  }
  result.push_back(
      testing::relief(testing::uniform_unclamped(2, 3), testing::uniform_clamped(3, 2), 5, 0.1, 2));
  result.push_back(testing::cylinder());
  result.push_back(testing::sphere());
  return result;
}

/// What a constant load gives by the mass matrix: Σ_j ∫ R_i R_j = ∫ R_i.
Points by_mass(const Surface& s, const Point& f) {
  const auto m = Stiffness<2>::create(s, on_scaled_domain<2>(mass_energy<2>(), scaling.factors),
                                      {.rational_tolerance = 1e-13});
  return m->apply(f.transpose().replicate(s.size(), 1));
}

using testing::largest;

TEST(Load, ThatIsConstantIsTheSameByEveryRoute) {
  const Point f(0.3, -2, 1);
  for (const Surface& s : surfaces()) {
    const Points expected = by_mass(s, f);
    const Points samples = f.transpose().replicate(6, 1);
    const auto spline = sampled_load<2>(s, {3, 2}, samples);
    ASSERT_TRUE(spline);
    const auto a = load_forces<2>(s, scaling, *spline);
    const auto b = load_forces<2>(s, scaling, LoadFunction<2>([&](const auto&) { return f; }), 16);
    ASSERT_TRUE(a && b);
    EXPECT_LE(largest(*a - expected), (s.rational() ? 1e-10 : 1e-14) * largest(expected));
    // The function is asked at parameters, which are rounded: much on a short span far from zero.
    double moved = 0;
    for (const int span : s.knots(0).spans()) {
      moved = std::max(
          moved, 1e-16 * std::abs(s.knots(0)[span]) / (s.knots(0)[span + 1] - s.knots(0)[span]));
    }
    EXPECT_LE(largest(*b - expected),
              ((s.rational() ? 1e-12 : 1e-14) + 10 * moved) * largest(expected));
  }
}

TEST(Load, ThatIsASplineIsIntegratedExactly) {
  // f = u² + 3uv in one component, on knots that have nothing to do with those of the surface.
  const Surface s = testing::relief(testing::clamped_knots(3, {0, 1, 1.5, 4}, {0, 1, 4, 0}),
                                    testing::uniform_clamped(2, 3), 3);
  const KnotVector u = testing::clamped_knots(2, {0, 0.3, 2.2, 4}),
                   v = testing::clamped_knots(1, {0, 1.7, 3});
  Points c = Points::Zero(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j)
      c(i * v.count() + j, 1) = u[i + 1] * u[i + 2] + 3 * u.greville(i) * v.greville(j);
  }
  const auto exact = load_forces<2>(s, scaling, testing::make_surface(u, v, c));
  const auto gauss = load_forces<2>(s, scaling, LoadFunction<2>([](const auto& at) {
                                      return Point(0, at[0] * at[0] + 3 * at[0] * at[1], 0);
                                    }));
  ASSERT_TRUE(exact && gauss);
  EXPECT_LE(largest(*exact - *gauss), 1e-14 * largest(*exact));
  // The sum of all forces is ∫ f dû: 0.7 · 2.5 · (64/3 · 3 + 3 · 8 · 4.5).
  EXPECT_NEAR(exact->col(1).sum(), 0.7 * 2.5 * (64 + 108), 1e-11);
}

TEST(Load, WithWeightsIsTheSameAsWithoutWhereTheyAreEqual) {
  const Surface s =
      testing::relief(testing::clamped_knots(3, {0, 1, 1.5, 4}), testing::uniform_clamped(2, 3), 3);
  const Surface weighted =
      testing::make_surface(s.knots(0), s.knots(1), s.control_points(),
                            std::vector<double>(static_cast<std::size_t>(s.size()), 0.5));
  const auto load = sampled_load<2>(s, {5, 7}, testing::random_points(35, 3));
  const Points a = *load_forces<2>(s, scaling, *load),
               b = *load_forces<2>(weighted, scaling, *load);
  EXPECT_LE(largest(a - b), 1e-13 * largest(a));
}

TEST(Load, OnCurvesAndVolumes) {
  const Curve c = *Curve::create({testing::uniform_clamped(3, 4)}, testing::random_points(7, 1));
  const auto line = load_forces<1>(
      c, {1, {0.5}}, *sampled_load<1>(c, {2}, (Points(2, 3) << 0, 0, 0, 4, 0, 0).finished()));
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->col(0).sum(), 0.5 * 8, 1e-14);  // ∫ u du over [0, 4]
  const KnotVector k = testing::uniform_clamped(2, 2);
  const Volume v = *Volume::create({k, k, k}, testing::random_points(64, 1));
  const auto f = LoadFunction<3>([](const auto& u) { return Point(u[0] * u[1] * u[2], 0, 1); });
  const auto volume = load_forces<3>(v, {1, {1, 2, 3}}, f);
  ASSERT_TRUE(volume);
  EXPECT_NEAR(volume->col(0).sum(), 6 * 8, 1e-12);
  EXPECT_NEAR(volume->col(2).sum(), 6 * 8, 1e-12);
}

TEST(Load, RefusesWhatHasNoSense) {
  const Surface s = testing::uniform_sheet(3, 6, 6);
  EXPECT_EQ(
      load_forces<2>(s, scaling,
                     testing::sheet(testing::uniform_clamped(1, 2), testing::uniform_clamped(1, 2)))
          .error()
          .kind,
      ErrorKind::input);
  EXPECT_FALSE(sampled_load<2>(s, {1, 3}, testing::random_points(3, 1)));
  EXPECT_FALSE(sampled_load<2>(s, {3, 3}, testing::random_points(8, 1)));
  const auto infinite = load_forces<2>(
      s, scaling, LoadFunction<2>([](const auto& u) { return Point(1 / (u[0] - u[0]), 0, 0); }));
  ASSERT_FALSE(infinite);
  EXPECT_EQ(infinite.error().kind, ErrorKind::input);
}

TEST(AreaLoad, AddsUpToTheLoadTimesTheArea) {
  const Point f(0.3, -2, 1);
  for (const auto& [s, area] : {std::pair(testing::cylinder(3), 6 * std::numbers::pi),
                                std::pair(testing::sphere(), 4 * std::numbers::pi)}) {
    const auto load = sampled_load<2>(s, {3, 2}, f.transpose().replicate(6, 1));
    ASSERT_TRUE(load);
    const auto forces = area_load_forces(s, *load);
    ASSERT_TRUE(forces) << forces.error().message();
    EXPECT_LT((forces->colwise().sum().transpose() - area * f).norm(), 1e-10 * area * f.norm());
  }
}

TEST(AreaLoad, OnAFlatSheetIsTheLoadOfTheParametersTimesItsArea) {
  const Surface s = testing::uniform_sheet(3, 7, 5, 1.3, 0.9);
  Points samples(12, 3);
  for (Eigen::Index k = 0; k < samples.size(); ++k)
    samples.data()[k] = std::sin(3.0 * static_cast<double>(k));
  const auto load = sampled_load<2>(s, {4, 3}, samples);  // kinks within the spans of the sheet
  ASSERT_TRUE(load);
  const auto area = area_load_forces(s, *load), parameters = load_forces<2>(s, {}, *load);
  ASSERT_TRUE(area && parameters);
  EXPECT_LE(largest(*area - 1.3 * 0.9 * *parameters), 1e-14 * largest(*area));
}

TEST(AreaLoad, OnAReliefIsThatOfManyGaussPoints) {
  for (const double spread : {1.0, 2.0}) {
    const Surface s = testing::relief(testing::uniform_clamped(2, 2),
                                      testing::uniform_clamped(3, 2), 5, 0.4, spread);
    const auto load =
        sampled_load<2>(s, {2, 2}, (Points(4, 3) << 1, 0, 0, 0, 2, 0, 0, 0, 3, 1, 1, 1).finished());
    ASSERT_TRUE(load);
    const auto exact = load_forces<2>(
        s, {}, LoadFunction<2>([&](const std::array<double, 2>& u) -> Point {
          const Parameters<2> at = Parameters<2>{{u[0], u[1]}};
          const auto e = *evaluate<2>(s, at, 1);
          const Eigen::Vector3d a = e.at({1, 0}).row(0), b = e.at({0, 1}).row(0);
          return a.cross(b).norm() * Point(evaluate<2>(*load, at)->points().row(0).transpose());
        }),
        40);
    const auto forces = area_load_forces(s, *load);
    ASSERT_TRUE(exact && forces);
    EXPECT_LE(largest(*forces - *exact), 1e-10 * largest(*exact));
  }
}

TEST(AreaLoad, NamesDomainsThatDiffer) {
  const Surface s = testing::uniform_sheet(3, 7, 5);
  const Surface other =
      testing::sheet(testing::clamped_knots(2, {0, 2}), testing::clamped_knots(2, {0, 1}));
  EXPECT_EQ(area_load_forces(s, other).error().where, "load: direction u");
}

}  // namespace
}  // namespace knead
