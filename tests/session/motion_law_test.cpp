// How far what presses, strokes, brushes and drags move goes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/exchange/format.hpp"
#include "support.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::run;

/// As it comes from a file, its edges held.
Session opened(const Surface& surface) {
  const std::vector<NamedSurface> named = {{"", surface}};
  auto source =
      open_source(*save_surfaces(named, *find_format("step"), {.unit = "mm"}), "made.step");
  Session session(Document::from(*source));
  run(session,
      {R"({"do":"hold","mode":"position","all":true})",
       fmt::format(R"({{"do":"select","surface":"{}"}})", session.state().surfaces[0].id)});
  return session;
}

bool noted(const Session& session, std::string_view begins) {
  return std::ranges::any_of(session.state().notes,
                             [&](const std::string& n) { return n.starts_with(begins); });
}

double furthest(const Session& session) { return session.largest_displacement(0); }

std::vector<std::string> pressed_sheet(double radius, double depth) {
  return {R"({"do":"new","size":[200,200],"net":[20,20]})", R"({"do":"hold","rows":2})",
          R"({"do":"material","preset":"clay"})",
          fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":[100,100,{}]}})", radius,
                      2 * radius),
          fmt::format(R"({{"do":"stroke","tool":"b","path":[[100,100,{}]]}})", radius - depth)};
}

TEST(MotionLaw, ABallLargerThanTheSheetGoesAsDeepAsAsked) {
  for (const auto& [radius, depth] : {std::pair{20., 8.}, {200., 100.}, {500., 250.}}) {
    Session session = fresh();
    run(session, pressed_sheet(radius, depth));
    EXPECT_GE(furthest(session), 0.9 * depth) << radius;
    EXPECT_LE(furthest(session), 1.05 * depth) << radius;
  }
}

TEST(MotionLaw, StepsUnderABallLargerThanTheSheetGoAsDeepAsAsked) {
  for (const auto& [radius, depth] : {std::pair{200., 100.}, {500., 250.}}) {
    Session session = fresh();
    run(session, {R"({"do":"new","size":[200,200],"net":[20,20]})", R"({"do":"hold","rows":2})",
                  fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":[100,100,{}]}})",
                              radius, radius - depth),
                  R"({"do":"step","count":10})"});
    EXPECT_GE(furthest(session), 0.9 * depth) << radius;
    EXPECT_LE(furthest(session), 1.05 * depth) << radius;
  }
}

// Its points have ways of up to 2.7 along their normals out of the ball, but all of it leaves the
// ball by 2.1.
TEST(MotionLaw, AClosedSphereInsideALargerBallGoesNoFurtherThanOutOfIt) {
  for (const auto& [radius, away, count] : {std::tuple{3.25, 2.15, 4}, {4.4, 3.25, 5}}) {
    const double depth = radius - (away - 1);
    Session session = opened(testing::sphere());
    run(session, {fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":[{},{},{}]}})",
                              radius, 0.9 * away, -0.28 * away, 0.33 * away),
                  fmt::format(R"({{"do":"step","count":{}}})", count)});
    EXPECT_LE(furthest(session), 1.06 * depth) << radius;
    EXPECT_GE(furthest(session), 0.8 * depth) << radius;
  }
}

// Measured along normals of waves a ball stands deeper in a sheet than it is.
TEST(MotionLaw, AStrokeOnAWavySheetGoesAsDeepAsTheBallWent) {
  const KnotVector u = *KnotVector::clamped_uniform(2, 6), v = *KnotVector::clamped_uniform(4, 14);
  const auto fraction = [](const KnotVector& knots, int i) {
    return knots.greville(i) / knots.domain().upper;
  };
  constexpr double turns = 1.4 * std::numbers::pi;
  Points points(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double s = fraction(u, i), t = fraction(v, j);
      points.row(i * v.count() + j) << 100 * s, 100 * t,
          8 * std::sin(turns * s) * std::cos(turns * t);
    }
  }
  const Surface shape = testing::make_surface(u, v, points);
  Session session = opened(shape);
  run(session, {R"({"do":"material","preset":"clay"})",
                R"({"do":"tool","name":"b","radius":227,"position":[55,45,-2000]})",
                R"({"do":"stroke","tool":"b","path":[[55,8,-214]]})"});
  double depth = 0;
  for (int i = 0; i <= 200; ++i) {
    for (int j = 0; j <= 200; ++j) {
      const Point x =
          *evaluate_point<2>(shape, {u.domain().upper * i / 200, v.domain().upper * j / 200});
      depth = std::max(depth, 227 - (x - Point(55, 8, -214)).norm());
    }
  }
  EXPECT_LE(furthest(session), 1.06 * depth);
  EXPECT_GE(furthest(session), 0.9 * depth);
}

TEST(MotionLaw, AStrokeThatMovesFreeSidesFurtherSaysHowFar) {
  Session session = opened(testing::uniform_sheet(3, 12, 12, 100, 100));
  run(session,
      {R"({"do":"material","preset":"clay"})", R"({"do":"edge","which":"u0","hold":"open"})",
       R"({"do":"tool","name":"b","radius":247,"position":[55,45,2000]})",
       R"({"do":"stroke","tool":"b","path":[[55,45,240]]})"});
  EXPECT_GT(furthest(session), 1.06 * 7);
  EXPECT_TRUE(noted(session, "free sides move") || noted(session, "made smaller"));
}

// Products of B-splines of such degrees have a condition beyond the digits of a number.
TEST(MotionLaw, APatchOfDegree25And22IsPressed) {
  const auto knots = [](int p) { return *KnotVector::clamped_uniform(p, p + 1); };
  Session session = opened(testing::sheet(knots(25), knots(22), 100, 100));
  run(session, {R"({"do":"refine","permission":"never"})",
                R"({"do":"tool","name":"b","radius":60,"position":[50,50,55]})",
                R"({"do":"step","count":2})"});
  EXPECT_LE(furthest(session), 1.06 * 5);
  EXPECT_GE(furthest(session), 0.9 * 5);
}

// Between the first site and the held edge the spline of a brush of high degree alternates.
TEST(MotionLaw, ABrushOnASheetOfDegree25IsNoLargerThanAsked) {
  Session session = opened(testing::sheet(*KnotVector::clamped_uniform(4, 20),
                                          *KnotVector::clamped_uniform(25, 48), 100, 100));
  run(session, {R"({"do":"brush","kind":"push","radius":5,"height":0.5,"path":[[0.32,0.46]]})"});
  EXPECT_FALSE(noted(session, "made smaller"));
  EXPECT_LE(furthest(session), 1.06 * 0.5);
  EXPECT_GE(furthest(session), 0.5 * 0.5);
}

TEST(MotionLaw, StepsThatWouldFoldAFaceAreMadeSmaller) {
  Session session = opened(testing::uniform_sheet(3, 12, 12, 100, 100));
  run(session, {R"({"do":"tool","name":"b","radius":20,"position":[9,45,4]})",
                R"({"do":"step","count":3})"});
  EXPECT_GT(furthest(session), 0.1 * 16);
  EXPECT_TRUE(std::ranges::any_of(session.state().steps, [](const StepRecord& s) {
    return s.note.find("more would fold a face") != std::string::npos ||
           s.note.find("it would fold a face") != std::string::npos;
  }));
}

}  // namespace
}  // namespace knead
