// What each kind of brush does, by a measure of its own.
#include <gtest/gtest.h>

#include <numbers>

#include "brushes.hpp"
#include "knead/spline/curvature.hpp"

namespace knead::testing {
namespace {

// The radius is 20 in all of these.
TEST(Brush, PushAndPullAreAsDeepAsSaidAlongTheirWholePath) {
  const Point from(50, 97, 0), to(150, 97, 0);
  for (const auto& [kind, sign] : {std::pair{"push", -1}, {"pull", 1}}) {
    Session session = flat(64);
    run(session, {brush(fmt::format(R"("kind":"{}","radius":20,"height":4)", kind), from, to)});
    const Surface& s = shape(session);
    for (int k = 0; k <= 40; ++k) EXPECT_NEAR(on(s, 50 + 2.5 * k, 97).z(), sign * 4, 0.01 * 4);
    EXPECT_NEAR(on(s, 100, 107).z(), sign * 2, 0.02 * 4) << "half at half the radius";
    EXPECT_EQ(on(s, 100, 97 + 20 + 2 * 3.3).z(), 0) << "nothing two spans beyond the radius";
    EXPECT_EQ(on(s, 20, 97).z(), 0);
    EXPECT_TRUE(same_bits(*first(session).rest, s));
    run(session, {R"({"do":"undo"})"});
    EXPECT_TRUE(same_bits(shape(session), *first(session).opened));
  }
}

TEST(Brush, InflatesAlongNormals) {
  for (const double height : {3., -3.}) {
    Session session = fresh();
    run(session,
        {R"({"do":"new","shape":"sphere","radius":100})",
         R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"refine","region":[[0,1],[0,1]]})",
         R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"refine","region":[[0,1],[0,1]]})"});
    const Surface before = shape(session);
    run(session,
        {fmt::format(
            R"({{"do":"brush","kind":"inflate","radius":60,"height":{},"path":[[0.3,0.5]]}})",
            height)});
    const Point centre = at(before, 0.3, 0.5);
    double largest = 0;
    for (int i = -6; i <= 6; ++i) {
      for (int j = -6; j <= 6; ++j) {
        const Point x = at(before, 0.3 + 0.01 * i, 0.5 + 0.02 * j);
        const Point d = at(shape(session), 0.3 + 0.01 * i, 0.5 + 0.02 * j) - x;
        if ((x - centre).norm() > 40) continue;
        const Point n = x.normalized() * (height > 0 ? 1 : -1);
        EXPECT_LT(std::acos(std::min(1., d.normalized().dot(n))), 0.02) << "radians off the normal";
        largest = std::max(largest, d.norm());
      }
    }
    EXPECT_NEAR(largest, std::abs(height), 0.01 * std::abs(height));
  }
}

TEST(Brush, FlattensToAPlane) {
  const Point middle(100, 100, 0);
  const std::vector<std::string> bumps = {
      dab(R"("kind":"pull","radius":45,"height":8)", {90, 104, 0}),
      dab(R"("kind":"push","radius":15,"height":2)", {104, 98, 0})};
  Session session = flat(64, bumps);
  const auto rms = [&] {  // of the distances from the plane that fits best
    std::vector<Point> points;
    for (int i = -8; i <= 8; ++i) {
      for (int j = -8; j <= 8; ++j) {
        if (i * i + j * j <= 64) points.push_back(on(shape(session), 100 + i, 100 + j));
      }
    }
    Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 3);
    Eigen::VectorXd z(a.rows());
    for (Eigen::Index k = 0; k < a.rows(); ++k) {
      const Point& p = points[static_cast<std::size_t>(k)];
      a.row(k) << 1, p.x(), p.y();
      z[k] = p.z();
    }
    const Eigen::VectorXd fit = (a.transpose() * a).ldlt().solve(a.transpose() * z);
    return (a * fit - z).norm() / std::sqrt(static_cast<double>(points.size()));
  };
  const double before = rms();
  EXPECT_GT(before, 0.1);
  run(session, {dab(R"("kind":"flatten","radius":30,"core":0.5)", middle)});
  EXPECT_LT(rms(), 1e-3 * before);
}

