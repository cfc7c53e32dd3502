// What comes through another face of its model is noted, or stops there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "support.hpp"
#include "support/error_codes.hpp"
#include "support/made_files.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::run;
using testing::StepBuilder;

constexpr const char* beginning = "through another face";
constexpr const char* stopping = "stopped at another face";

/// The note that begins so; empty: there is none.
std::string note(const Session& session, const std::string& begin) {
  for (const Note& n : session.state().notes) {
    if (!n.starts_with(begin)) continue;
    EXPECT_TRUE(n.diagnostic);
    EXPECT_EQ(n.diagnostic->code,
              begin == stopping ? ErrorCode::stopped_at_face : ErrorCode::through_face);
    return n;
  }
  return {};
}

/// A box over [0, 10]² × [0, 1]; its lid is a bicubic B-spline, and its floor too where it is asked
/// for.
std::string thin_box(bool spline_floor, double lid = 1) {
  StepBuilder b;
  constexpr std::array<std::array<double, 2>, 4> corner = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}};
  std::array<int, 4> low, high, floor, roof, post;
  for (std::size_t k = 0; k < 4; ++k) {
    low[k] = b.vertex(corner[k][0], corner[k][1], 0);
    high[k] = b.vertex(corner[k][0], corner[k][1], lid);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [x, y] = corner[k];
    const auto [u, v] = corner[(k + 1) % 4];
    floor[k] = b.straight_edge(low[k], low[(k + 1) % 4], {x, y, 0}, {u, v, 0});
    roof[k] = b.straight_edge(high[k], high[(k + 1) % 4], {x, y, lid}, {u, v, lid});
    post[k] = b.straight_edge(low[k], high[k], {x, y, 0}, {x, y, lid});
  }
  const auto sheet = [&](double z, const std::string& name) {
    const Surface flat = testing::uniform_sheet(3, 16, 16, 10, 10);
    Points points = flat.control_points();
    points.col(2).array() = z;
    return b.surface(*flat.with_control_points(points), name);
  };
  std::vector<int> faces;
  faces.push_back(b.face(sheet(lid, "lid"), {b.bound({roof[0], roof[1], roof[2], roof[3]})}));
  faces.push_back(
      b.face(spline_floor ? sheet(0, "floor") : b.plane({0, 0, 0}, {0, 0, 1}, {1, 0, 0}),
             {b.bound({-floor[3], -floor[2], -floor[1], -floor[0]})}, false));
  const std::array<std::array<double, 3>, 4> normals = {
      {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    faces.push_back(b.face(b.plane({corner[k][0], corner[k][1], 0}, normals[k], {0, 0, 1}),
                           {b.bound({floor[k], post[next], -roof[k], -post[k]})}));
  }
  const int shell = b.entity("CLOSED_SHELL('',(" + StepBuilder::list_of(faces) + "))");
  const int solid = b.entity(fmt::format("MANIFOLD_SOLID_BREP('box',#{})", shell));
  b.product("box", "ADVANCED_BREP_SHAPE_REPRESENTATION", {solid}, b.context("mm"));
  return b.forward(testing::ap214);
}

Session opened(const std::string& bytes) {
  return Session(Document::from(*open_source(bytes, "made.step")));
}

/// The session with the lid selected, its edges held, and a ball over its middle.
Session pressed_box(bool spline_floor, const std::vector<std::string>& press) {
  Session session = opened(thin_box(spline_floor));
  const std::string id = session.state().surfaces[0].id;
  run(session, {fmt::format(R"({{"do":"select","surface":"{}"}})", id),
                R"({"do":"hold","mode":"position"})", R"({"do":"material","preset":"clay"})",
                R"({"do":"tool","name":"b","radius":2,"position":[5,5,9]})"});
  run(session, press);
  return session;
}

std::string stroke(double depth, const std::string& more = "") {
  return fmt::format(R"({{"do":"stroke","tool":"b","path":[[5.1,4.9,{}]]{}}})", 3 - depth, more);
}

