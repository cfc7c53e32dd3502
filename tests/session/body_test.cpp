#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "knead/exchange/format.hpp"
#include "knead/session/session_info.hpp"
#include "knead/spline/curvature.hpp"
#include "knead/spline/evaluate.hpp"
#include "support.hpp"
#include "support/numbers.hpp"

namespace knead {
namespace {

using testing::epsilon;
using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

const SceneBody& body(const Session& session, std::size_t k = 0) {
  return session.state().bodies[k];
}
const Curve& curve(const Session& session, std::size_t k = 0) {
  return *std::get<SceneCurve>(body(session, k)).current;
}
const Volume& volume(const Session& session, std::size_t k = 0) {
  return *std::get<SceneVolume>(body(session, k)).current;
}
Point on(const Curve& c, double u) { return *evaluate_point<1>(c, {u}); }
Point on(const Volume& v, double a, double b, double c) { return *evaluate_point<3>(v, {a, b, c}); }

/// The derivative of a curve at u, from one side.
Point tangent(const Curve& c, double u, Side side) {
  Parameters<1> at(1, 1);
  at(0, 0) = u;
  return evaluate<1>(c, at, 1, side)->at({1}).row(0).transpose();
}
double angle(const Point& a, const Point& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(NewBody, ACircleIsExactAndAHelixSaysHowNear) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"curve","form":"circle","radius":2,"position":[1,0,0]})",
       R"({"do":"new","shape":"curve","form":"helix","radius":2,"height":3,"turns":2,"net":40})",
       R"({"do":"new","shape":"curve","size":5,"degree":2,"net":6,"unit":"mm"})"});
  EXPECT_EQ(session.state().body, 2);
  EXPECT_FALSE(session.state().selected);
  for (int k = 0; k <= 20; ++k) {
    const Point x = on(curve(session), k / 20.) - Point(1, 0, 0);
    EXPECT_NEAR(std::hypot(x.x(), x.y()), 2, 16 * epsilon);
    EXPECT_EQ(x.z(), 0);
  }
  double error = 0;
  for (int k = 0; k <= 1000; ++k) {
    const double t = k / 1000., a = 4 * std::numbers::pi * t;
    error = std::max(
        error, (on(curve(session, 1), t) - Point(2 * std::cos(a), 2 * std::sin(a), 3 * t)).norm());
  }
  ASSERT_EQ(session.state().notes.size(), 1U);
  const std::string& note = session.state().notes[0];
  const double said = std::stod(note.substr(note.find("to ") + 3));
  EXPECT_NEAR(error, said, 0.1 * said);
  EXPECT_LT(error, 2e-3);
  EXPECT_EQ(curve(session, 2).size(), 6);
  EXPECT_EQ(on(curve(session, 2), 1), Point(5, 0, 0));
  EXPECT_EQ(common_of(body(session, 1)).id, "#2");
}

TEST(NewBody, VolumesHaveTheirVolume) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"volume","size":[2,3,4],"degree":[2,3,1],"net":[4,5,2]})",
       R"({"do":"new","shape":"volume","form":"cylinder","radius":2,"height":3,"net":[5,4,4]})"});
  EXPECT_EQ(volume(session).net(), (std::array<int, 3>{4, 5, 2}));
  EXPECT_NEAR((on(volume(session), 0.3, 0.6, 0.9) - Point(0.6, 1.8, 3.6)).norm(), 0, 8 * epsilon);
  EXPECT_EQ(volume(session, 1).net(), (std::array<int, 3>{5, 4, 4}));
  for (const auto& [a, b] : {std::pair{0., 0.3}, {1., 0.8}, {0.2, 0.}, {0.7, 1.}}) {
    const Point x = on(volume(session, 1), a, b, 0.4);
    EXPECT_NEAR(std::hypot(x.x(), x.y()), 2, 16 * epsilon);
    EXPECT_NEAR(x.z(), 1.2, 8 * epsilon);
  }
}