// Strokes over all of a bump, also askew, and with a radius of one and a half spans of the net.
TEST(Brush, FlattenLowersWhatStandsOut) {
  const auto highest = [](const Session& session) {
    double z = 0;
    for (int i = 0; i <= 150; ++i)
      for (int j = 0; j <= 150; ++j) z = std::max(z, at(shape(session), i / 150., j / 150.).z());
    return z;
  };
  struct Case {
    double radius, askew, least;  // `least`: what four strokes take away, of the height
  };
  for (const auto& [radius, askew, least] : {Case{10, 0, 0.2},
                                             {10, 8, 0.03},
                                             {14, 0, 0.2},
                                             {20, 0, 0.4},
                                             {20, 8, 0.2},
                                             {28, 0, 0.5},
                                             {28, 8, 0.5}}) {
    Session session =
        flat(32, {brush(R"("kind":"pull","radius":20,"height":5)", {60, 100, 0}, {140, 100, 0})});
    const double bump = highest(session);
    double before = bump;
    for (int k = 0; k < 4; ++k) {
      run(session, {brush(fmt::format(R"("kind":"flatten","radius":{},"strength":0.5)", radius),
                          {60, 100 - askew, 0}, {140, 100 + askew, 0}, 24)});
      EXPECT_LT(highest(session), before) << radius << " " << askew;
      before = highest(session);
    }
    EXPECT_LT(before, (1 - least) * bump) << radius << " " << askew;
  }
}

TEST(Brush, SmoothsWithoutMovingEdges) {
  std::vector<std::string> bumps;
  for (int k = 0; k < 12; ++k) {
    bumps.push_back(
        dab(fmt::format(R"("kind":"{}","radius":14,"height":1.5)", k % 2 == 0 ? "pull" : "push"),
            {30 + 12. * k, 90 + 9. * (k % 3), 0}));
  }
  Session session = flat(64, bumps);
  const Surface before = shape(session);
  const auto fairness = [](const Surface& s) {  // ∫ |second derivatives|²
    double sum = 0;
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; j <= 100; ++j) {
        Parameters<2> here(1, 2);
        here << s.knots(0).domain().upper * i / 100, s.knots(1).domain().upper * j / 100;
        const auto jet = *evaluate<2>(s, here, 2);
        sum += jet.at({2, 0}).squaredNorm() + 2 * jet.at({1, 1}).squaredNorm() +
               jet.at({0, 2}).squaredNorm();
      }
    }
    return sum;
  };
  run(session, {brush(R"("kind":"smooth","radius":30)", {10, 99, 0}, {190, 99, 0})});
  const Surface once = shape(session);
  EXPECT_LT(fairness(once), 0.35 * fairness(before));
  run(session, {brush(R"("kind":"smooth","radius":30)", {10, 99, 0}, {190, 99, 0})});
  EXPECT_LT(fairness(shape(session)), 0.8 * fairness(once));
  const auto [m, n] = before.net();
  for (int i = 0; i < m; ++i) {
    for (int k : {i * n, i * n + n - 1, i, (m - 1) * n + i}) {
      EXPECT_EQ(shape(session).control_points().row(k), before.control_points().row(k))
          << "an edge is held";
    }
  }
}

TEST(Brush, GrabTakesAPointAlong) {
  for (const auto& [net, x] : {std::pair{64, 101.3}, {24, 87.1}}) {
    Session session = flat(net);
    run(session, {dab(R"("kind":"grab","radius":30,"by":[3,-2,9])", {x, 103, 0})});
    const Point moved = on(shape(session), x, 103) - Point(x, 103, 0);
    EXPECT_LT((moved - Point(3, -2, 9)).norm(), 1e-9);
    const double span = side / (net - 3);
    for (int k = 0; k < 36; ++k) {
      const Point way = (30 + 2.83 * span) * Point(std::cos(k), std::sin(k), 0);
      EXPECT_LT((on(shape(session), x + way.x(), 103 + way.y()) - Point(x, 103, 0) - way).norm(),
                1e-12 * side);
    }
    // Control points beyond the radius keep their bits.
    const Points &now = shape(session).control_points(),
                 &was = first(session).opened->control_points();
    for (Eigen::Index i = 0; i < now.rows(); ++i) {
      const int m = net;
      const Point g(side * shape(session).knots(0).greville(static_cast<int>(i) / m),
                    side * shape(session).knots(1).greville(static_cast<int>(i) % m), 0);
      if ((g - Point(x, 103, 0)).norm() < 30) continue;
      EXPECT_EQ(now.row(i), was.row(i));
    }
  }
}