double number_after(const std::string& text, const std::string& begin) {
  const auto at = text.find(begin);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + begin.size()));
}
double depth_in(const std::string& text) { return number_after(text, "), "); }

double lowest(const Session& session) {
  double least = HUGE_VAL;
  const Surface& s = *session.state().surfaces[0].current;
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
      const auto p =
          evaluate_point<2>(s, {u.lower + u.length() * i / 100, v.lower + v.length() * j / 100});
      least = std::min(least, p->z());
    }
  }
  return least;
}

TEST(ThroughWalls, APressThatLeavesTheWallBehindIsNotNoted) {
  for (const bool spline_floor : {false, true}) {
    const Session session = pressed_box(spline_floor, {stroke(0.5)});
    EXPECT_LT(lowest(session), 0.6);
    EXPECT_EQ(note(session, beginning), "");
  }
}

TEST(ThroughWalls, APressThroughTheWallBehindIsNotedWithPlaceAndDepth) {
  for (const bool spline_floor : {false, true}) {
    const Session session = pressed_box(spline_floor, {stroke(1.5)});
    EXPECT_LT(lowest(session), -0.3);
    const std::string text = note(session, beginning);
    EXPECT_NEAR(depth_in(text), 1, 1e-3) << text;
    EXPECT_NEAR(number_after(text, " at ("), 5.1, 0.3) << text;
    EXPECT_NE(text.find("the face #"), std::string::npos) << text;
    EXPECT_NE(text.find("\"allow\":\"through\""), std::string::npos) << text;
  }
}

TEST(ThroughWalls, AllowedItIsNotNoted) {
  const Session session = pressed_box(false, {stroke(1.5, R"(,"allow":"through")")});
  EXPECT_LT(lowest(session), -0.3);
  EXPECT_EQ(note(session, beginning), "");
}

TEST(ThroughWalls, StepsDragsBrushesPointsAndLatticesAreNotedToo) {
  const std::string grip = R"({"do":"drag","at":[0.5,0.5],"by":[0,0,-1.6],"radius":2)";
  const std::string push =
      R"({"do":"brush","kind":"grab","path":[[0.5,0.5]],"radius":4,"by":[0,0,-1.6])";
  const std::string points = R"({"do":"points","which":[119,120,135,136],"by":[0,0,-3])";
  const std::string pull =
      R"({"do":"lattice","net":[9,9,4],"degree":[2,2,1],"which":[161,162],"by":[0,0,-3])";
  for (const std::string& act : {grip, push, points, pull}) {
    const Session through = pressed_box(false, {act + "}"});
    EXPECT_NE(note(through, beginning), "") << act << lowest(through);
    const Session allowed = pressed_box(false, {act + R"(,"allow":"through"})"});
    EXPECT_EQ(note(allowed, beginning), "") << act;
    const Session stopped = pressed_box(false, {act + R"(,"allow":"nothing"})"});
    EXPECT_NE(note(stopped, stopping), "") << act;
    EXPECT_GT(lowest(stopped), 0) << act;
    EXPECT_LT(lowest(stopped), 0.05) << act;
  }
  const std::string tool = R"({"do":"move","tool":"b","by":[0,0,-7.5]})";
  const Session steps = pressed_box(false, {tool, R"({"do":"step","count":20,"lambda":0.1})"});
  EXPECT_NE(note(steps, beginning), "") << lowest(steps);
}

