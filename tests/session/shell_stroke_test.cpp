#include <gtest/gtest.h>

#include <cmath>

#include "sheet.hpp"

// Strokes and brushes on shells.

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::moved;
using testing::run;
using testing::same_bits;
using testing::same_state;

const char* const sheet_metal =
    R"({"do":"material","model":"shell","young":2e5,"poisson":0.3,"thickness":2})";

Session sheet_between_sides(const std::vector<std::string>& more) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[100,100],"net":[16,16]})", R"({"do":"edge","which":"u0"})",
                R"({"do":"edge","which":"u1"})", R"({"do":"edge","which":"v0"})",
                R"({"do":"edge","which":"v1"})"});
  run(session, more);
  return session;
}

const std::vector<std::string> groove = {
    R"({"do":"tool","name":"ball","radius":15,"position":[50,50,40]})",
    R"({"do":"stroke","tool":"ball","path":[[35,50,11],[65,50,11]],"plastic":"along"})"};

TEST(ShellStroke, LeavesAGrooveAsDeepAsTheToolWent) {
  Session session =
      sheet_between_sides({sheet_metal, R"({"do":"material","plasticity":1,"locality":1})"});
  const SessionState before = session.state();
  run(session, groove);
  const SceneSurface& s = first(session);
  EXPECT_NEAR(-at(*s.current, 0.5, 0.5)[2], 4, 0.4);  // the net has spans of 7.7
  EXPECT_NEAR(-at(*s.current, 0.4, 0.5)[2], 4, 0.4);
  EXPECT_LT(std::abs(at(*s.current, 0.5, 0.9)[2]), 0.4);  // felt as far as a radius
  EXPECT_TRUE(same_bits(*s.rest, *s.current));            // all of it stays
  EXPECT_EQ(session.state().tools.front().shape.placement().position, Point(50, 50, 40));
  EXPECT_TRUE(session.state().steps.back().converged);
  const Points now = s.current->control_points(), then = s.opened->control_points();
  for (Eigen::Index i = 0; i < now.rows(); i += 16)
    EXPECT_TRUE(now.row(i) == then.row(i));  // held, to the bit
  run(session, {R"({"do":"undo"})"});
  run(session, {R"({"do":"undo"})"});
  EXPECT_TRUE(same_state(session.state(), before));
}

TEST(ShellStroke, InPartsIsThatInOneGo) {
  Session one = sheet_between_sides({sheet_metal}), parts = sheet_between_sides({sheet_metal});
  run(one, groove);
  run(parts, {groove[0], R"({"do":"stroke","tool":"ball","path":[[35,50,11]],"open":true})",
              R"({"do":"stroke","tool":"ball","path":[[65,50,11]],"open":true})",
              R"({"do":"stroke","tool":"ball","path":[]})"});
  EXPECT_TRUE(same_bits(*first(one).current, *first(parts).current));
}

TEST(ShellStroke, ThatSpringsBackLeavesNothing) {
  Session session = sheet_between_sides({sheet_metal, R"({"do":"material","plasticity":0})"});
  run(session, groove);
  EXPECT_EQ(moved(session, 0, 1, 0, 1), 0);
}

TEST(ShellStroke, OfTheFundamentalFormsLeavesItsGrooveToo) {
  Session session = sheet_between_sides({R"({"do":"material","model":"fundamental","w1":1,"w2":1})",
                                         R"({"do":"material","plasticity":1,"locality":1})"});
  run(session, groove);
  EXPECT_NEAR(-at(*first(session).current, 0.5, 0.5)[2], 4, 0.4);
}

TEST(ShellStroke, ReleasedAtTheEndLeavesWhatTheToolPressedLast) {
  Session session = sheet_between_sides({sheet_metal, R"({"do":"evolve","mode":"static"})"});
  run(session,
      {groove[0],
       R"({"do":"stroke","tool":"ball","path":[[50,50,13],[50,50,11]],"plastic":"release",)"
       R"("plasticity":1})"});
  EXPECT_NEAR(-at(*first(session).current, 0.5, 0.5)[2], 4, 0.4);
  EXPECT_TRUE(same_bits(*first(session).rest, *first(session).current));
}

TEST(ShellBrush, MovesAShellAndItsRestShapeAsItMovesTheLinearModel) {
  const std::vector<std::string> brushes = {
      R"({"do":"brush","kind":"push","path":[[0.4,0.5],[0.6,0.5]],"radius":20,"height":5})",
      R"({"do":"brush","kind":"grab","path":[[0.5,0.5]],"radius":20,"by":[3,0,4]})"};
  Session shell = sheet_between_sides({sheet_metal}), linear = sheet_between_sides({});
  run(shell, brushes);
  run(linear, brushes);
  EXPECT_GT(moved(shell, 0, 1, 0, 1), 3);
  EXPECT_TRUE(same_bits(*first(shell).current, *first(linear).current));
  EXPECT_TRUE(same_bits(*first(shell).rest, *first(linear).rest));
}

}  // namespace
}  // namespace knead