TEST(Brush, PinchesTowardsThePath) {
  const Point from(60, 97, 0), to(140, 97, 0);
  Session session = flat(64);
  run(session, {brush(R"("kind":"pinch","radius":20,"strength":0.6)", from, to)});
  for (const double off : {2., 5., 9., 14.}) {
    for (const double sign : {-1., 1.}) {
      const Point p = on(shape(session), 100, 97 + sign * off);
      EXPECT_LT(std::abs(p.y() - 97), 0.99 * off);
      EXPECT_GT(sign * (p.y() - 97), 0) << "none passes over the path";
      EXPECT_NEAR(p.x(), 100, 1e-3);
      EXPECT_LT(std::abs(p.z()), 1e-9) << "within the surface";
    }
  }
  EXPECT_NEAR(on(shape(session), 100, 102).y() - 97, 5 * (1 - 0.6 * brush_falloff(5, 20, 0)),
              0.02 * 5);
}

// κ of the crest: the kink of slope 4 h / R is as sharp as spans of this length show it.
TEST(Brush, CreasesAreAsSharpAsTheNetAllows) {
  const Point from(50, 100, 0), to(150, 100, 0);
  for (const auto& [kind, sign] : {std::pair{"crease", -1}, {"ridge", 1}}) {
    for (const int net : {43, 83, 123}) {
      Session session = flat(net);
      run(session, {brush(fmt::format(R"("kind":"{}","radius":24,"height":6)", kind), from, to)});
      const double span = side / (net - 3);
      const auto bent = *curvature(shape(session), {shape(session).knots(0).domain().upper / 2,
                                                    shape(session).knots(1).domain().upper / 2});
      const double radius = 1 / std::max(std::abs(bent.principal[0]), std::abs(bent.principal[1]));
      EXPECT_LT(radius, 1.5 * span) << kind << " with spans of " << span;
      EXPECT_NEAR(on(shape(session), 100, 100).z(), sign * 6, 0.15 * 6);
    }
    Session session = flat(43, {R"({"do":"refine","permission":"auto"})"});
    run(session, {brush(fmt::format(R"("kind":"{}","radius":24,"height":6)", kind), from, to)});
    const KnotVector& across = shape(session).knots(1);
    for (int k : across.spans()) {
      if (std::abs(side * across[k] - 100) > 12) continue;
      EXPECT_LE(side * (across[k + 1] - across[k]), 24. / 16) << "the net under it is refined";
    }
    EXPECT_LE(shape(session).size(), 25000);
    EXPECT_EQ(shape(session).net(), first(session).opened->net());
  }
}

TEST(Brush, TwistsAndScalesAboutAPoint) {
  const Point middle(100, 100, 0);
  Session session = flat(64);
  run(session, {dab(R"("kind":"twist","radius":40,"angle":30,"core":0.25)", middle)});
  const double angle = std::numbers::pi / 6;
  for (int k = 0; k < 12; ++k) {
    const Point off = 4 * Point(std::cos(k), std::sin(k), 0);
    const Point turned(std::cos(angle) * off.x() - std::sin(angle) * off.y(),
                       std::sin(angle) * off.x() + std::cos(angle) * off.y(), 0);
    EXPECT_LT((on(shape(session), 100 + off.x(), 100 + off.y()) - middle - turned).norm(),
              1e-3 * 4);
  }
  run(session,
      {R"({"do":"undo"})", dab(R"("kind":"scale","radius":40,"factor":1.5,"core":0.25)", middle)});
  for (int k = 0; k < 12; ++k) {
    const Point off = 4 * Point(std::cos(k), std::sin(k), 0);
    EXPECT_LT((on(shape(session), 100 + off.x(), 100 + off.y()) - middle - 1.5 * off).norm(),
              1e-3 * 4);
  }
}

}  // namespace
}  // namespace knead::testing