TEST(ThroughWalls, APressThatEndsJustBeforeTheWallIsNoted) {
  // One control point of a net, whose place is where its basis function is largest.
  const auto moved = [](double apart) {
    Session session = opened(thin_box(false));
    const SceneSurface& s = session.state().surfaces[0];
    const auto top = [&](double by) {
      Session trial = opened(thin_box(false));
      run(trial,
          {fmt::format(R"({{"do":"points","which":[119],"by":[0,0,{}],"allow":"through"}})", by)});
      double least = HUGE_VAL;
      const Surface& t = *trial.state().surfaces[0].current;
      double u = 0.5, v = 0.5;
      for (double step = 0.1; step > 1e-9; step /= 2) {
        for (int k = 0; k < 8; ++k) {
          for (const auto& [a, b] : {std::pair{step, 0.}, {-step, 0.}, {0., step}, {0., -step}}) {
            const auto p = evaluate_point<2>(t, {u + a, v + b});
            if (p->z() < least) {
              least = p->z();
              u += a;
              v += b;
            }
          }
        }
      }
      return least;
    };
    (void)s;
    const double per = 1 - top(-1);  // linear
    run(session,
        {fmt::format(R"({{"do":"points","which":[119],"by":[0,0,{:.17g}]}})", -(1 - apart) / per)});
    return note(session, beginning);
  };
  const double size = std::sqrt(201);
  EXPECT_NE(moved(0.5e-6 * size), "");
  EXPECT_EQ(moved(4e-6 * size), "");
}

TEST(ThroughWalls, ASessionMayStopThere) {
  Session session = pressed_box(false, {});
  session.stop_at_faces(true);
  run(session, {stroke(1.5)});
  EXPECT_GT(lowest(session), 0);
  EXPECT_LT(lowest(session), 1e-3);
  const std::string text = note(session, stopping);
  EXPECT_NEAR(depth_in(text), 1, 1e-3) << text;
  EXPECT_EQ(note(session, beginning), "");
  // Whoever carries it out again gets the same.
  const std::vector<Command> journal = session.journal();
  Session again = opened(thin_box(false));
  for (const Command& command : journal) ASSERT_TRUE(again.execute(command));
  EXPECT_TRUE(
      testing::same_bits(*again.state().surfaces[0].current, *session.state().surfaces[0].current));
  run(session, {R"({"do":"undo"})", stroke(1.5, R"(,"allow":"through")")});
  EXPECT_LT(lowest(session), -0.3);
}

TEST(ThroughWalls, StepsStopThereOneByOne) {
  const std::string tool = R"({"do":"move","tool":"b","by":[0,0,-7.5]})";
  Session at_once = pressed_box(false, {tool});
  run(at_once, {R"({"do":"step","count":12,"lambda":0.1,"allow":"nothing"})"});
  Session single = pressed_box(false, {tool});
  single.stop_at_faces(true);
  for (int k = 0; k < 12; ++k) run(single, {R"({"do":"step","lambda":0.1})"});
  for (const Session* session : {&at_once, &single}) {
    EXPECT_GT(lowest(*session), 0);
    EXPECT_LT(lowest(*session), 0.01);
    EXPECT_NE(note(*session, stopping), "");
  }
  EXPECT_TRUE(testing::same_bits(*at_once.state().surfaces[0].current,
                                 *single.state().surfaces[0].current));
}

TEST(ThroughWalls, FacesThatMeetAtEdgesAreNotNoted) {
  // All faces of the box, converted and moved out and in.
  Session session = opened(thin_box(true, 6));
  std::vector<std::string> faces;
  for (const auto& other : brep::other_surfaces(*session.document().model()))
    faces.push_back(other.id);
  for (const std::string& id : faces)
    run(session, {fmt::format(R"({{"do":"convert","surface":"{}"}})", id)});
  ASSERT_EQ(session.state().surfaces.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const SceneSurface& s = session.state().surfaces[k];
    const auto middle = evaluate_point<2>(
        *s.current,
        {(s.current->knots(0).domain().lower + s.current->knots(0).domain().upper) / 2,
         (s.current->knots(1).domain().lower + s.current->knots(1).domain().upper) / 2});
    const Point inward = (Point(5, 5, 3) - *middle).normalized();
    for (const double side : {1., -1.}) {
      const Point at = *middle - side * 0.8 * inward, away = *middle - side * 4 * inward;
      run(session, {fmt::format(R"({{"do":"select","surface":"{}"}})", s.id),
                    R"({"do":"hold","mode":"position"})", R"({"do":"refine","permission":"auto"})",
                    R"({"do":"material","preset":"clay"})",
                    fmt::format(R"({{"do":"tool","name":"t","radius":1.5,"position":[{},{},{}]}})",
                                away.x(), away.y(), away.z()),
                    fmt::format(R"({{"do":"stroke","tool":"t","path":[[{},{},{}]]}})", at.x(),
                                at.y(), at.z()),
                    R"({"do":"remove","tool":"t"})"});
    }
    EXPECT_GT(session.largest_displacement(static_cast<int>(k)), 0.1) << k;
  }
  EXPECT_EQ(note(session, beginning), "");
}