TEST(NewBody, RefusesWithThePlace) {
  Session session = fresh();
  for (const auto& [fields, where] : std::vector<std::pair<std::string, std::string>>{
           {R"("shape":"curve","form":"box")", "form"},
           {R"("shape":"volume","form":"line")", "form"},
           {R"("shape":"curve","net":[4,4])", "net"},
           {R"("shape":"curve","net":3)", "net"},
           {R"("shape":"curve","degree":[3,3])", "degree"},
           {R"("shape":"curve","form":"circle","radius":0)", "radius"},
           {R"("shape":"curve","form":"helix","turns":0)", "turns"},
           {R"("shape":"curve","points":[[0,0,0],[1,0,0]])", "points"},
           {R"("shape":"curve","weights":[1,1])", "weights"},
           {R"("shape":"curve","knots_v":[0,0,1,1])", "knots_v"},
           {R"("shape":"volume","net":[2000000000,4,4])", "net"},
           {R"("shape":"volume","net":[4,4])", "net"},
           {R"("shape":"volume","form":"cylinder","net":[2,4,4])", "net"},
           {R"("shape":"volume","form":"cylinder","net":[100000,100000,4])", "net"},
           {R"("shape":"plane","net":[4,4,4])", "net"}}) {
    const Error e = refusal(session, R"({"do":"new",)" + fields + "}");
    EXPECT_EQ(e.where.substr(0, where.size()), where) << fields << ": " << e.message();
    EXPECT_FALSE(e.remedy.empty()) << e.message();
  }
  EXPECT_FALSE(session.can_undo());
}

TEST(ActiveCurve, BendsAsAClampedBeam) {
  Session session = fresh();
  // β w'''' = q with both ends clamped: w = q x² (1 − x)² / (24 β), a polynomial of degree 4.
  run(session, {R"({"do":"new","shape":"curve","degree":4,"net":9})",
                R"({"do":"scaling","mode":"raw"})", R"({"do":"material","alpha":[0],"beta":[2]})",
                R"({"do":"edge","hold":"tangent"})", R"({"do":"load","vector":[0,0,-48]})",
                R"({"do":"evolve","mode":"static"})", R"({"do":"step"})"});
  for (int k = 0; k <= 10; ++k) {
    const double x = k / 10.;
    const Point p = on(curve(session), x);
    EXPECT_NEAR(p.z(), -x * x * (1 - x) * (1 - x), 1e-13);
    EXPECT_NEAR(p.x(), x, 1e-13);
  }
  EXPECT_NEAR(session.state().steps.back().largest_displacement, 1. / 16, 1e-6);
  EXPECT_GT(*session.energy(), 0);
}

TEST(ActiveCurve, KeepsItsEndsAndTheCoordinatesThatAreHeld) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"curve","net":12})", R"({"do":"edge","which":"u0"})",
                R"({"do":"edge","which":"u1","components":"xz"})",
                R"({"do":"pin","at":[0.5],"to":[0.5,0,0.2]})",
                R"({"do":"force","kind":"spring","at":[0.8],"to":[0.8,0.5,0.5],"strength":20})",
                R"({"do":"step","count":20})"});
  const Curve& c = curve(session);
  EXPECT_EQ(on(c, 0), Point(0, 0, 0));
  EXPECT_EQ(on(c, 1).x(), 1);
  EXPECT_EQ(on(c, 1).z(), 0);
  EXPECT_GT(std::abs(on(c, 1).y()), 1e-3);
  EXPECT_NEAR((on(c, 0.5) - Point(0.5, 0, 0.2)).norm(), 0, 1e-12);
  EXPECT_GT(on(c, 0.8).y(), 0.05);
  run(session, {R"({"do":"release"})", R"({"do":"step","count":20})"});
  EXPECT_GT((on(curve(session), 0) - Point(0, 0, 0)).norm(), 1e-3);
}

