// The command lattice where faces have common edges: their points follow the block.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "scene/lattice.hpp"
#include "scene/parted_edges.hpp"
#include "session/running.hpp"
#include "support/made_files.hpp"

namespace knead {
namespace {

using testing::both;
using testing::opened;
using testing::run_on;
using testing::two_sheets;
using testing::TwoSheets;

TEST(LatticeOfFaces, MovesPointsOfFacesWithCommonEdges) {
  const TwoSheets sheets = two_sheets();
  Session session = opened(sheets);
  // A bump in the middle, which both nets would follow differently.
  const std::string pull =
      R"({"do":"lattice","net":[4,4,4],"which":[21,22,25,26,37,38,41,42],"by":[0,0,0.2])";
  const auto status = run_on(session, both + R"(,{"do":"hold","rows":0},)" + pull + "}");
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_TRUE(session.parted_edges()->empty());
  const auto saved = session.save();
  ASSERT_TRUE(saved) << saved.error().message();
  const auto lattice =
      lattice_around({session.state().surfaces[0].opened, session.state().surfaces[1].opened}, 0.05,
                     {3, 3, 3}, {4, 4, 4});
  ASSERT_TRUE(lattice);
  const std::vector<int> which = {21, 22, 25, 26, 37, 38, 41, 42};
  const auto largest_miss = [&](double height) {
    const auto moved = lattice->moved(lattice->rest().control_points(), which, {0, 0, height});
    const auto displacement = lattice->displacement(*moved);
    double result = 0;
    for (const SceneSurface& s : session.state().surfaces) {
      const Interval u = s.opened->knots(0).domain(), v = s.opened->knots(1).domain();
      for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 20; ++j) {
          const std::array<double, 2> at = {std::lerp(u.lower, u.upper, i / 20.0),
                                            std::lerp(v.lower, v.upper, j / 20.0)};
          const Point before = *evaluate_point<2>(*s.opened, at),
                      after = *evaluate_point<2>(*s.current, at);
          result = std::max(result, (after - before - *(*displacement)(before)).norm());
        }
      }
    }
    return result;
  };
  EXPECT_LT(largest_miss(0.2), 1e-4) << "points, where faces are visible and a little beyond";
  // Further from there: of the shapes from before.
  const auto again = run_on(session, pull + R"(,"again":true})");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_LT(largest_miss(0.4), 2e-4);
  EXPECT_TRUE(session.save());
  ASSERT_TRUE(run_on(session, R"({"do":"undo"},{"do":"undo"})"));
  EXPECT_EQ(session.largest_displacement(0), 0);
}

TEST(LatticeOfFaces, MovesNetsOfSurfacesWithoutFaces) {
  Session session(Document::fresh("made", "mm"));
  ASSERT_TRUE(run_on(session, R"({"do":"new","net":[6,6],"degree":2},
      {"do":"new","net":[7,7],"degree":2})"));
  const auto& made = session.state().surfaces;
  const auto status = run_on(session, fmt::format(R"({{"do":"select","surfaces":["{}","{}"]}},
      {{"do":"lattice","net":[4,4,4],"which":[21,22],"by":[0,0,10]}})",
                                                  made[0].id, made[1].id));
  ASSERT_TRUE(status) << status.error().message();
  for (const std::size_t k : {0U, 1U}) {
    const SceneSurface& s = session.state().surfaces[k];
    EXPECT_EQ(s.current->net(), s.opened->net()) << "their sides have names alike, and do not meet";
    EXPECT_EQ(s.current->knots(0).degree(), 2);
  }
}

TEST(LatticeOfFaces, LeavesNothingToSpringBackTo) {
  Session session = opened(two_sheets());
  const std::string pull = R"({"do":"lattice","net":[4,4,4],"which":[21,22,25,26],"by":[0,0,)";
  const auto status = run_on(session, both + R"(,{"do":"hold","rows":0},)" + pull + "0.2]}," +
                                          pull + R"(-0.2],"again":true})");
  ASSERT_TRUE(status) << status.error().message();
  for (const SceneSurface& s : session.state().surfaces)
    EXPECT_EQ(s.rest->control_points(), s.current->control_points());
}

}  // namespace
}  // namespace knead
