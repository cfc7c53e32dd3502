#include "contact/greville_force.hpp"

#include <gtest/gtest.h>

#include "knead/energy/loads.hpp"
#include "knead/tool/tool.hpp"
#include "spline/interpolation/greville_interpolation.hpp"
#include "support/numbers.hpp"
#include "support/surfaces.hpp"
#include "support/tools.hpp"

namespace knead {
namespace {

constexpr DomainScaling<2> scaling = {1.0, {0.7, 2.5}};

using testing::largest;

template <int D>
GrevilleForce<D> route(const Spline<D>& s, const DomainScaling<D>& units, int points = 0) {
  auto made = GrevilleForce<D>::create(
      s, units, {.method = GramianMethod::gauss, .rational_gauss_points = points});
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// The Gauss route for a force that depends on the place.
template <int D, class F>
Points by_gauss(const Spline<D>& s, const DomainScaling<D>& units, const F& force, int points) {
  return *load_forces<D>(s, units, LoadFunction<D>([&](const std::array<double, D>& u) {
                           return Point(force(*evaluate_point<D>(s, u)));
                         }),
                         points);
}

std::vector<Surface> surfaces() {
  std::vector<Surface> result;
  for (const int p : {1, 2, 3, 5}) {
    for (const auto& family : testing::knot_families(p)) {
      if (!family.ordinary() || family.knots.count() > 30) continue;
      result.push_back(
          testing::relief(family.knots, testing::clamped_knots(2, {0, 1, 3}, {3, 3, 3}), 3));
    }
  }
  result.push_back(
      testing::relief(testing::uniform_unclamped(2, 3), testing::uniform_clamped(3, 2), 5, 0.1, 3));
  result.push_back(testing::cylinder());
  result.push_back(testing::sphere());
  return result;
}

TEST(GrevilleForce, OfAnAffineForceIsItsMassMatrixTimesTheForcesAtTheControlPoints) {
  // f(S) = A S + b is in the space of the surface with coefficients A P + b: the route is exact for
  // it.
  Eigen::Matrix3d a;
  a << 1, 2, 0, -1, 0.5, 0, 0.25, 0, -2;
  const Point b(0.5, -1, 3);
  for (const Surface& s : surfaces()) {
    const auto greville = route<2>(s, scaling);
    const Points got = greville.greville_force(s.control_points(),
                                               [&](const Point& x) -> Point { return a * x + b; });
    Points coefficients = s.control_points() * a.transpose();
    coefficients.rowwise() += b.transpose();
    // Functions that vanish on the domain have no part in either.
    const auto mass =
        Stiffness<2>::create(s, on_scaled_domain<2>(mass_energy<2>(), scaling.factors));
    const Points expected = mass->apply(coefficients);
    // Rounding times the condition of interpolation, largest where functions are small on the
    // domain (unclamped ends).
    EXPECT_LE(largest(got - expected), (s.knots(0).clamped() ? 1e-12 : 1e-9) * largest(expected));
  }
}

TEST(GrevilleForce, LooksAtPointsOfTheSurface) {
  for (const Surface& s : surfaces()) {
    const auto greville = route<2>(s, scaling);
    const Points places = greville.places(s.control_points());
    const int n = s.net()[1];
    for (int i = 0; i < s.net()[0]; ++i) {
      for (int j = 0; j < n; ++j) {
        const double u = greville.abscissae(0)[static_cast<std::size_t>(i)],
                     v = greville.abscissae(1)[static_cast<std::size_t>(j)];
        Parameters<2> at(1, 2);
        at << u, v;
        double nearest = 1e300;  // from one of the sides
        for (const Side side : {Side::left, Side::right}) {
          // Both sides of each direction apart: shift by the smallest step instead of asking for a
          // mixed side.
          for (const double du : {-1.0, 0.0}) {
            for (const double dv : {-1.0, 0.0}) {
              Parameters<2> moved = at;
              if (du < 0)
                moved(0, 0) = std::max(s.knots(0).domain().lower, std::nextafter(u, -1e300));
              if (dv < 0)
                moved(0, 1) = std::max(s.knots(1).domain().lower, std::nextafter(v, -1e300));
              const Point x = evaluate<2>(s, moved, 0, side)->points().row(0).transpose();
              nearest = std::min(nearest, (x - Point(places.row(i * n + j).transpose())).norm());
            }
          }
        }
        EXPECT_LE(nearest, 1e-9);
      }
    }
  }
}

/// Orders observed when spans are halved, of the largest difference per ∫ R_i to the Gauss route.
template <class Make, class F>
std::vector<double> differences(const Make& make, const F& force, std::initializer_list<int> spans,
                                int points) {
  std::vector<double> result;
  for (const int n : spans) {
    const Surface s = make(n);
    const Points a = route<2>(s, scaling, points).greville_force(s.control_points(), force);
    const Points b = by_gauss<2>(s, scaling, force, points);
    const Points area = by_gauss<2>(
        s, scaling, [](const Point&) { return Point(1, 1, 1); }, points);
    result.push_back(((a - b).array() / area.array()).abs().maxCoeff());
  }
  return result;
}

const auto smooth = [](const Point& x) -> Point {
  return {std::sin(3 * x[0] + x[1]), std::exp(x[0] * x[1]), 1 / (1.5 + x[0] + x[1] * x[1])};
};

TEST(GrevilleForce, ConvergesToTheGaussRouteWithTheOrderOfTheSpace) {
  for (const int p : {1, 2, 3, 4}) {
    const auto sheet = [&](int n) {
      return testing::sheet(*KnotVector::clamped_uniform(p, n + p),
                            *KnotVector::clamped_uniform(p, n + p));
    };
    const std::vector<double> e = differences(sheet, smooth, {8, 16, 32}, p + 6);
    for (std::size_t k = 0; k + 1 < e.size(); ++k) {
      RecordProperty("p" + std::to_string(p) + "_" + std::to_string(k), std::to_string(e[k]));
      // Order p + 1, less what the first steps have not settled yet.
      EXPECT_GE(std::log2(e[k] / e[k + 1]), p + 1 - 0.35) << p << ": " << e[k] << " " << e[k + 1];
    }
  }
}

/// A quarter cylinder with n spans round and n along: the exact rational one, its knots inserted by
/// interpolation of the homogeneous coordinates, which the finer space holds.
Surface quarter_cylinder(int n) {
  const KnotVector coarse = testing::uniform_clamped(2, 1);
  const KnotVector u = *KnotVector::clamped_uniform(2, n + 2),
                   v = *KnotVector::clamped_uniform(2, n + 2);
  const double r = std::sqrt(0.5), xyw[3][3] = {{1, 0, 1}, {1, 1, r}, {0, 1, 1}};
  const auto line = *GrevilleInterpolation::create(u);
  std::vector<double> h(static_cast<std::size_t>(3 * u.count()));
  const BasisTable table = line.tabulate(coarse);
  for (int i = 0; i < u.count(); ++i) {
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) {
        h[static_cast<std::size_t>(3 * i + c)] +=
            table.row(i, 0)[k] * xyw[k][c] * (c < 2 ? xyw[k][2] : 1);
      }
    }
  }
  line.solve(h.data(), 1, 3);
  Points points(u.count() * v.count(), 3);
  std::vector<double> weights;
  for (int i = 0; i < u.count(); ++i) {
    const double* at = &h[static_cast<std::size_t>(3 * i)];
    for (int j = 0; j < v.count(); ++j) {
      points.row(i * v.count() + j) << at[0] / at[2], at[1] / at[2], v.greville(j);
      weights.push_back(at[2]);
    }
  }
  return testing::make_surface(u, v, points, weights);
}

TEST(GrevilleForce, ConvergesOnRationalSurfacesToo) {
  const Surface s = quarter_cylinder(4);
  EXPECT_NEAR(evaluate_point<2>(s, {0.3, 0.4})->head<2>().norm(), 1, 1e-14);
  const std::vector<double> e = differences(quarter_cylinder, smooth, {8, 16, 32}, 14);
  for (std::size_t k = 0; k + 1 < e.size(); ++k)
    EXPECT_GE(std::log2(e[k] / e[k + 1]), 3 - 0.35) << e[k] << " " << e[k + 1];
}

TEST(GrevilleForce, KeepsConstantForcesWhateverTheWeights) {
  for (const double spread : {2.0, 10.0, 1e6}) {
    const Surface s = testing::relief(testing::uniform_clamped(3, 3),
                                      testing::uniform_clamped(2, 2), 5, 0.1, spread);
    const auto greville = route<2>(s, scaling);
    const Point f(1, -2, 0.5);
    const Points got = greville.greville_force(s.control_points(), [&](const Point&) { return f; });
    const auto mass =
        Stiffness<2>::create(s, on_scaled_domain<2>(mass_energy<2>(), scaling.factors));
    const Points expected = mass->apply(f.transpose().replicate(s.size(), 1));
    // What a small weight takes from a coefficient's digits it takes from its force too: rounding
    // is all that stays.
    EXPECT_LE(largest(got - expected), 1e-14 * largest(expected)) << spread;
  }
}

TEST(GrevilleForce, OfACollisionHasTheGaussForceAsItsLimitWithLowOrder) {
  // The force has a kink at the edge of the contact: the bound is O(h), measured.
  const ModelTool tool(
      {"ball", testing::sphere_at(Point(0.5, 0.5, 0.25), 0.3), ToolMode::collision, 1, 1},
      Point::Zero(), 1);
  const auto force = [&](const Point& x) -> Point { return tool.action(x).force; };
  const auto sheet = [&](int n) {
    return testing::sheet(*KnotVector::clamped_uniform(3, n + 3),
                          *KnotVector::clamped_uniform(3, n + 3));
  };
  const std::vector<double> e = differences(sheet, force, {16, 32, 64}, 12);
  EXPECT_LE(e[2], e[0] / 2);
  EXPECT_LE(e[2], 0.3 / 64);
}

TEST(GrevilleForce, OnCurvesAndVolumes) {
  std::vector<double> error;
  for (const int n : {12, 24, 48}) {  // a line over [0, 1] on unclamped knots, F per ∫ R_i
    const KnotVector u = testing::uniform_unclamped(3, n);
    Points line(u.count(), 3);
    for (int i = 0; i < u.count(); ++i)
      line.row(i) << (u.greville(i) - 3) / n, (u.greville(i) - 3) / (2 * n), 0;
    const Curve c = *Curve::create({u}, line);
    const DomainScaling<1> unit{1, {1.0 / n}};
    const Points difference =
        route<1>(c, unit).greville_force(line, smooth) - by_gauss<1>(c, unit, smooth, 10);
    const Points length = by_gauss<1>(
        c, unit, [](const Point&) { return Point(1, 1, 1); }, 4);
    error.push_back((difference.array() / length.array()).abs().maxCoeff());
  }
  EXPECT_GE(std::log2(error[1] / error[2]), 4 - 0.35)
      << error[0] << " " << error[1] << " " << error[2];
  const KnotVector k = *KnotVector::clamped_uniform(3, 9);
  Points x(729, 3);
  for (int i = 0; i < 729; ++i)
    x.row(i) << k.greville(i / 81), k.greville(i / 9 % 9), k.greville(i % 9);
  const Volume v = *Volume::create({k, k, k}, x);
  const Points d = route<3>(v, {}).greville_force(x, smooth), e = by_gauss<3>(v, {}, smooth, 7);
  // (h/2)⁴/4! times the fourth derivatives, up to 3⁴, with h = 1/6, and as much again from the
  // other directions.
  EXPECT_LE(largest(d - e), 3e-4 * largest(e));
}

TEST(GrevilleForce, RefusesWeightsThatNoForceDetermines) {
  Surface s = testing::relief(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 2), 5);
  std::vector<double> weights(static_cast<std::size_t>(s.size()), 1.0);
  weights[7] = 0;
  const auto made = GrevilleForce<2>::create(
      testing::make_surface(s.knots(0), s.knots(1), s.control_points(), weights), scaling);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().where, "control point 7");
}

}  // namespace
}  // namespace knead