TEST(ActiveCurve, ACircleUnderABallStaysClosedAndSmooth) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"curve","form":"circle","radius":1})", R"({"do":"refine"})",
       R"({"do":"refine"})", R"({"do":"tool","radius":0.4,"position":[1.2,0.1,0],"rigid":true})",
       R"({"do":"evolve","lambda":20})", R"({"do":"step","count":30})"});
  const Curve& c = curve(session);
  EXPECT_NEAR((on(c, 0) - on(c, 1)).norm(), 0, 1e-14);
  EXPECT_LT(angle(tangent(c, 0, Side::right), tangent(c, 1, Side::left)), 1e-12);
  for (const double u : {0.25, 0.5, 0.75}) {
    EXPECT_LT(angle(tangent(c, u, Side::right), tangent(c, u, Side::left)), 1e-12) << u;
  }
  // Out of the ball, and moved by it where it was deepest.
  double nearest = 10;
  for (int k = 0; k <= 400; ++k)
    nearest = std::min(nearest, (on(c, k / 400.) - Point(1.2, 0.1, 0)).norm());
  EXPECT_NEAR(nearest, 0.4, 4e-3);
  EXPECT_GT(session.state().steps.back().largest_displacement, 0.1);
}

TEST(ActiveVolume, StretchesAsItsEquationSays) {
  Session session = fresh();
  // α w'' = −q along z only, held at z = 0: w = q (z − z²/2) / α.
  run(session,
      {R"({"do":"new","shape":"volume","degree":2,"net":4})", R"({"do":"scaling","mode":"raw"})",
       R"({"do":"material","alpha":[3,0,0,3,0,3],"beta":[0,0,0,0,0,0]})",
       R"({"do":"edge","which":"w0"})", R"({"do":"load","vector":[0,0,6]})",
       R"({"do":"evolve","mode":"static"})", R"({"do":"step"})"});
  for (const double z : {0., 0.25, 0.5, 1.}) {
    const Point x = on(volume(session), 0.3, 0.8, z);
    EXPECT_NEAR(x.z(), z + 2 * (z - z * z / 2), 1e-12);
    EXPECT_NEAR(x.x(), 0.3, 1e-12);
  }
}

TEST(ActiveVolume, ABallDentsItAndItsHeldSideKeepsItsBits) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"volume","net":[8,8,5]})",
                R"({"do":"edge","which":"w0","hold":"tangent"})",
                R"({"do":"tool","radius":0.3,"position":[0.5,0.5,1.2],"rigid":true})",
                R"({"do":"evolve","lambda":20})"});
  const Points before = control_points_of(body(session));
  run(session, {R"({"do":"step","count":10})"});
  const Points& after = control_points_of(body(session));
  for (Eigen::Index k = 0; k < after.rows(); ++k) {
    EXPECT_TRUE(k % 5 >= 2 || after.row(k) == before.row(k)) << k;
  }
  EXPECT_NEAR(on(volume(session), 0.5, 0.5, 1).z(), 0.9, 0.01);
  EXPECT_LT(session.state().steps.back().gap, 0.02);
}