TEST(ThroughWalls, ACurvedHullPressedIsNotNoted) {
  const auto press = [](const std::string& file, const Point& place, const Point& inward,
                        double radius) {
    Session session = opened(file);
    const Point at = place - 0.6 * radius * inward, away = place - 3 * radius * inward;
    run(session,
        {fmt::format(R"({{"do":"select","surface":"{}"}})", session.state().surfaces[0].id),
         R"({"do":"hold","mode":"position"})", R"({"do":"material","preset":"clay"})",
         R"({"do":"refine","permission":"auto"})",
         fmt::format(R"({{"do":"tool","name":"t","radius":{},"position":[{},{},{}]}})", radius,
                     away.x(), away.y(), away.z()),
         fmt::format(R"({{"do":"stroke","tool":"t","path":[[{},{},{}]]}})", at.x(), at.y(),
                     at.z())});
    EXPECT_GT(session.largest_displacement(0), 0.2 * radius);
    EXPECT_EQ(note(session, beginning), "");
  };
  press(testing::block_file(), {3, 1, testing::roof(3, 1)}, {0, 0, -1}, 0.5);
  press(testing::tube_file(), {-0.345, 0, 0.45}, {1, 0, 0}, 0.1);
}

TEST(ThroughWalls, ASheetAloneIsNotNoted) {
  Session session = testing::fresh();
  run(session, {R"({"do":"new","size":[10,10],"net":[16,16]})", R"({"do":"hold","rows":2})",
                R"({"do":"material","preset":"clay"})",
                R"({"do":"tool","name":"b","radius":2,"position":[5,5,9]})",
                R"({"do":"stroke","tool":"b","path":[[5,5,0.5]]})"});
  EXPECT_GT(session.largest_displacement(0), 1);
  EXPECT_EQ(note(session, beginning), "");
}

Session pressed_sphere(double depth) {
  Session session = testing::fresh();
  run(session,
      {R"({"do":"new","shape":"sphere","radius":1})", R"({"do":"refine","region":[[0,1],[0,1]]})",
       R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"hold","mode":"position"})",
       R"({"do":"material","preset":"clay"})",
       R"({"do":"tool","name":"b","radius":0.5,"position":[0,0,9]})",
       fmt::format(R"({{"do":"stroke","tool":"b","path":[[0,0,{}]]}})", 1.5 - depth)});
  return session;
}

TEST(ThroughWalls, ASpherePressedAQuarterIsNotNoted) {
  const Session session = pressed_sphere(0.5);
  EXPECT_GT(session.largest_displacement(0), 0.4);
  EXPECT_EQ(note(session, beginning), "");
}

TEST(ThroughWalls, ASpherePressedThroughItsFarSideIsNoted) {
  for (const auto& [deep, through] : {std::pair{1.8, false}, {2.3, true}}) {
    Session session = testing::fresh();
    run(session,
        {R"({"do":"new","shape":"sphere","radius":1})", R"({"do":"refine","region":[[0,1],[0,1]]})",
         R"({"do":"refine","region":[[0,1],[0,1]]})",
         fmt::format(
             R"({{"do":"brush","kind":"grab","path":[[0.5,0.99]],"radius":0.8,"by":[0,0,{}]}})",
             -deep)});
    EXPECT_GT(session.largest_displacement(0), 0.9 * deep);
    const std::string text = note(session, beginning);
    EXPECT_EQ(text.find("its own other side") != std::string::npos, through) << text;
    if (through) {
      EXPECT_NEAR(depth_in(text), 2, 0.1) << text;
    }
  }
}

}  // namespace
}  // namespace knead