TEST(Body, IsUndoneRestoredAndRepeatedToTheBit) {
  Session session = fresh();
  run(session,
      {R"({"do":"new"})", R"({"do":"new","shape":"curve","net":10})",
       R"({"do":"pin","control_points":[[0],[9]]})",
       R"({"do":"material","alpha":[1],"beta":[0.02],"mass":2})",
       R"({"do":"evolve","mode":"dynamic"})", R"({"do":"load","gravity":[0,0,-1]})",
       R"({"do":"step","count":3})", R"({"do":"new","shape":"volume","net":4})",
       R"({"do":"edge","which":"v1","components":"z"})", R"({"do":"pin","at":[0.1,0.2,0.3]})",
       R"({"do":"force","name":"pull","kind":"dead","at":[1,1,1],"vector":[0,0,1]})",
       R"({"do":"step","count":2})", R"({"do":"points","which":[3,5],"by":[0.1,0,0]})",
       R"({"do":"select","body":"#2"})", R"({"do":"rest"})", R"({"do":"step"})",
       R"({"do":"select","surface":"#1"})"});
  EXPECT_EQ(session.state().forces.front().body, 1);
  auto restored = Session::restore(Document::fresh("test"), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  std::vector<SessionState> seen;
  while (session.can_undo()) {
    EXPECT_TRUE(same_state(session.state(), restored->state())) << seen.size();
    seen.push_back(session.state());
    run(session, {R"({"do":"undo"})"});
    run(*restored, {R"({"do":"undo"})"});
  }
  for (; session.can_redo(); seen.pop_back()) {
    run(session, {R"({"do":"redo"})"});
    EXPECT_TRUE(same_state(session.state(), seen.back()));
  }
  Session again = fresh();
  for (const Command& command : session.journal())
    ASSERT_TRUE(again.execute(*parse_command(to_json(command))));
  EXPECT_TRUE(same_state(session.state(), again.state()));
  // What steps on goes on to the same bits, too.
  run(session, {R"({"do":"select","body":"#3"})", R"({"do":"step"})"});
  auto on = Session::restore(Document::fresh("test"), session.snapshot());
  ASSERT_TRUE(on);
  run(session, {R"({"do":"step"})"});
  run(*on, {R"({"do":"step"})"});
  EXPECT_TRUE(same_state(session.state(), on->state()));
}

TEST(Body, RefinesWithoutChangingItsShape) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"curve","form":"circle"})",
                R"({"do":"new","shape":"volume","form":"cylinder","net":[3,3,4]})"});
  for (const char* id : {"#1", "#2"}) {
    run(session, {std::string(R"({"do":"select","body":")") + id + "\"}", R"({"do":"refine"})"});
  }
  EXPECT_EQ(net_of(body(session)), std::vector<int>{13});
  EXPECT_EQ(net_of(body(session, 1)), (std::vector<int>{4, 4, 5}));
  for (const double u : {0.1, 0.5, 0.77}) {
    EXPECT_NEAR(on(curve(session), u).head<2>().norm(), 0.5, 8 * epsilon);
    EXPECT_NEAR(on(volume(session, 1), u, 0, 0.5).head<2>().norm(), 0.5, 8 * epsilon);
  }
}

TEST(Body, SidesOfAVolumeAreItsOwnAndFaceOutward) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"volume","form":"cylinder","radius":2,"height":3,"net":[4,5,4]})"});
  const Volume& whole = volume(session);
  const auto sides = sides_of(whole);
  ASSERT_TRUE(sides) << sides.error().message();
  ASSERT_EQ(sides->size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t d = k / 2;
    std::size_t first = (d + 1) % 3, second = (d + 2) % 3;
    if (k % 2 == 0) std::swap(first, second);
    for (const auto& [a, b] : {std::pair{0.3, 0.4}, {0.9, 0.6}}) {
      std::array<double, 3> u{};
      u[d] = k % 2 == 0 ? 0 : 1;
      u[first] = a;
      u[second] = b;
      const Point there = *evaluate_point<3>(whole, u),
                  here = *evaluate_point<2>((*sides)[k], {a, b});
      EXPECT_NEAR((there - here).norm(), 0, 16 * epsilon) << k;
      Parameters<2> at(1, 2);
      at << a, b;
      const auto jet = evaluate<2>((*sides)[k], at, 1);
      const Eigen::RowVector3d du = jet->at({1, 0}).row(0), dv = jet->at({0, 1}).row(0);
      EXPECT_GT(du.cross(dv).dot((here - Point(0, 0, 1.5)).transpose()), 0) << k;
    }
  }
}

TEST(Body, CommandsOfSurfacesSayThatACurveIsSelected) {
  Session session = fresh();
  run(session, {R"({"do":"new"})", R"({"do":"new","shape":"curve"})"});
  for (const char* command : {R"({"do":"stroke","tool":"x","path":[[0,0,0]]})",
                              R"({"do":"brush","kind":"draw","path":[[0.5,0.5]]})",
                              R"({"do":"relax"})",
                              R"({"do":"symmetry","mirror":"u"})",
                              R"({"do":"freeze","region":[[0,1],[0,1]]})",
                              R"({"do":"elevate"})",
                              R"({"do":"weights","which":[0],"to":2})",
                              R"({"do":"modes"})",
                              R"({"do":"material","young":1,"thickness":1,"model":"shell"})",
                              R"({"do":"material","alpha":[1,0,1]})",
                              R"({"do":"edge","which":"v0"})",
                              R"({"do":"pin","at":[0.5,0.5]})",
                              R"({"do":"pin","control_points":[[9]]})",
                              R"({"do":"force","kind":"line","edge":"u0","vector":[0,0,1]})",
                              R"({"do":"force","at":[2],"to":[0,0,0]})",
                              R"({"do":"hold","mode":"position"})",
                              R"({"do":"tool","at":[0.5,0.5]})",
                              R"({"do":"points","rows_u":[0],"by":[0,0,1]})",
                              R"({"do":"refine","region":[[0,1],[0,1]]})",
                              R"({"do":"select","body":"#1"})",
                              R"({"do":"select","surface":"#2"})"}) {
    const Error e = refusal(session, command);
    EXPECT_FALSE(e.remedy.empty()) << command << ": " << e.message();
    EXPECT_EQ(e.message().find("internal"), std::string::npos) << e.message();
  }
  run(session, {R"({"do":"load","pressure":1})"});
  EXPECT_EQ(refusal(session, R"({"do":"step"})").where, "pressure");
  run(session, {R"({"do":"select","surface":"#1"})"});
  for (const char* command :
       {R"({"do":"edge","which":"w0"})", R"({"do":"pin","at":[0.5]})",
        R"({"do":"force","at":[0.5],"to":[0,0,0]})", R"({"do":"material","alpha":[1]})",
        R"({"do":"pin","control_points":[[1]]})"}) {
    EXPECT_FALSE(refusal(session, command).remedy.empty()) << command;
  }
}

TEST(Body, KeepsToTheLimit) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"curve","net":12})", R"({"do":"limit","distance":0.05})",
                R"({"do":"force","at":[0.5],"to":[0.5,0,3],"strength":100})",
                R"({"do":"step","count":10})"});
  const double moved = session.state().steps.back().largest_displacement;
  EXPECT_GT(moved, 0.049);
  EXPECT_LT(moved, 0.05001);
}

TEST(Body, IsReportedAndWritten) {
  Session session = fresh();
  run(session,
      {R"({"do":"new","shape":"curve","form":"circle","radius":3,"unit":"inch","name":"ring"})",
       R"({"do":"force","at":[0.5],"to":[-5,0,0]})", R"({"do":"step","count":2})",
       R"({"do":"new","shape":"volume","net":4,"name":"block"})"});
  const auto info = nlohmann::json::parse(session_json(session));
  ASSERT_EQ(info["bodies"].size(), 2U);
  EXPECT_EQ(info["bodies"][0]["kind"], "curve");
  EXPECT_EQ(info["bodies"][0]["net"], (std::vector<int>{9}));
  EXPECT_GT(info["bodies"][0]["displacement"], 0.01);
  EXPECT_EQ(info["bodies"][1]["alpha"].size(), 6U);
  EXPECT_EQ(info["body"], 1);
  const auto saved = session.save();
  ASSERT_TRUE(saved) << saved.error().message();
  EXPECT_NE(saved->find("RATIONAL_B_SPLINE_CURVE"), std::string::npos);
  const auto read = step::File::parse(*saved, "saved");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->model().length_unit(), "inch");
  ASSERT_EQ(read->surfaces().size(), 6U);
  EXPECT_EQ(read->surfaces()[0].name, "block u0");
  SaveOptions with_curve;
  with_curve.curves.push_back({"ring", curve(session)});
  const auto no = save_surfaces({}, *find_format("stl"), with_curve);
  ASSERT_FALSE(no);
  EXPECT_NE(no.error().message().find("curves"), std::string::npos) << no.error().message();
}

}  // namespace
}  // namespace knead
